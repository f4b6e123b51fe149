"""Values of a column in its own unit: numbers from texts, without words, sentinels and samples that are no measurement."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from comprope.errors import InputError

from ..files.cells.numerals import to_numbers
from ..files.raw_table import RawColumn, RawTable, printable
from ..units import ELECTRICAL, split_unit, unit_named
from .signal_faults import Finding, remove_faults

Floats = NDArray[np.float64]
Rules = tuple[Callable[[Floats], Finding | None], ...]
MOST_WRONG = 3  # cells named in a message


def numbers_of(column: RawColumn, table: RawTable, missing: tuple[float | str, ...], rules: Rules) -> tuple[Floats, list[str]]:
    """The readings (n,) of a column, NaN where there is none, and remarks.

    `missing` are stated words and numbers for no value. Raises `InputError`, without the file's name, for other texts.
    """
    remarks: list[str] = []
    if column.is_numeric:
        values = column.values.to_numpy(dtype=float, na_value=np.nan)
    else:
        found, wrong, words = to_numbers(column.values, table.decimal, [one for one in missing if isinstance(one, str)])
        if wrong:
            raise InputError(_wrong_cells(column, table, wrong))
        if words:
            count = sum(words.values())
            shown = ", ".join(f'"{printable(word, 20)}"' for word in list(words)[:MOST_WRONG])
            remarks.append(f"{column.name}: {count} cells {shown} are no numbers and taken as missing")
        values = found.to_numpy()
    stated = np.isin(values, [float(one) for one in missing if not isinstance(one, str)])
    values = np.where(stated, np.nan, values)
    cleaned, faults = remove_faults(values, rules)
    return cleaned, [*remarks, *(f"{column.name}: {one}" for one in faults)]


def _wrong_cells(column: RawColumn, table: RawTable, wrong: list[int]) -> str:
    first = wrong[0]
    cell = printable(repr(column.values.iloc[first]))
    others = f" and {len(wrong) - 1} more" if len(wrong) > 1 else ""
    advice = 'a number or an empty cell is accepted; words for no value can be listed: missing = ["..."]'
    return f"{column.name} = {cell} in {table.row_text(first)}{others}: {advice}"


def written_unit(column: RawColumn) -> str | None:
    """The unit that the file states for a column, in its header or beside it; None if it states none."""
    return column.unit or split_unit(column.name)[1]


def unit_problem(column: RawColumn, unit: str, accepted: dict[str, float], factor: float, where: str) -> str | None:
    """A sentence if the file states another unit than `unit`, which `where` in campaign.toml states; None if they agree."""
    written = written_unit(column)
    known = unit_named(written) if written else None
    if written is None or (known is None and factor != 1.0):
        return None
    if known in ELECTRICAL:
        if factor != 1.0 or known in ("1", "%"):
            return None
        return f"{column.name}: the file is in {printable(written)}; write scale = {unit} per {printable(written)} under {where}"
    if known == unit or (known is not None and accepted.get(known) == accepted.get(unit) and known in accepted):
        return None
    if known is None and not column.unit and split_unit(column.name)[1] is None:
        return None
    advice = f"correct unit under {where}, or write ignore_units = true under [file]"
    return f'{column.name}: the file states the unit {printable(written)}, {where} states "{unit}"; {advice}'


def is_constant(values: Floats) -> bool:
    """Whether all numbers are equal."""
    known = values[np.isfinite(values)]
    return bool(len(known)) and float(known.max()) == float(known.min())
