"""Reading text files, and writing files atomically: into a temporary file in the same folder that is renamed when complete."""

import os
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import InputError

ENDINGS = {"page": (".html", ".htm"), "picture": (".png", ".pdf", ".svg")}


@contextmanager
def atomic_write(path: str | Path) -> Iterator[Path]:
    """A temporary path to write to, which is renamed to `path` at the end of the block, or deleted on failure.

    Missing folders are made. Raises `InputError` if the file cannot be written.
    """
    target = Path(path)
    temporary = target.with_name(f".{target.stem}-{uuid.uuid4().hex}{target.suffix}")
    try:
        require_writable(target)
        yield temporary
        temporary.replace(target)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None
    finally:
        temporary.unlink(missing_ok=True)


def read_text_file(path: str | Path) -> str:
    """The text of a file; raises `InputError` if it is absent, unreadable or not UTF-8."""
    try:
        return Path(path).read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not UTF-8 text (byte {error.start + 1}); save the file as UTF-8") from None


def require_writable(path: str | Path, kind: str | None = None) -> None:
    """Create the folder of an output file; raises `InputError` if the file could not be written there.

    A file of a `kind` must have a matching extension. Called before long computations, so that no result is lost.
    """
    target = Path(path)
    if kind and target.suffix.lower() not in ENDINGS[kind]:
        raise InputError(f"{path}: a name that ends in {', '.join(ENDINGS[kind])} is accepted for a {kind}")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{path}: its folder cannot be created: {error.strerror}") from None
    if target.is_dir():
        raise InputError(f"{path}: is a folder; give the name of a file")
    if not os.access(target.parent, os.W_OK):
        raise InputError(f"{path}: the folder cannot be written to")
