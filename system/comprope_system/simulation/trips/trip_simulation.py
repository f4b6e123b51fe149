"""One trip from start to end: run the elevator, record its columns, sum it up."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from comprope.atomic_files import atomic_write
from comprope.rope.parameters import Base

from ..building_motion.motion import BuildingMotion
from ..cosim import Sample, co_simulate
from .elevator import Elevator
from .result_columns import Column, columns, lateral_output, view_output
from .timing import Timing

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Simulated:
    """A simulated trip: `table` with a column `time` [s] and one for each of `columns`; `sensors` are names of some."""

    table: pd.DataFrame
    columns: tuple[Column, ...]
    sensors: tuple[str, ...]

    def to_csv(self, path: str | Path) -> None:
        """Write the table, completely or not at all; missing values are empty cells."""
        with atomic_write(path) as temporary:
            self.table.to_csv(temporary, index=False, float_format="%.9g", lineterminator="\n")


def simulate(elevator: Elevator, sensors: Sequence[str], timing: Timing, progress: Progress | None = None) -> Simulated:
    """Run the elevator from its first time on and record every communication step after the run-up.

    `sensors` are the names of the model's sensors in their order; `progress(count, total)` is called after each step.
    """
    chosen = columns(sensors, elevator.driven, elevator.moving, elevator.tripping)
    rows = []
    before = timing.steps_before * timing.step
    for sample in co_simulate(
        elevator.participants, elevator.connections, before + timing.duration, timing.step, timing.begin - before, timing.coupling
    ):
        if sample.count >= timing.steps_before:
            rows.append(_row(sample, chosen, sensors))
        if progress:
            progress(sample.count, sample.total)
    table = pd.DataFrame(rows, columns=["time", *(one.name for one in chosen)])
    return Simulated(table, tuple(chosen), tuple(sensors))


def relative_to_building(simulated: Simulated, model: Base, motion: BuildingMotion) -> Simulated:
    """The trip as sensors see it that are fixed to the building, and move with it at their heights."""
    table, times = simulated.table.copy(), simulated.table["time"].to_numpy()
    for sensor in model.sensors:
        outward = 1.0 if sensor.side == "counterweight" else -1.0
        table[sensor.name] -= outward * motion.displacements([sensor.height], times)[:, 0]
    return replace(simulated, table=table)


def _row(sample: Sample, chosen: Sequence[Column], sensors: Sequence[str]) -> list[Any]:
    hidden = {lateral_output(k) for k in range(len(sensors)) if not sample.outputs["rope"][view_output(k)]}
    values = (np.nan if one.output in hidden else sample.outputs[one.source][one.output] for one in chosen)
    return [round(sample.time, 9), *values]


def summary(simulated: Simulated, rest: Mapping[str, NDArray[np.float64]]) -> list[tuple[str, str]]:
    """Key figures of a trip as pairs of name and text; `rest` are displacements (n,) [m] of the static shape by sensor."""
    table = simulated.table
    force = table["sheave_force"]
    end = table.iloc[-1]
    return [
        ("duration", f"{end['time']:.2f} s"),
        ("car", travel(table)),
        *((f"peak at {name}", _peak(table, name, rest[name])) for name in simulated.sensors),
        ("sheave force", f"{force.min():.1f} N to {force.max():.1f} N"),
        ("sheave displacement", f"{_range(table['sheave_displacement'])} mm"),
        *_slack(table),
        *_hoist(table),
        ("energy residual", f"{table['energy_residual'].abs().max():.2g} J at most"),
        ("Newton iterations", f"{end['newton_iterations']:.0f}, {end['halvings']:.0f} steps halved"),
    ]


def _slack(table: pd.DataFrame) -> list[tuple[str, str]]:
    """How much rope was slack, for how long, and the largest tension; nothing of a trip without slack rope."""
    if not table["slack_duration"].iloc[-1] > 0.0:
        return []
    slack = f"{table['slack_length'].max():.1f} m at most, {table['slack_duration'].iloc[-1]:.2f} s"
    return [("slack rope", slack), ("peak tension", f"{table['peak_element_tension'].iloc[-1]:.0f} N")]


def travel(table: pd.DataFrame) -> str:
    """Heights of the car at the start and at the end."""
    return f"{_height(table['car_position'].iloc[0])} to {_height(table['car_position'].iloc[-1])}"


def _hoist(table: pd.DataFrame) -> list[tuple[str, str]]:
    """What the hoist ropes do in a trip of the drive: slack, slip, largest tension; nothing of other trips."""
    if "traction_slip" not in table:
        return []
    slack = float(table["hoist_rope_slack"].sum() * (table["time"].iloc[1] - table["time"].iloc[0]))
    most = table[["car_hoist_tension", "counterweight_hoist_tension"]].max().max()
    slip = 1e3 * table["traction_slip"].abs().max()
    return [("hoist ropes", f"slack for {slack:.2f} s, slip {slip:.0f} mm at most, tension up to {1e-3 * most:.1f} kN")]


def _height(value: float) -> str:
    return f"{round(value, 2) + 0.0:.2f} m"


def _peak(table: pd.DataFrame, name: str, rest: NDArray[np.float64]) -> str:
    """Largest deviation from the shape at rest with the car where it is, with its time."""
    swing = table[name] - rest
    if not swing.notna().any():
        return "the rope was never in view"
    at = swing.abs().idxmax()
    return f"{1e3 * swing[at]:+.2f} mm from the shape at rest, at {table['time'][at]:.2f} s"


def _range(values: pd.Series) -> str:
    return f"{1e3 * values.min():.3f} to {1e3 * values.max():.3f}"
