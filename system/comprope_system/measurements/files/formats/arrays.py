"""Tables from named arrays, as MATLAB, HDF5 and similar files hold them."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from comprope.errors import InputError

from ..raw_table import RawColumn, RawTable, printable, unique_names

RATE_NAMES = ("fs", "rate", "samplerate", "samplingrate", "samplefrequency", "samplingfrequency")
INTERVAL_NAMES = ("dt", "ts", "interval", "sampleinterval", "samplinginterval", "deltat")


def table_of_arrays(arrays: Mapping[str, Any], units: Mapping[str, str], group: str | None) -> RawTable:
    """The columns of arrays by path, such as "Run 1/time": vectors (n,), or matrices (n, k) as columns "name 1" to "name k".

    With a `group`, only of paths under it. Numbers that are single state the sample rate, if they are named so. Raises
    `InputError`, without a file's name, if there are no vectors of numbers or texts, or no such group.
    """
    paths = [path for path in arrays if group is None or path == group or path.startswith(f"{group.strip('/')}/")]
    if not paths:
        groups = sorted({path.rpartition("/")[0] for path in arrays} - {""})
        raise InputError(f'file.sheet = "{group}": a group of the file is accepted: {", ".join(groups) or "it has none"}')
    found: list[tuple[str, str, pd.Series]] = []
    rate = None
    for path in paths:
        values = np.asarray(arrays[path])
        name = path.rpartition("/")[2]
        if values.size == 1:
            rate = _rate(name, values) or rate
        else:
            found += [(path, f"{name}{suffix}", own) for suffix, own in _vectors(values)]
    if not found:
        raise InputError("no vectors of numbers in the file")
    bare = [name for _, name, _ in found]
    names = unique_names([name if bare.count(name) == 1 else path for path, name, _ in found])
    columns = tuple(RawColumn(name, own, units.get(path)) for name, (path, _, own) in zip(names, found, strict=True))
    return RawTable(columns, rate)


def _vectors(values: np.ndarray) -> list[tuple[str, pd.Series]]:
    """The vectors of an array with the suffixes of their names; none of arrays that are no table."""
    if values.dtype.kind not in "fiubOSUMm":
        return []
    squeezed = np.squeeze(values)
    if squeezed.ndim == 1:
        return [("", _series(squeezed))]
    if squeezed.ndim != 2 or values.dtype.kind not in "fiu":
        return []
    own = squeezed if squeezed.shape[0] >= squeezed.shape[1] else squeezed.T
    return [(f" {k + 1}", _series(own[:, k])) for k in range(own.shape[1])]


def _series(values: np.ndarray) -> pd.Series:
    if values.dtype.kind in "SO":
        return pd.Series([one.decode("utf-8", "replace") if isinstance(one, bytes) else one for one in values]).astype(str)
    native = values.astype(values.dtype.newbyteorder("="))
    return pd.Series(native.astype(float) if native.dtype.kind == "f" else native)


def _rate(name: str, value: np.ndarray) -> float | None:
    """Samples per second [Hz] of a single number that is named as a rate or an interval."""
    bare = printable(name).lower().replace("_", "").replace(" ", "")
    if value.dtype.kind not in "fiu" or not float(value.reshape(())) > 0.0:
        return None
    number = float(value.reshape(()))
    return number if bare in RATE_NAMES else 1.0 / number if bare in INTERVAL_NAMES else None
