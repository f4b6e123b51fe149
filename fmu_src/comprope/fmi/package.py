"""Build an FMU that runs in Python: pythonfmu packs a slave and a copy of this code; the result is reproducible.

The copy of the code and the slave's script have the hash of their content in their names. A Python
process identifies a module by its name alone, so two FMUs, or two builds of one, would otherwise run
whichever code was loaded first.
"""

import ast
import hashlib
import os
import subprocess
import sys
import tempfile
import uuid
import zipfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from importlib import metadata
from io import BytesIO
from pathlib import Path

from ..atomic_files import atomic_write
from ..errors import CompropeError, InputError
from .documentation import documentation_page
from .icon import icon
from .model_description import complete_description
from .model_interface import ModelInterface
from .validation import interface_problems

COMPROPE = Path(__file__).parent.parent
# The modules of this package that run inside an FMU.
FMI_MODULES = (
    "__init__", "error_reporting", "instance", "model_interface", "pythonfmu_slave", "pythonfmu_workarounds", "units",
    "validation",
)  # fmt: skip
FIXED_TIME = (1980, 1, 1, 0, 0, 0)
DESCRIPTION = "modelDescription.xml"

_BUNDLED_MODULE = '''\
"""The model of this FMU, made from the files beside this one; written by build_fmu.py."""

from pathlib import Path

from .fmi.pythonfmu_slave import slave_class

HERE = Path(__file__).parent

{entry}
Slave = slave_class(INTERFACE)
'''

_SLAVE_SCRIPT = '''\
"""The slave that pythonfmu loads, again for each instance; the code is in {package}. Written by build_fmu.py."""

import sys

try:
    from {package}.bundled import Slave
    from {package}.fmi.pythonfmu_workarounds import keep_alive
except Exception as error:
    sys.stderr and sys.stderr.write("{name} cannot be loaded: %s. It needs {needs}.\\n" % error)
    raise

if locals() is not globals():
    # Run by pythonfmu's binary for one more instance.
    keep_alive(globals())


class {name}(Slave):
    """See the FMU's documentation/index.html."""
'''


@dataclass(frozen=True)
class Origin:
    """Version and licence written into an FMU, and the oldest Python that runs it."""

    version: str
    licence: str
    python: str = "3.11"


@dataclass(frozen=True)
class Bundle:
    """The files of a Python package by path; the package is named by their content."""

    stem: str
    files: Mapping[str, bytes] = field(repr=False)

    @property
    def digest(self) -> str:
        """The first eight digits of the hash of all files."""
        return digest(self.files)[:8]

    @property
    def needs(self) -> str:
        """The packages that the code imports besides Python's own and the FMU's, as arguments of `pip install`."""
        trees = [ast.parse(content) for path, content in self.files.items() if path.endswith(".py")]
        nodes = [node for tree in trees for node in ast.walk(tree)]
        names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
        names |= {node.module for node in nodes if isinstance(node, ast.ImportFrom) and node.module and not node.level}
        foreign = {name.partition(".")[0] for name in names} - sys.stdlib_module_names - {"pythonfmu", "comprope"}
        owners = metadata.packages_distributions()
        return " ".join(sorted({owners.get(name, [name])[0].lower() for name in foreign}))

    @property
    def package(self) -> str:
        """The package's name inside the FMU."""
        return f"{self.stem}_{self.digest}"


