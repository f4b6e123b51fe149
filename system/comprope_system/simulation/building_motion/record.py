"""The building's motion from the record that a model file names in `[building]`."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from comprope.errors import InputError
from comprope.rope.effects import RopeModel
from comprope.rope.parameters import Building

from ...measurements.columns.clock_columns import clock_columns
from ...measurements.columns.column_names import find_column
from ...measurements.columns.readings import numbers_of, written_unit
from ...measurements.columns.time_axis import time_axis
from ...measurements.files import RawColumn, RawTable, read_raw_table
from ...measurements.files.file_format import FileFormat
from ...measurements.units import MOTIONS, unit_named
from .motion import BuildingMotion

Floats = NDArray[np.float64]
UNITS = {"displacement": MOTIONS["position"], "acceleration": MOTIONS["acceleration"]}
FEWEST = 5  # samples of a record
LARGEST = {"displacement": 5.0, "acceleration": 50.0}  # m relative to the base, m/s2 of the base: what the rope's inputs accept
CAMPAIGN_ADVICE = ": if samples are even"  # begins what a campaign.toml could say about times that do not increase
SLOW_START = 1e-3  # m/s of the building at the start of the simulation that are worth a remark


@dataclass(frozen=True)
class BuildingRecord:
    """The motion that a record gives the building, in simulated time, and remarks about it."""

    motion: BuildingMotion
    remarks: tuple[str, ...]
    name: str

    def require_duration(self, end: float) -> None:
        """Raise `InputError` for a simulation that ends after the record, at a time [s]."""
        if end > self.motion.end + 1e-9:
            raise InputError(
                f"building.record = {self.name}: ends {self.motion.end:g} s after the simulation begins, which lasts {end:g} s; "
                "a longer record or a shorter simulation (--time) is accepted"
            )


def building_record(model: RopeModel) -> BuildingRecord | None:
    """The motion of the building of a model; None for a model without `[building]`.

    Raises `InputError` with all problems of the record, each with the record's name.
    """
    building = model.building
    if building is None:
        return None
    _require_heights(building, model)
    path = Path(building.record)
    times, values, remarks = _read(path, building)
    begin = times[0] + building.start
    if times[-1] - begin < (FEWEST - 1) * float(np.median(np.diff(times))):
        raise InputError(f"building.start = {building.start:g} s: the record {path.name} lasts {times[-1] - times[0]:g} s")
    kept = times >= begin - 1e-9
    clock, readings = times[kept] - begin, values[kept] * _window(times[kept] - begin, building.fade_in)[:, None]
    coordinates, own = _coordinates(clock, readings, building.quantity)
    shapes = building.shapes or np.eye(len(building.heights))
    motion = BuildingMotion(building.heights, shapes, coordinates, -model.shaft.pit)
    _require_size(motion, model, path.name)
    return BuildingRecord(motion, (*remarks, *own, *_abrupt(motion, model)), path.name)


def _require_heights(building: Building, model: RopeModel) -> None:
    """Raise `InputError` for a building that is lower than the shaft, or begins above the sheave."""
    low, high, shaft = building.heights[0], building.heights[-1], model.shaft
    if low > -shaft.pit or high < shaft.height:
        raise InputError(
            f"building.heights = {low:g} to {high:g} m: from the sheave's axle, at {-shaft.pit:g} m, or lower, to the top "
            f"landing, at {shaft.height:g} m, or higher, is accepted"
        )


def _read(path: Path, building: Building) -> tuple[Floats, Floats, list[str]]:
    """Times (n,) [s] and columns (n, k) in SI units of a record, and remarks; rows with an empty cell are left out."""
    table, problems, remarks = read_raw_table(path, FileFormat()), list[str](), list[str]()

    def collected(read: Callable[..., Floats], *arguments: Any) -> Floats | None:
        try:
            return read(*arguments)
        except InputError as error:
            problems.extend(f"building.record = {path.name}: {line}" for line in str(error).splitlines())
            return None

    times = collected(_times, table)
    columns = [collected(_column, table, name, building, remarks) for name in building.columns]
    if problems or times is None:
        raise InputError("\n".join(problems))
    values = np.column_stack([one for one in columns if one is not None])
    good = np.isfinite(times) & np.isfinite(values).all(axis=1)
    if lost := int((~good).sum()):
        remarks.append(f"{path.name}: {lost} of {len(good)} rows have an empty cell and are interpolated")
    if good.sum() < FEWEST:
        raise InputError(f"building.record = {path.name}: {good.sum()} complete rows; {FEWEST} or more are accepted")
    return times[good], values[good], remarks


def _times(table: RawTable) -> Floats:
    clocks = clock_columns(table, None)
    if not clocks:
        names = ", ".join(one.name for one in table.columns)
        raise InputError(f"no column of times; the header has {names}, and time is accepted")
    try:
        return time_axis(clocks[0], table, FileFormat()).seconds
    except InputError as error:
        raise InputError(str(error).partition(CAMPAIGN_ADVICE)[0]) from None


def _column(table: RawTable, name: str, building: Building, remarks: list[str]) -> Floats:
    column = find_column(table, name)
    values, own = numbers_of(column, table, (), ())
    remarks.extend(own)
    return values * UNITS[building.quantity][_unit(column, building)]


def _unit(column: RawColumn, building: Building) -> str:
    """The unit of a column, as the file or the model states it; raises `InputError` if they differ, or there is none."""
    written, accepted = written_unit(column), UNITS[building.quantity]
    own = unit_named(written) if written else None
    stated = unit_named(building.unit) if building.unit else None
    shown = ", ".join(accepted)
    if building.unit and stated not in accepted:
        raise InputError(f"building.unit = {building.unit}: no unit of a {building.quantity}; {shown} is accepted")
    if own and own not in accepted:
        raise InputError(f"{column.name}: its unit {written} is none of a {building.quantity}; {shown} is accepted")
    if own and stated and accepted[own] != accepted[stated]:
        raise InputError(f"{column.name}: the file states {written}, building.unit {building.unit}; one of them is accepted")
    found = own or stated
    if found is None:
        raise InputError(f"{column.name}: its unit is unknown; building.unit = {shown} is accepted")
    return found


def _window(clock: Floats, fade: float) -> Floats:
    """Factor (n,) that grows from 0 to 1 by half a cosine over `fade` [s]."""
    share = np.clip(clock / fade, 0.0, 1.0) if fade > 0.0 else np.ones(len(clock))
    return 0.5 * (1.0 - np.cos(np.pi * share))


def _coordinates(clock: Floats, readings: Floats, quantity: str) -> tuple[CubicSpline, list[str]]:
    """The coordinates [m] as a spline in time; accelerations are integrated from rest, less the drift.

    The drift is the polynomial a t^2 + b t^3 nearest to the displacement: a constant and a growing error of the acceleration, as
    in the usual correction of the baseline of strong-motion records.
    """
    if quantity == "displacement":
        return CubicSpline(clock, readings), []
    displaced = CubicSpline(clock, readings).antiderivative(2)(clock)
    drift = np.column_stack([clock**2, clock**3]) / np.array([clock[-1] ** 2, clock[-1] ** 3])
    removed = drift @ np.linalg.lstsq(drift, displaced, rcond=None)[0]
    largest = float(np.abs(removed).max())
    return CubicSpline(clock, displaced - removed), [f"accelerations integrated twice; a drift of up to {largest:.3g} m removed"]


def _require_size(motion: BuildingMotion, model: RopeModel, name: str) -> None:
    """Raise `InputError` for a motion that no building survives: its unit is another one."""
    clock = np.linspace(motion.begin, motion.end, 2001)
    top, limit = model.shaft.height, LARGEST["displacement"]
    moved = float(np.abs(motion.displacements([0.0, 0.5 * top, top], clock)).max())
    shaken = max(abs(motion.base_acceleration(float(at))) for at in clock)
    if not moved <= limit:
        raise InputError(
            f"building.record = {name}: the building moves by {moved:.3g} m relative to its base; at most {limit:g} m is "
            "accepted; check building.unit"
        )
    if not shaken <= LARGEST["acceleration"]:
        raise InputError(
            f"building.record = {name}: the base is accelerated by {shaken:.3g} m/s2; at most {LARGEST['acceleration']:g} m/s2 "
            "is accepted; check building.unit and the times"
        )


def _abrupt(motion: BuildingMotion, model: RopeModel) -> list[str]:
    """A remark about a building that does not start from rest."""
    before, after = motion.displacements([model.shaft.height], [motion.begin, motion.begin + 1e-3])[:, 0]
    speed = abs(after - before) / 1e-3
    if speed < SLOW_START:
        return []
    return [f"the top of the building starts at {1e3 * speed:.3g} mm/s; building.fade_in lets the motion grow from nothing"]
