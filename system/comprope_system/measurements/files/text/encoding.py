"""Text of a file in whatever encoding it was written."""

import codecs

from comprope.errors import InputError

BYTE_ORDER_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"), (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16"),
)  # fmt: skip
SAMPLE = 4096  # bytes looked at for zero bytes, which only UTF-16 and binary files have


def decode(data: bytes, encoding: str | None) -> str:
    """The text of a file; without a stated encoding by its byte-order mark, as UTF-8, UTF-16, or else as Windows-1252.

    Raises `InputError`, without the file's name, if it is not text.
    """
    if encoding:
        return _stated(data, encoding)
    for mark, name in BYTE_ORDER_MARKS:
        if data.startswith(mark):
            return _stated(data, name)
    if b"\0" in data[:SAMPLE]:
        return _utf16(data)
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")


def _stated(data: bytes, encoding: str) -> str:
    try:
        return data.decode(encoding).lstrip("\ufeff")
    except LookupError:
        raise InputError(f'file.encoding = "{encoding}": not an encoding; "utf-8", "utf-16" or "latin-1" are usual') from None
    except UnicodeError as error:
        raise InputError(f'not text in the encoding "{encoding}": {" ".join(str(error).split())[:80]}') from None


def _utf16(data: bytes) -> str:
    """UTF-16 without a byte-order mark: mostly ASCII, so that every other byte is zero."""
    even, odd = data[:SAMPLE:2].count(0), data[1:SAMPLE:2].count(0)
    half = len(data[:SAMPLE]) / 2
    if max(even, odd) < 0.7 * half or min(even, odd) > 0.1 * half:
        raise InputError(
            "not a text table, and no format that is known; CSV and other text, xlsx, mat, h5, parquet, tdms, mf4 are"
        )
    return _stated(data, "utf-16-le" if odd > even else "utf-16-be")
