"""Reading text files, and writing files atomically: into a temporary file in the same folder that is renamed when complete."""

import os
import stat
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import InputError

LARGEST_TEXT = 50_000_000  # bytes; far beyond any model file, campaign.toml or effect
ENDINGS = {"page": (".html", ".htm"), "picture": (".png", ".pdf", ".svg"), "Python file": (".py",)}


@contextmanager
def atomic_write(path: str | Path) -> Iterator[Path]:
    """A temporary path to write to, which is renamed to `path` at the end of the block, or deleted on failure.

    Missing folders are made. Raises `InputError` if the file cannot be written.
    """
    target = Path(path)
    temporary = target.with_name(f".{target.stem}-{uuid.uuid4().hex}{target.suffix}")
    try:
        require_writable(target)
        target.parent.mkdir(parents=True, exist_ok=True)
        yield temporary
        temporary.replace(target)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None
    finally:
        temporary.unlink(missing_ok=True)


def require_regular_file(path: str | Path, largest: int, shown: str | None = None) -> None:
    """Raise `InputError` for what is no regular file of at most `largest` bytes: a pipe would wait, a device never end.

    `shown` is the path in messages.
    """
    name = shown or str(path)
    try:
        status = Path(path).stat()
    except (OSError, ValueError) as error:
        raise InputError(f"{name}: cannot be read: {getattr(error, 'strerror', None) or error}") from None
    if not stat.S_ISREG(status.st_mode):
        kind = "a folder" if stat.S_ISDIR(status.st_mode) else "a pipe or device"
        raise InputError(f"{name}: is {kind}; a regular file is accepted")
    if status.st_size > largest:
        size, unit = (1e9, "GB") if largest >= 1e9 else (1e6, "MB")
        raise InputError(f"{name}: {status.st_size / size:.1f} {unit}; up to {largest / size:g} {unit} is accepted")


def read_text_file(path: str | Path) -> str:
    """The text of a regular file; raises `InputError` if it is absent, none, unreadable or not UTF-8."""
    require_regular_file(path, LARGEST_TEXT)
    try:
        return Path(path).read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not UTF-8 text (byte {error.start + 1}); save the file as UTF-8") from None


def require_writable(path: str | Path, kind: str | None = None) -> None:
    """Raise `InputError` if an output file could not be written, or its folder not be created; nothing is created yet.

    A file of a `kind` must have a matching extension. Called before long computations, so that no result is lost.
    """
    target = Path(path)
    if target.parts[:1] == ("-",):
        raise InputError(f"{path}: nothing is written to standard output; give the name of a file")
    if kind and target.suffix.lower() not in ENDINGS[kind]:
        raise InputError(f"{path}: a name that ends in {', '.join(ENDINGS[kind])} is accepted for a {kind}")
    try:
        folder = next(one for one in target.absolute().parents if one.exists())
        taken = target.is_dir()
    except OSError as error:  # a name that is too long, a folder that must not be looked into
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None
    if taken:
        raise InputError(f"{path}: is a folder; give the name of a file")
    if not folder.is_dir():
        raise InputError(f"{path}: its folder cannot be created: {folder} is a file")
    if not os.access(folder, os.W_OK):
        raise InputError(f"{path}: the folder cannot be written to")
