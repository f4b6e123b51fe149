"""The app's private folder for a campaign: uploaded files, the campaign being described, and results.

It lies in the user's cache, to which no other user can write. Results belong to the content of the campaign's files: those of
other content are not shown. Each is a folder that appears under its name when it is complete.
"""

import hashlib
import json
import shutil
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any

from comprope.errors import InputError
from comprope.user_cache import entry_folder, write_whole

from ..measurements.campaign_file import read_campaign_file
from ..measurements.files.raw_table import printable

MAX_FILE = 256 * 2**20  # bytes of one uploaded file: an hour of twenty channels at 200 samples a second, as text
MAX_FILES = 64
RECORD = "result.json"


class Workspace:
    """Folders and files of the app for one campaign folder."""

    def __init__(self, campaign: Path) -> None:
        self.campaign = campaign  # as it was given, which is how pages and commands name it
        self.name = campaign.absolute().name
        key = hashlib.sha256(str(campaign.absolute()).encode()).hexdigest()[:24]
        self.root = entry_folder("app", key)
        self.uploads, self.staged = self.root / "uploads", self.root / "staged"
        self.uploads.mkdir(exist_ok=True)

    @property
    def exists(self) -> bool:
        """Whether the campaign has been described."""
        return (self.campaign / "campaign.toml").is_file()

    def upload_path(self, name: str) -> Path:
        """Where an uploaded file goes; raises `InputError` for a name that is none, or for too many files."""
        plain = Path(name.replace("\\", "/")).name
        if not plain or plain.startswith(".") or plain != printable(plain, 120) or plain == "campaign.toml":
            raise InputError(f"{printable(name, 80)}: not the name of a file that is accepted here; rename it")
        if len(list(self.uploads.iterdir())) >= MAX_FILES and not (self.uploads / plain).exists():
            raise InputError(f"{MAX_FILES} files are there already; remove some")
        return self.uploads / plain

    def uploaded(self) -> list[Path]:
        """The uploaded files, without those still under way."""
        return sorted(one for one in self.uploads.iterdir() if not one.name.startswith("."))

    def results(self) -> Path:
        """The folder of the results for the present content of the campaign's files."""
        folder = self.root / "results" / fingerprint(self.campaign)
        folder.mkdir(parents=True, exist_ok=True)
        return folder

    def records(self) -> dict[str, dict[str, Any]]:
        """What is known of each result, by its name, oldest first."""
        if not self.exists:
            return {}
        found = [json.loads(path.read_text("utf-8")) for path in self.results().glob(f"*/{RECORD}")]
        return {one["name"]: one for one in sorted(found, key=lambda one: one["finished"])}

    def shown_results(self) -> list[dict[str, Any]]:
        """The records with the names of FMUs that have been built."""
        return [
            one | {"fmus": sorted(path.name for path in self.fmu_folder(name).glob("*.fmu"))}
            for name, one in self.records().items()
        ]

    def fmu_folder(self, name: str) -> Path:
        """Where the FMUs of a result are."""
        return self.results() / name / "fmus"

    def file(self, name: str, file: str) -> Path | None:
        """A file of a result; None if there is none of this name."""
        if name not in self.records():
            return None
        path = self.results() / name / file
        return path if path.name == file and path.is_file() else None

    def forget(self, name: str) -> None:
        """Remove a result."""
        if name in self.records():
            shutil.rmtree(self.results() / name, ignore_errors=True)


@contextmanager
def new_result(results: Path, name: str) -> Iterator[Path]:
    """A folder to write a result into, which takes its name, in place of an older one, at the end of the block."""
    temporary = results / f".{uuid.uuid4().hex}"
    temporary.mkdir(parents=True)
    try:
        yield temporary
        old = results / name
        if old.exists():
            old.rename(results / f".{uuid.uuid4().hex}.old")
        temporary.rename(old)
    finally:
        for left in (temporary, *results.glob(".*.old")):
            shutil.rmtree(left, ignore_errors=True)


def write_record(folder: Path, record: dict[str, Any]) -> None:
    """Write what is known of a result."""
    write_whole(folder / RECORD, json.dumps(record))


def fingerprint(campaign: Path) -> str:
    """Hash of the files of a campaign on which results depend, by name and content: campaign.toml, those it names, effects."""
    digest = hashlib.sha256()
    for path in sorted({campaign / "campaign.toml", *_named(campaign), *campaign.glob("**/*.py")}):
        if path.is_file():
            found = path.stat()
            digest.update(f"{path.name} {_content(path, found.st_mtime_ns, found.st_size)}\n".encode())
    return digest.hexdigest()[:24]


def _named(campaign: Path) -> list[Path]:
    """The files that campaign.toml names; none if it cannot be read."""
    try:
        described = read_campaign_file(campaign / "campaign.toml")
    except InputError:
        return []
    runs = [file for run in described.runs for file in (run.file, *run.files.values())]
    return [campaign / file for file in (described.model, *runs)]


@lru_cache(1000)
def _content(path: Path, _changed: int, _size: int) -> str:
    """Hash of a file's content, read again when its time or size has changed."""
    return hashlib.sha256(path.read_bytes()).hexdigest()
