"""HDF5 files, and MATLAB files of version 7.3, which are HDF5 files."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from ..file_format import FileFormat
from ..raw_table import RawTable
from .arrays import Array, rate_named, require_arrays, table_of_arrays

UNIT_ATTRIBUTES = ("unit", "units", "Unit", "Units", "unit_string")
FILL_ATTRIBUTES = ("_FillValue", "missing_value")
NAME_ATTRIBUTES = ("columns", "names", "column_names", "fields")


def read(path: Path, stated: FileFormat) -> RawTable:
    """The table of the file's datasets: vectors, fields of compound datasets, and columns of matrices."""
    arrays: dict[str, Array] = {}
    objects: list[str] = []

    def visit(name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset) and not name.startswith("#"):
            objects.extend([name] if _is_object(item) else [])
            _collect(arrays, name, item)

    with h5py.File(path, "r") as file:
        file.visititems(visit)
    require_arrays(arrays, objects)
    return table_of_arrays(arrays, stated.sheet)


def _collect(arrays: dict[str, Array], name: str, item: Any) -> None:
    """The vectors of a dataset. What is linked from another file is not followed, so that nothing outside is read."""
    if item.is_virtual or item.external:
        return
    values = item[()]
    if item.attrs.get("MATLAB_class", b"") in (b"char", b"cell") or _is_object(item):
        return
    if item.dtype.names:
        arrays |= {f"{name}/{field}": Array(values[field]) for field in item.dtype.names}
        return
    titles = next((_texts(item.attrs[key]) for key in NAME_ATTRIBUTES if key in item.attrs), None)
    if titles and np.ndim(values) == 2 and len(titles) in values.shape:
        own = values if values.shape[1] == len(titles) else values.T
        arrays |= {f"{name}/{title}": Array(own[:, k]) for k, title in enumerate(titles)}
        return
    unit = next((item.attrs[key] for key in UNIT_ATTRIBUTES if key in item.attrs), None)
    arrays[name] = Array(_unpacked(values, item.attrs), _texts(unit)[0] if unit else None, _interval(item.attrs))


def _unpacked(values: Any, attributes: Mapping[str, Any]) -> Any:
    """The values of numbers that are stored with a scale, an offset and fill values, as netCDF files hold them."""
    scale, offset = _number(attributes, "scale_factor", 1.0), _number(attributes, "add_offset", 0.0)
    fills = [np.ravel(attributes[key]) for key in FILL_ATTRIBUTES if key in attributes]
    if np.asarray(values).dtype.kind not in "fiu" or ((scale, offset) == (1.0, 0.0) and not fills):
        return values
    known = np.where(np.isin(values, np.concatenate(fills)), np.nan, values) if fills else values
    return scale * known + offset


def _is_object(item: Any) -> bool:
    """Whether a dataset stands for an object of MATLAB's own, such as a timetable, whose values are hidden elsewhere."""
    return "MATLAB_object_decode" in item.attrs and item.attrs.get("MATLAB_class", b"") != b"logical"


def _interval(attributes: Mapping[str, Any]) -> float | None:
    """Interval of the samples [s] that attributes state, as waveforms have it; None if they state none."""
    single = {key: np.asarray(value) for key, value in attributes.items() if np.size(value) == 1}
    rates = [rate for key, value in single.items() if (rate := rate_named(key, value))]
    return 1.0 / rates[0] if len(rates) == 1 else None


def _number(attributes: Mapping[str, Any], key: str, default: float) -> float:
    value = np.ravel(attributes.get(key, default))
    return float(value[0]) if value.size == 1 and value.dtype.kind in "fiu" else default


def _texts(value: Any) -> list[str]:
    return [one.decode("utf-8", "replace") if isinstance(one, bytes) else str(one) for one in np.atleast_1d(value)]
