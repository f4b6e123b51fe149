"""The user's cache on disk: compiled kernels and built FMUs, which take long to make and are run when they are used again.

Whoever can write there can run programs as this user. A folder is therefore used only if it belongs to this user, if no other
user may write to it or to a folder above it, and only files that still have the checksum noted when they were written are read.
The folders asked, in this order: the one named by COMPROPE_CACHE, the user's cache folder, one in the folder of temporary files;
if all are refused, a private temporary folder, which is removed when the program ends. On Windows, where these folders are
private by themselves, owner and mode are not checked.
"""

import hashlib
import logging
import os
import shutil
import stat
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

from .file_lock import locked

VARIABLE = "COMPROPE_CACHE"
KEPT = 32  # most entries of one kind that pruning leaves; one set of compiled kernels takes about 5 MB
RECENT = 86400.0  # s: entries used within a day are left whatever their number; another program may be using them
_PRIVATE = 0o700
_OTHERS_WRITE = stat.S_IWGRP | stat.S_IWOTH
_CHECKED = sys.platform != "win32"


def entry_folder(kind: str, key: str) -> Path:
    """The folder `<cache>/<kind>/<key>`, made if absent; the entries of this kind used longest ago are removed then."""
    kind_folder = _private_folder(_cache_root() / kind)
    is_new = not (kind_folder / key).exists()
    folder = _private_folder(kind_folder / key)
    os.utime(folder)
    if is_new:
        _prune(kind_folder)
    return folder


@contextmanager
def verified_files(folder: Path, pattern: str) -> Iterator[None]:
    """Within the block, the files of a folder that match a pattern are whole, and this process alone reads and writes them.

    A file whose content is not the one noted when the last block ended is removed first, so that it is made anew.
    """
    name = hashlib.sha256(pattern.encode()).hexdigest()[:16]
    record = folder / f"{name}.sha256"
    with locked(folder / f"{name}.lock"):
        noted = record.read_text("utf-8").splitlines() if record.is_file() else []
        for path in folder.glob(pattern):
            if _noted(path) not in noted:
                _discard(path)
        yield
        write_whole(record, "\n".join(map(_noted, sorted(folder.glob(pattern)))))


def write_whole(path: Path, text: str) -> None:
    """Write a file under a temporary name and rename it, so that no other process reads a part of it."""
    with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False, suffix=".tmp", encoding="utf-8", newline="\n") as file:
        file.write(text)
    Path(file.name).replace(path)


def _noted(path: Path) -> str:
    """The line of the record for a file: checksum and name; no checksum for what is not a regular file."""
    regular = stat.S_ISREG(path.lstat().st_mode)
    return f"{hashlib.sha256(path.read_bytes()).hexdigest() if regular else ''} {path.name}"


def _cache_root() -> Path:
    """The first folder of the candidates that is usable; a remark says which were not, and why."""
    refused = []
    for candidate in _candidates():
        problem = _problem(candidate)
        if problem is None:
            break
        refused.append(f"{candidate}: {problem}")
    else:
        candidate = Path(_temporary_folder().name)
    if refused:
        _remark("; ".join(refused), candidate)
    return candidate


def _candidates() -> Iterator[Path]:
    if named := os.environ.get(VARIABLE):
        yield Path(named).absolute()
    variable = "LOCALAPPDATA" if sys.platform == "win32" else "XDG_CACHE_HOME"
    with suppress(RuntimeError):  # a user without a home
        yield Path(os.environ.get(variable) or Path.home() / ".cache").absolute() / "comprope"
    yield Path(tempfile.gettempdir()).absolute() / (f"comprope-{os.getuid()}" if _CHECKED else "comprope")


def _problem(folder: Path) -> str | None:
    """Why a folder, made if absent, cannot be the cache."""
    try:
        for level in (*reversed(folder.parents), folder):
            if not level.exists():
                level.mkdir(mode=_PRIVATE, exist_ok=True)
        if not folder.is_dir():
            return "not a folder"
        if not os.access(folder, os.W_OK | os.X_OK):
            return "this user cannot write to it"
        return _untrusted(folder) if _CHECKED else None
    except OSError as error:
        return error.strerror or str(error)


def _untrusted(folder: Path) -> str | None:
    """Which user other than this one, or the system above it, may replace what lies in a folder; symbolic links are followed."""
    for level in (*reversed(folder.parents), folder):
        found = level.lstat()
        if stat.S_ISLNK(found.st_mode):
            if found.st_uid not in (0, os.getuid()):
                return f"{level} is a link of another user's (user {found.st_uid})"
            return _untrusted(level.parent / level.readlink() / folder.relative_to(level))
        if found.st_uid != os.getuid() and (level == folder or found.st_uid != 0):
            return f"{level} belongs to another user (user {found.st_uid})"
        # In a folder with the sticky bit, such as /tmp, only the owner of an entry can replace it.
        if found.st_mode & _OTHERS_WRITE and (level == folder or not found.st_mode & stat.S_ISVTX):
            return f"other users may write to {level}; `chmod go-w {level}` changes that"
    return None


def _private_folder(folder: Path) -> Path:
    """A folder inside the cache, made if absent; anything else under its name is removed first."""
    if folder.is_symlink() or (folder.exists() and not _is_private(folder)):
        _discard(folder)
    folder.mkdir(mode=_PRIVATE, exist_ok=True)
    return folder


def _is_private(folder: Path) -> bool:
    found = folder.lstat()
    safe = not _CHECKED or (found.st_uid == os.getuid() and not found.st_mode & _OTHERS_WRITE)
    return stat.S_ISDIR(found.st_mode) and safe


def _discard(path: Path) -> None:
    """Remove a file, link or folder that another process may be removing as well."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)


def _prune(kind_folder: Path) -> None:
    """Remove the entries used longest ago."""
    times = {}
    for entry in kind_folder.iterdir():
        with suppress(FileNotFoundError):  # another process prunes as well
            times[entry] = entry.stat().st_mtime
    for entry in sorted(times, key=lambda one: times[one], reverse=True)[KEPT:]:
        if times[entry] < time.time() - RECENT:
            _discard(entry)


@cache
def _temporary_folder() -> tempfile.TemporaryDirectory[str]:
    """A private temporary folder for this program and, through the environment, the processes that it starts."""
    held = tempfile.TemporaryDirectory(prefix="comprope-", ignore_cleanup_errors=True)
    os.environ[VARIABLE] = held.name
    return held


@cache
def _remark(refused: str, used: Path) -> None:
    """Name, once, the folders that could not be used."""
    logging.getLogger(__name__).warning(
        "The cache of compiled kernels and FMUs is in %s, since others were refused: %s", used, refused
    )
