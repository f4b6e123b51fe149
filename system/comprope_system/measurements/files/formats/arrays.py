"""Tables from named arrays, as MATLAB, HDF5 and similar files hold them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from comprope.errors import InputError

from ..raw_table import RawColumn, RawTable, printable, unique_names

RATE_NAMES = ("fs", "rate", "samplerate", "samplingrate", "samplefrequency", "samplingfrequency")
INTERVAL_NAMES = ("dt", "ts", "interval", "sampleinterval", "samplinginterval", "deltat", "wfincrement")
VALUE_NAMES = ("value", "values", "data", "signal", "samples", "y")  # say nothing beside the name of their group


@dataclass(frozen=True)
class Array:
    """Values of any shape, the unit that the file states, and the interval of the samples [s] if the array states its own."""

    values: Any
    unit: str | None = None
    interval: float | None = None


@dataclass(frozen=True)
class _Vector:
    """A vector of an array: the array's path, the name of its column, and the group that its clock belongs to."""

    path: str
    name: str
    values: pd.Series
    group: str


def require_arrays(arrays: Mapping[str, Array], objects: Sequence[str]) -> None:
    """Raise `InputError` for a file that holds nothing but `objects` of MATLAB, which only MATLAB reads."""
    if objects and not arrays:
        raise InputError(
            f"{printable(objects[0])} is an object of MATLAB, such as a table or timetable: write it with writetimetable or "
            "writetable, or save its vectors"
        )


def table_of_arrays(arrays: Mapping[str, Array], group: str | None) -> RawTable:
    """The columns of arrays by path, such as "Run 1/time".

    Vectors (n,) are columns, and so are the columns of matrices (n, k), with the names that a vector of k texts gives them or as
    "name 1" to "name k"; a matrix (n, 2) whose first column increases is a clock and a signal. With a `group`, only arrays under
    it. Numbers that are single state the sample rate of their group, if they are named so. Raises `InputError`, without a file's
    name, if there are no vectors of numbers or texts, or no such group.
    """
    paths = [path for path in arrays if group is None or path == group or path.startswith(f"{group.strip('/')}/")]
    if not paths:
        groups = sorted({path.rpartition("/")[0] for path in arrays} - {""})
        raise InputError(f'file.sheet = "{group}": a group of the file is accepted: {", ".join(groups) or "it has none"}')
    titles = [_texts(arrays[path].values) for path in paths]
    rates: dict[str, float] = {}
    found: list[_Vector] = []
    for path in paths:
        values = np.asarray(arrays[path].values)
        above, _, name = path.rpartition("/")
        if values.size == 1:
            rates |= {above: rate} if (rate := rate_named(name, values)) else {}
        else:
            found += _vectors(path, values, titles)
    if not found:
        raise InputError("no vectors of numbers in the file")
    bare = [one.name for one in found]
    names = unique_names([one.name if bare.count(one.name) == 1 else one.path for one in found])
    several = len(set(rates.values())) > 1
    columns = []
    for name, one in zip(names, found, strict=True):
        array = arrays[one.path]
        interval = array.interval or (1.0 / rate if several and (rate := _rate_of(one.group, rates)) else None)
        clock = pd.Series(np.arange(len(one.values)) * interval) if interval else None
        columns.append(RawColumn(name, one.values, array.unit, clock, one.group, (one.path,)))
    return RawTable(tuple(columns), next(iter(rates.values())) if rates and not several else None)


def rate_named(name: str, value: np.ndarray) -> float | None:
    """Samples per second [Hz] of a single number that is named as a rate or an interval; None for others."""
    bare = printable(name).lower().replace("_", "").replace(" ", "")
    if value.dtype.kind not in "fiu" or not float(value.reshape(())) > 0.0:
        return None
    number = float(value.reshape(()))
    return number if bare in RATE_NAMES else 1.0 / number if bare in INTERVAL_NAMES else None


def _rate_of(group: str, rates: Mapping[str, float]) -> float | None:
    """The rate that a group states, or the nearest around it."""
    while group not in rates and group:
        group = group.rpartition("/")[0]
    return rates.get(group)


def _vectors(path: str, values: np.ndarray, titles: Sequence[list[str]]) -> Iterator[_Vector]:
    """The vectors of an array; none of arrays that are no table."""
    above, _, leaf = path.rpartition("/")
    name = above.rpartition("/")[2] if above and leaf.lower() in VALUE_NAMES else leaf
    if values.dtype.kind not in "fiubOSUMm":
        return
    squeezed = np.squeeze(values)
    if squeezed.ndim == 1:
        yield _Vector(path, name, _series(squeezed), above)
    if squeezed.ndim != 2 or values.dtype.kind not in "fiu":
        return
    own = squeezed if squeezed.shape[0] >= squeezed.shape[1] else squeezed.T
    count = own.shape[1]
    named = [one for one in titles if len(one) == count]
    columns = [f"{name} {k + 1}" for k in range(count)]
    if named and all(one == named[0] for one in named):
        columns = named[0]
    elif count == 2 and len(own) > 2 and np.all(np.diff(own[:, 0]) > 0):
        columns, above = [f"time of {name}", name], path
    for k, column in enumerate(columns):
        yield _Vector(path, column, _series(own[:, k]), above)


def _texts(values: Any) -> list[str]:
    """The texts of a vector of texts; none of other arrays."""
    array = np.squeeze(np.asarray(values))
    if array.ndim != 1 or array.dtype.kind not in "SUO":
        return []
    texts = [one.decode("utf-8", "replace") if isinstance(one, bytes) else one for one in array]
    return [one.strip() for one in texts] if all(isinstance(one, str) for one in texts) else []


def _series(values: np.ndarray) -> pd.Series:
    if values.dtype.kind in "SO":
        return pd.Series([one.decode("utf-8", "replace") if isinstance(one, bytes) else one for one in values]).astype(str)
    native = values.astype(values.dtype.newbyteorder("="))
    return pd.Series(native.astype(float) if native.dtype.kind == "f" else native)
