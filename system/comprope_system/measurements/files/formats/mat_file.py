"""MATLAB files of version 5, which `save` writes unless told otherwise; those of version 7.3 are HDF5 files."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io

from ..file_format import FileFormat
from ..raw_table import RawTable
from .arrays import Array, require_arrays, table_of_arrays

NAMES, VALUES, UNITS = ("name", "label"), ("values", "data"), ("unit", "units")  # fields of structures


def read(path: Path, stated: FileFormat) -> RawTable:
    """The table of the file's vectors, those in structures included."""
    content = scipy.io.loadmat(path, squeeze_me=True, struct_as_record=True)
    arrays: dict[str, Array] = {}
    named = {name: value for name, value in content.items() if not name.startswith("__")}
    for name, value in named.items():
        _collect(arrays, name, value)
    require_arrays(arrays, [name for name, value in named.items() if isinstance(value, scipy.io.matlab.MatlabOpaque)])
    units = {name: str(unit) for name, unit in content.items() if isinstance(unit, str)}
    by_name = {path: units[key] for path in arrays for key in (f"{path}_unit", f"{path}_units") if key in units}
    return table_of_arrays({path: replace(one, unit=by_name.get(path, one.unit)) for path, one in arrays.items()}, stated.sheet)


def _collect(arrays: dict[str, Array], path: str, value: Any) -> None:
    """Vectors of a variable or of a structure's fields, by path."""
    if isinstance(value, scipy.io.matlab.MatlabOpaque):
        return
    if isinstance(value, np.ndarray) and value.dtype.names and (fields := _named_signals(value.dtype.names)):
        for one in value.reshape(-1):
            unit = str(one[fields[2]]) if fields[2] else None
            arrays[f"{path}/{one[fields[0]]}"] = Array(one[fields[1]], unit)
    elif isinstance(value, np.void) or (isinstance(value, np.ndarray) and value.dtype.names and value.size == 1):
        one = value if isinstance(value, np.void) else value.reshape(-1)[0]
        if fields := _named_signals(one.dtype.names or ()):
            arrays[f"{path}/{one[fields[0]]}"] = Array(one[fields[1]], str(one[fields[2]]) if fields[2] else None)
            return
        for name in one.dtype.names or ():
            _collect(arrays, f"{path}/{name}", one[name])
    elif isinstance(value, np.ndarray) and value.dtype == object and value.size == 1:
        _collect(arrays, path, value.reshape(-1)[0])
    elif isinstance(value, np.ndarray | int | float | np.number) and not isinstance(value, bool):
        arrays[path] = Array(value)


def _named_signals(fields: Sequence[str]) -> tuple[str, str, str | None] | None:
    """Fields of name, values and unit of structures that hold a signal each (Simulink, dSPACE); None of other structures."""
    lower = {one.lower(): one for one in fields}
    name, data, unit = (next((lower[key] for key in keys if key in lower), None) for keys in (NAMES, VALUES, UNITS))
    return (name, data, unit) if name and data else None
