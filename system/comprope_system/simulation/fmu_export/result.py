"""The result of `comprope_system.fmu`: the files, with summary, table and HTML page."""

import xml.etree.ElementTree as ET
import zipfile
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any

import pandas as pd

from comprope.atomic_files import atomic_write
from comprope.fmi.package import DESCRIPTION
from comprope.rope.effects import RopeModel

from ...report.page import Block, Section, Table, save_page
from ...report.result import Result

HEAD = ("file", "standard", "needs", "size [kB]")
LEAD = "Files for co-simulation in other tools. Variables and settings are in the documentation inside each FMU."


@dataclass(frozen=True, repr=False)
class FmuResult(Result):
    """FMUs and system files by name in `files`, and the `model` to whose values the rope's parameters start."""

    files: Mapping[str, bytes] = field(repr=False)
    model: RopeModel
    model_name: str

    def save(self, folder: str | Path) -> list[Path]:
        """Write all files into a folder, made if absent, and return their paths; none is replaced unless all can be written."""
        paths = [Path(folder) / name for name in self.files]
        with ExitStack() as stack:
            for path, content in zip(paths, self.files.values(), strict=True):
                stack.enter_context(atomic_write(path)).write_bytes(content)
        return paths

    def headline(self) -> str:
        """Number of files and name of the model."""
        return f"{len(self.files)} files for co-simulation with the rope of {self.model_name}"

    def summary(self) -> str:
        """One line for each file: standard, and what it needs to run."""
        return "\n".join(f"{name}: {standard}, {needs}" for name, standard, needs, _ in self._rows())

    def to_json(self) -> dict[str, Any]:
        """For each file its standard, what it needs to run, and its size in bytes."""
        return {
            "files": [
                {"file": name, "standard": standard, "needs": needs, "bytes": len(self.files[name])}
                for name, standard, needs, _ in self._rows()
            ]
        }

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each file."""
        return pd.DataFrame(self.to_json()["files"])

    def save_html(self, path: str | Path) -> None:
        """Write an HTML page with the table of files, completely or not at all."""
        blocks: list[Block] = [Table(HEAD, self._rows())]
        save_page(path, f"{self.model_name}: FMUs", LEAD, [Section("files", "Files", blocks)])

    def _rows(self) -> list[tuple[str, str, str, str]]:
        return [(name, *_contents(content), f"{len(content) / 1e3:.0f}") for name, content in self.files.items()]


def _contents(content: bytes) -> tuple[str, str]:
    """Standard of a file, and what it needs to run."""
    with zipfile.ZipFile(BytesIO(content)) as archive:
        names = archive.namelist()
        if DESCRIPTION not in names:
            return "SSP 1.0", f"contains {' and '.join(Path(name).name for name in names if name.endswith('.fmu'))}"
        root = ET.fromstring(archive.read(DESCRIPTION))
    component = root.find("CoSimulation")
    standard = f"FMI {root.get('fmiVersion')}"
    if component is not None and component.get("needsExecutionTool") == "true":
        return standard, "needs Python with the dependencies of comprope"
    platforms = sorted({name.split("/")[1] for name in names if name.startswith("binaries/")})
    return standard, f"compiled for {', '.join(platforms)}"
