"""The table of a file of any known format, recognised by its content."""

import importlib
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory

from comprope import atomic_files
from comprope.errors import InputError

from .archive import ARCHIVES, unpacked
from .file_format import FileFormat
from .raw_table import RawTable, printable
from .text.text_file import read_text_table

EXTRA = "formats"  # of the package's optional dependencies
LARGEST = 2_000_000_000  # bytes; a larger file is hardly the record of one trip
HDF5_MARK = b"\x89HDF\r\n\x1a\n"
FORMATS = {  # module in `formats`, and the package it needs
    "hdf5": ("hdf5_file", "h5py"),
    "mat": ("mat_file", "scipy"),
    "mdf": ("mdf_file", "asammdf"),
    "parquet": ("parquet_file", "pyarrow"),
    "tdms": ("tdms_file", "nptdms"),
    "workbook": ("workbook_file", "openpyxl"),
}
MARKS: dict[str, tuple[bytes, ...]] = {
    "hdf5": (HDF5_MARK,),
    "mat": (b"MATLAB 5.0 MAT-file",),
    "mdf": (b"MDF     ", b"UnFinMF "),
    "parquet": (b"PAR1",),
    "tdms": (b"TDSm", b"TDSh"),
    "archive": ARCHIVES,
}
REFUSED = (
    (b"\xd0\xcf\x11\xe0", "an old Excel file (.xls)", "save it as .xlsx or CSV"),
    (b"%PDF", "a PDF document", "export the table as CSV"),
    (b"7z\xbc\xaf", "a 7-Zip archive", "unpack it"),
    (b"\x89PNG", "a picture", "a table of numbers is accepted"),
)


def read_raw_table(path: Path, stated: FileFormat, within: Path | None = None) -> RawTable:
    """The table of a file, as `stated` where that says how it is written; with `within`, only of a file in that folder.

    Raises `InputError` in one sentence, which names the file, if it is no regular file, not in the folder, or holds no table,
    or if the package for its format is not installed.
    """
    shown = printable(path, 200)
    require_regular_file(path, within)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"{shown}: cannot be read: {error.strerror}") from None
    try:
        return _read(path, data, stated)
    except InputError as error:
        raise InputError("\n".join(f"{shown}: {printable(line, 400)}" for line in str(error).splitlines())) from None


def require_regular_file(path: Path, within: Path | None) -> None:
    """Raise `InputError` for pipes, devices, folders, huge files and files outside of the folder `within`."""
    shown = printable(path, 200)
    atomic_files.require_regular_file(path, LARGEST, shown)
    if within is not None and not path.resolve().is_relative_to(within.resolve()):
        raise InputError(
            f"{shown}: lies outside of the campaign's folder; copy it there, or allow it: comprope --allow-outside COMMAND ..."
        )


def _read(path: Path, data: bytes, stated: FileFormat) -> RawTable:
    kind = format_of(data, path)
    if kind == "archive":
        return _read_unpacked(path, data, stated)
    if kind == "text":
        return read_text_table(data, stated)
    module, package = FORMATS[kind]
    try:
        importlib.import_module(package)
    except ImportError:
        raise InputError(f'reading this format needs the package {package}: pip install "comprope[{EXTRA}]"') from None
    try:
        found: RawTable = importlib.import_module(f".formats.{module}", __package__).read(path, stated)
    except InputError:
        raise
    except Exception as error:  # whatever a damaged file makes of a library
        raise InputError(f"damaged, or not readable as {kind}: {printable(error, 120) or type(error).__name__}") from None
    return found


def _read_unpacked(path: Path, data: bytes, stated: FileFormat) -> RawTable:
    """The table of the file in an archive, which is read as any other file; an archive in it is not."""
    content = unpacked(path, data, stated.sheet)
    with TemporaryDirectory() as folder:
        inner = Path(folder) / "unpacked"
        inner.write_bytes(content)
        if format_of(content, inner) == "archive":
            raise InputError("is an archive in an archive; unpack it")
        own = stated.model_copy(update={"sheet": None}) if data.startswith(b"PK") else stated
        return _read(inner, content, own)


def format_of(data: bytes, path: Path) -> str:
    """The format of a file's content: a key of FORMATS, "archive" or "text"; `InputError` for formats that are not read."""
    for mark, kind, advice in REFUSED:
        if data.startswith(mark):
            raise InputError(f"is {kind}; {advice}")
    if not data.strip():
        raise InputError("not a CSV table: the file is empty")
    for kind, marks in MARKS.items():
        if data.startswith(marks):
            return kind
    if data[512:520] == HDF5_MARK:  # behind the header of a MATLAB file
        return "hdf5"
    if data.startswith(b"PK") and zipfile.is_zipfile(path):
        return _zip_format(path)
    return "text"


def _zip_format(path: Path) -> str:
    with zipfile.ZipFile(path) as archive:
        names = archive.namelist()
    if any(name.startswith("xl/") for name in names):
        return "workbook"
    return "archive"
