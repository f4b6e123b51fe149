"""MATLAB files of version 5, which `save` writes unless told otherwise; those of version 7.3 are HDF5 files."""

from pathlib import Path
from typing import Any

import numpy as np
import scipy.io

from ..file_format import FileFormat
from ..raw_table import RawTable
from .arrays import table_of_arrays


def read(path: Path, stated: FileFormat) -> RawTable:
    """The table of the file's vectors, those in structures included."""
    content = scipy.io.loadmat(path, squeeze_me=True, struct_as_record=True)
    arrays: dict[str, Any] = {}
    for name, value in content.items():
        if not name.startswith("__"):
            _collect(arrays, name, value)
    units = {name: str(unit) for name, unit in content.items() if isinstance(unit, str)}
    by_name = {path: units[key] for path in arrays for key in (f"{path}_unit", f"{path}_units") if key in units}
    return table_of_arrays(arrays, by_name, stated.sheet)


def _collect(arrays: dict[str, Any], path: str, value: Any) -> None:
    """Vectors of a variable or of a structure's fields, by path."""
    if isinstance(value, np.ndarray) and value.dtype.names and {"values", "label"} <= set(value.dtype.names):
        for one in value.reshape(-1):  # Simulink's structure with time
            arrays[f"{path}/{one['label']}"] = one["values"]
    elif isinstance(value, np.void) or (isinstance(value, np.ndarray) and value.dtype.names and value.size == 1):
        one = value if isinstance(value, np.void) else value.reshape(-1)[0]
        for name in one.dtype.names or ():
            _collect(arrays, f"{path}/{name}", one[name])
    elif isinstance(value, np.ndarray) and value.dtype == object and value.size == 1:
        _collect(arrays, path, value.reshape(-1)[0])
    elif isinstance(value, np.ndarray | int | float | np.number) and not isinstance(value, bool):
        arrays[path] = value