def build(
    interface: ModelInterface,
    packages: list[str],
    entry: str,
    out: Path,
    origin: Origin,
    data: Mapping[str, bytes] | None = None,
    root: Path = COMPROPE,
    extra: Mapping[str, bytes] | None = None,
) -> Path:
    """Write `<out>/<name>.fmu` atomically and return its path.

    `packages` are the folders in `root` that the model needs as subpackages of `comprope`, besides `fmi`.
    `entry` is source text that defines INTERFACE inside the copied package, where imports are relative and
    the `data` files lie in the folder HERE. `extra` files go into the FMU by their path there. The same arguments
    give the same bytes.
    Raises `InputError` for an inconsistent interface or a folder that cannot be written.
    """
    if problems := interface_problems(interface):
        raise InputError("; ".join(problems))
    files = _source_files(packages, root) | dict(data or {}) | {"bundled.py": _BUNDLED_MODULE.format(entry=entry).encode()}
    bundle = Bundle("_".join(["comprope", *packages]), files)
    content = _pack_with_pythonfmu(interface.name, bundle, origin)
    content |= _documentation_files(interface, origin, bundle.needs) | dict(extra or {})
    xml = content.pop(DESCRIPTION)
    guid = str(uuid.UUID(digest(content | {DESCRIPTION: complete_description(xml, interface, origin.version, "")})[:32]))
    content[DESCRIPTION] = complete_description(xml, interface, origin.version, guid)
    with atomic_write(out / f"{interface.name}.fmu") as path:
        path.write_bytes(reproducible_zip(content))
    return out / f"{interface.name}.fmu"


def _source_files(packages: Iterable[str], root: Path) -> dict[str, bytes]:
    """The files to copy: the modules at the top, FMI_MODULES, and whole subpackages."""
    files = {path.name: path.read_bytes() for path in COMPROPE.glob("*.py")}
    files |= {f"fmi/{name}.py": (COMPROPE / "fmi" / f"{name}.py").read_bytes() for name in FMI_MODULES}
    for package in packages:
        inside = (path for path in (root / package).rglob("*") if path.is_file() and "__pycache__" not in path.parts)
        files |= {path.relative_to(root).as_posix(): path.read_bytes() for path in inside}
    return files


def _pack_with_pythonfmu(name: str, bundle: Bundle, origin: Origin) -> dict[str, bytes]:
    """The files of the FMU that pythonfmu packs, by path; it runs in its own process, to keep its imports separate."""
    script = f"{name}_{bundle.digest}.py"
    needs = f"Python {origin.python} or newer and: pip install {bundle.needs}"
    with tempfile.TemporaryDirectory() as folder:
        stage = Path(folder)
        (stage / script).write_text(_SLAVE_SCRIPT.format(name=name, package=bundle.package, needs=needs), encoding="utf-8")
        for path, content in bundle.files.items():
            target = stage / bundle.package / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
        command = [sys.executable, "-m", "pythonfmu", "build", "-f", script, "-d", "packed", bundle.package]
        environment = os.environ | {"PYTHONDONTWRITEBYTECODE": "1"}
        result = subprocess.run(command, cwd=stage, env=environment, capture_output=True, text=True, check=False)
        if result.returncode:
            raise CompropeError(f"{name}: pythonfmu cannot pack it: {(result.stderr.strip().splitlines() or ['no message'])[-1]}")
        with zipfile.ZipFile(stage / "packed" / f"{name}.fmu") as packed:
            return {entry: packed.read(entry) for entry in packed.namelist() if "__pycache__" not in entry}


def _documentation_files(interface: ModelInterface, origin: Origin, needs: str) -> dict[str, bytes]:
    pythonfmu = next(path for path in metadata.files("pythonfmu") or () if path.name == "LICENSE")
    return {
        "model.png": icon(),
        "documentation/index.html": documentation_page(interface, origin.version, origin.python, needs).encode(),
        "documentation/licenses/license.txt": origin.licence.encode(),
        "documentation/licenses/pythonfmu.txt": pythonfmu.read_binary(),
    }


def digest(files: Mapping[str, bytes]) -> str:
    """A hash of all files and their paths, in hexadecimal digits."""
    total = hashlib.sha256()
    for path in sorted(files):
        total.update(path.encode() + b"\0" + hashlib.sha256(files[path]).digest())
    return total.hexdigest()


def reproducible_zip(content: Mapping[str, bytes]) -> bytes:
    """A ZIP file that depends only on its content: sorted, with one date and one set of permissions."""
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for path in sorted(content):
            info = zipfile.ZipInfo(path, FIXED_TIME)
            info.create_system, info.external_attr = 3, 0o644 << 16
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, content[path], compresslevel=9)
    return buffer.getvalue()
