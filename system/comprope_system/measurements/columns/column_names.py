"""Which column of a file is meant: by its exact name, without its unit, or by what loggers call time and car position."""

import re
from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime, time

import numpy as np
import pandas as pd

from comprope.errors import InputError

from ..files.cells.time_stamps import is_time_stamp
from ..files.raw_table import RawColumn, RawTable, printable
from ..units import split_unit

LOOKED_AT = 200  # samples that tell whether a column counts time
RARELY = 0.05  # share of steps that go back, or on, up to which a column is a clock, or none
EVEN = 0.1  # of the mean step: standard deviation of the steps of an even clock
FEWEST = 5  # numbers that tell
TIME_NAMES = frozenset(
    [
        "time", "t", "timestamp", "time_stamp", "datetime", "date_time", "date/time", "date&time", "zeit", "zeitstempel",
        "uhrzeit",
        "temps", "tempo", "x_value", "xvalue", "elapsed", "elapsed_time", "relative_time", "rel_time", "time_rel", "timer",
        "clock", "utc", "sec", "secs", "seconds", "ms", "milliseconds",
    ]
)
SAMPLE_NUMBERS = frozenset(
    [
        "sample", "samples", "index", "idx", "no", "nr", "n", "#", "scan", "sample_no", "sample_nr", "sample_number",
        "samplenumber", "point", "record",
    ]
)
CAR_NAMES = {
    "position": "car_position car_pos car_height carposition cabin_position cab_position kabinenposition kabine_position "
    "car_z z_car position_car fahrkorb_position fahrkorbposition car_encoder encoder car",
    "speed": "car_speed car_velocity car_v v_car cabin_speed cabin_velocity carspeed carvelocity fahrkorbgeschwindigkeit car_vel",
    "acceleration": "car_acceleration car_accel car_acc a_car car_a cabin_acceleration caracceleration fahrkorbbeschleunigung",
}
COUNTERWEIGHT_NAMES = {
    "position": "counterweight_position counterweight_pos cw_position cwt_position counterweight_height gegengewicht_position",
    "speed": "counterweight_speed counterweight_velocity cw_speed cw_velocity cwt_speed gegengewichtgeschwindigkeit",
    "acceleration": "counterweight_acceleration cw_acceleration cwt_acceleration gegengewichtbeschleunigung",
}


def plain_name(name: str) -> str:
    """A name for comparison: without unit, in lower case, one underscore for every other separator."""
    return re.sub(r"[\s_\-.]+", "_", split_unit(name)[0].strip().lower()).strip("_")


def find_column(table: RawTable, name: str) -> RawColumn:
    """The column of this name: exactly, or the only one that differs in unit, case and separators alone.

    Raises `InputError`, without the file's name, which lists the columns.
    """
    exact = [one for one in table.columns if one.name == name.strip()]
    same = exact or [one for one in table.columns if plain_name(one.name) == plain_name(name)]
    if len(same) == 1 and not (exact and _is_repeated(table, name)):
        return same[0]
    names = ", ".join(one.name for one in table.columns)
    if not same:
        raise InputError(f"no column {printable(name)}; the header has {printable(names, 300)}")
    raise InputError(f"column {printable(name)}: several columns have this name; the header has {printable(names, 300)}")


def _is_repeated(table: RawTable, name: str) -> bool:
    return any(one.name == f"{name} (2)" for one in table.columns)


def named_one_of(table: RawTable, names: Sequence[str]) -> list[RawColumn]:
    """The columns whose plain names are among `names`."""
    return [one for one in table.columns if plain_name(one.name) in names]


def is_time_name(name: str) -> bool:
    """Whether a column of this name holds times: "Time [s]", "t", "time_lasers", "Zeit 2"."""
    plain = plain_name(re.sub(r"\s*\(\d+\)$", "", name).rpartition("/")[2] or name)
    first = plain.split("_")[0]
    return plain in TIME_NAMES or first in ("time", "zeit", "timestamp", "t") or plain.endswith(("_time", "_zeit", "_timestamp"))


def clock_columns(table: RawTable, stated: str | None) -> list[RawColumn]:
    """The columns of times: the stated one, else those named so, else one of sample numbers, else none."""
    if stated:
        return [find_column(table, stated)]
    table = replace(table, columns=tuple(one for one in table.columns if _distinct(one) > 0))
    named = [one for one in table.columns if is_time_name(one.name)]
    counting = [one for one in named if _counts(one)]  # "response_time" and "cycle_time" are no clocks
    found = counting or named or named_one_of(table, sorted(SAMPLE_NUMBERS))[:1]
    return found or [one for one in table.columns if _is_stamped(one)][:1]


def unnamed_clocks(table: RawTable) -> list[RawColumn]:
    """Columns beyond the first that count evenly, as a clock does, but are not named as times or sample numbers."""
    return [
        one
        for one in table.columns[1:]
        if one.clock is None and not is_time_name(one.name) and plain_name(one.name) not in SAMPLE_NUMBERS and _is_even(one)
    ]


def _is_even(column: RawColumn) -> bool:
    """Whether the first numbers of a column increase by nearly equal steps."""
    some = column.values.head(LOOKED_AT).astype(str).str.replace(",", ".", regex=False)
    steps = np.diff(pd.to_numeric(some, errors="coerce").dropna().to_numpy())
    return len(steps) > FEWEST and bool(steps.min() > 0.0 and np.std(steps) < EVEN * np.mean(steps))


def _counts(column: RawColumn) -> bool:
    """Whether a column increases nearly everywhere, as far as it holds numbers: a clock may be set back once, or repeat times."""
    some = column.values.iloc[:: max(len(column.values) // LOOKED_AT, 1)]
    numbers = pd.to_numeric(some.astype(str).str.replace(",", "."), errors="coerce").dropna().to_numpy()
    if len(numbers) < FEWEST:
        return _distinct(column) > 1
    steps = np.diff(numbers)
    return bool(np.mean(steps < 0.0) < RARELY and np.mean(steps > 0.0) > RARELY)


def _is_stamped(column: RawColumn) -> bool:
    """Whether a column holds dates or times of day, by its type or its first cell."""
    if pd.api.types.is_datetime64_any_dtype(column.values):
        return True
    first = next((one for one in column.values.head(LOOKED_AT) if not pd.isna(one) and one != ""), None)
    return isinstance(first, datetime | time) or (isinstance(first, str) and is_time_stamp(first))


def _distinct(column: RawColumn) -> int:
    """Number of different values that are not empty, among some of the whole column."""
    some = column.values.iloc[:: max(len(column.values) // LOOKED_AT, 1)]
    return int(some[some.notna() & (some.astype(str) != "")].nunique())


def car_column(table: RawTable, names: dict[str, str] = CAR_NAMES) -> tuple[RawColumn, str] | None:
    """The column of the car's motion and its quantity, position first; None if no name is one of a car's motion.

    Raises `InputError`, without the file's name, if several columns could be meant.
    """
    for quantity, known in names.items():
        for name in known.split():
            found = named_one_of(table, [name])
            if len(found) > 1:
                raise InputError(
                    f"several columns may be the car's {quantity}: {', '.join(one.name for one in found)}; "
                    'write column = "..." under [car]'
                )
            if found:
                return found[0], quantity
    return None
