"""The table of one measured run, read from CSV."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from comprope.errors import InputError

from .recover import recover_trip
from .trip import Trip

UNITS: dict[str, dict[str, float]] = {
    "lateral_displacement": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6},
    "sheave_displacement": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6},
    "sheave_angular_velocity": {"rad/s": 1.0, "deg/s": np.pi / 180.0, "rpm": np.pi / 30.0, "1/min": np.pi / 30.0},
    "sheave_force": {"N": 1.0, "kN": 1e3},
    "car_end_tension": {"N": 1.0, "kN": 1e3},
    "counterweight_end_tension": {"N": 1.0, "kN": 1e3},
}


def read_table(file: Path, columns: Sequence[str]) -> pd.DataFrame:
    """The numbers of a CSV file with these columns; raises `InputError` for missing columns and cells that are not numbers."""
    try:
        table = pd.read_csv(file, skipinitialspace=True)
    except OSError as error:
        raise InputError(f"{file}: cannot be read: {error.strerror}") from None
    except (ValueError, UnicodeDecodeError) as error:
        raise InputError(f"{file}: not a CSV table: {' '.join(str(error).split())}") from None
    if missing := [name for name in columns if name not in table]:
        raise InputError(f"{file}: no column {', '.join(missing)}; the header has {', '.join(map(str, table.columns))}")
    numbers = table.apply(pd.to_numeric, errors="coerce")
    wrong = [name for name in table.columns if (numbers[name].isna() & table[name].notna()).any()]
    if wrong:
        raise InputError("\n".join(_wrong_cell(file, name, table, numbers) for name in wrong))
    return numbers


def _wrong_cell(file: Path, name: str, table: pd.DataFrame, numbers: pd.DataFrame) -> str:
    row = int((numbers[name].isna() & table[name].notna()).to_numpy().argmax())
    return f"{file}: {name} = {table[name].iloc[row]!r} in row {row + 2}: a number or an empty cell is accepted"


def read_trips(file: Path, table: pd.DataFrame, height: float) -> tuple[Trip, Trip]:
    """The smooth trips of car and counterweight estimated from the positions of a table, for a shaft height [m]."""
    try:
        time = table["time"]
        car = recover_trip(time, table["car_position"])
        if "counterweight_position" in table:
            return car, recover_trip(time, table["counterweight_position"])
        return car, car.mirrored(height)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None
