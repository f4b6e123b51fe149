"""Files in archives: gzip, bzip2, xz, and ZIP archives of one file."""

import bz2
import gzip
import lzma
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

from comprope.errors import InputError

from .raw_table import printable

LARGEST_UNPACKED = 500_000_000  # bytes; ten times half an hour at 1 kHz as text, and no more than a small machine holds
OPENERS: dict[bytes, tuple[str, Callable[..., Any]]] = {
    b"\x1f\x8b": ("gzip", gzip.open),
    b"BZh": ("bzip2", bz2.open),
    b"\xfd7zXZ\x00": ("xz", lzma.open),
}
DAMAGES = (OSError, EOFError, ValueError, NotImplementedError, lzma.LZMAError, zipfile.BadZipFile, zlib.error)
NO_FILES = ("__MACOSX/", ".")  # beginnings of the names of what systems add to archives
DOCUMENTS = ("[Content_Types].xml", "mimetype")  # members of office documents
ARCHIVES = tuple(OPENERS)  # beginnings of archives that hold one file


def unpacked(path: Path, data: bytes, member: str | None) -> bytes:
    """The content of the only file in an archive, or of the stated `member` of a ZIP archive.

    Raises `InputError`, without the file's name, for archives that hold several files, are damaged or encrypted, or grow beyond
    what is read.
    """
    for mark, (kind, opened) in OPENERS.items():
        if data.startswith(mark):
            with opened(path, "rb") as stream:
                return _content(stream, kind)
    return _zip_member(path, member)


def _zip_member(path: Path, member: str | None) -> bytes:
    with zipfile.ZipFile(path) as archive:
        if set(DOCUMENTS) & set(archive.namelist()):
            raise InputError("is a document that is not read; save the table as .xlsx or CSV")
        found = {
            one.filename: one
            for one in archive.infolist()
            if not one.is_dir() and not one.filename.startswith(NO_FILES) and not Path(one.filename).name.startswith(".")
        }
        names = printable(", ".join(found), 300)
        chosen = list(found) if member is None else [member] if member in found else []
        if len(chosen) != 1:
            accepted = f'write sheet = "{printable(next(iter(found)))}" under [file], or unpack it' if found else "it is empty"
            raise InputError(f"is a ZIP archive of {len(found)} files: {names}; {accepted}")
        info = found[chosen[0]]
        if info.flag_bits & 1:
            raise InputError("is an encrypted ZIP archive; unpack it")
        with archive.open(info) as stream:
            return _content(stream, "ZIP")


def _content(stream: IO[bytes], kind: str) -> bytes:
    try:
        content = stream.read(LARGEST_UNPACKED + 1)
    except DAMAGES as error:
        raise InputError(f"is a damaged {kind} archive: {printable(error, 120) or type(error).__name__}") from None
    if len(content) > LARGEST_UNPACKED:
        raise InputError(f"is a {kind} archive of more than {LARGEST_UNPACKED / 1e6:g} MB; unpack it")
    return content
