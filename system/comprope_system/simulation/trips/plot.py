"""Plot of one trip: car, rope at each sensor, and sheave."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from comprope.atomic_files import atomic_write

from ...report.plot_style import plain
from .measured_run import Channel, Run
from .trip_simulation import Simulated

Floats = NDArray[np.float64]
REST = 0.2  # s at the start of a record that count as rest, where the car moves from the first sample on
MOVED = "car_lateral_displacement"  # a column of trips in a building that moves
SIMULATED, MEASURED, SECOND = "#0b4f8a", "#e8893b", "#7a8794"


def save_trip(path: Path, simulated: Simulated, measured: Run | None = None) -> None:
    """Plot a trip to a file, completely or not at all; the extension determines the format."""
    figure = draw_trip(simulated, measured)
    with atomic_write(path) as temporary:
        figure.savefig(temporary, dpi=150)


def draw_trip(simulated: Simulated, measured: Run | None = None) -> Figure:
    """Figure with car and sheave on the left, lateral displacement at each sensor on the right."""
    shown = 5 if MOVED in simulated.table else 4  # a fifth panel for a building that moves
    rows = max(shown, len(simulated.sensors))
    figure = Figure(figsize=(13.0, 2.1 * rows + 0.6), layout="constrained")
    grid = figure.add_gridspec(rows, 2)
    left = [figure.add_subplot(grid[row, 0]) for row in range(shown)]
    right = [figure.add_subplot(grid[row, 1]) for row in range(len(simulated.sensors))]
    _draw_car(left[0], left[1], simulated)
    _draw_sheave(left[2], left[3], simulated, measured)
    if MOVED in simulated.table:
        _draw_building(left[4], simulated)
    for axes, name in zip(right, simulated.sensors, strict=True):
        _draw_sensor(axes, simulated, name, measured)
    for axes in (*left, *right):
        _dress(axes, float(simulated.table["time"].iloc[-1]))
    for column in (left, right):
        if column:
            column[-1].set_xlabel("time [s]")
    return figure


def _draw_car(height: Axes, acceleration: Axes, simulated: Simulated) -> None:
    table = simulated.table
    _curve(height, table["time"], table["car_position"], "height of the car [m]")
    _curve(acceleration, table["time"], table["car_acceleration"], "acceleration [m/s²]")
    height.set_title("Car and sheave", loc="left", fontweight="bold")


def _draw_sheave(force: Axes, motion: Axes, simulated: Simulated, measured: Run | None) -> None:
    table = simulated.table
    _curve(force, table["time"], table["sheave_force"], "force on sheave [N]")
    for axes, name, factor in ((force, "sheave_force", 1.0), (motion, "sheave_displacement", 1e3)):
        if measured and name in measured.channels:
            time, value = alongside(measured.channels[name], measured, simulated, name)
            axes.plot(time, factor * value, color=MEASURED, linewidth=0.8, label="measured")
    _curve(motion, table["time"], 1e3 * table["sheave_displacement"], "height of sheave [mm]")
    turning = motion.twinx()
    turning.plot(table["time"], table["sheave_angular_velocity"], color=SECOND, linewidth=0.9)
    turning.set_ylabel("angular velocity [rad/s]", color=SECOND)
    turning.spines["top"].set_visible(False)


def _draw_building(axes: Axes, simulated: Simulated) -> None:
    table = simulated.table
    for side, colour in (("car", SIMULATED), ("counterweight", MEASURED)):
        axes.plot(table["time"], 1e3 * table[f"{side}_lateral_displacement"], color=colour, linewidth=1.0, label=side)
    axes.set_ylabel("ends with the\nbuilding, outward [mm]")
    axes.legend(loc="best", frameon=False, ncols=2)


def _draw_sensor(axes: Axes, simulated: Simulated, name: str, measured: Run | None) -> None:
    table = simulated.table
    if measured and name in measured.channels:
        time, value = alongside(measured.channels[name], measured, simulated, name)
        axes.plot(time, 1e3 * value, color=MEASURED, linewidth=0.8, label="measured")
    _curve(axes, table["time"], 1e3 * table[name], f"{name} [mm]")
    if name == simulated.sensors[0]:
        axes.set_title("Lateral displacement of the rope, outward", loc="left", fontweight="bold")
        if measured:
            axes.legend(loc="best", frameon=False, ncols=2)


def alongside(channel: Channel, measured: Run, simulated: Simulated, name: str) -> tuple[Floats, Floats]:
    """Times and values [SI] of a measured channel; if relative to rest, shifted to the simulated value at rest."""
    shift = 0.0
    if channel.from_rest:
        still = channel.time <= max(measured.trips["car"].rest_before, measured.begin + REST)
        seen = channel.value[still & np.isfinite(channel.value)]
        shift = float(simulated.table[name].iloc[0]) - float(np.mean(seen)) if len(seen) else 0.0
    shown = channel.time <= simulated.table["time"].iloc[-1]
    return channel.time[shown], channel.value[shown] + shift


def _curve(axes: Axes, time: ArrayLike, value: ArrayLike, label: str) -> None:
    axes.plot(time, value, color=SIMULATED, linewidth=1.2, label="simulated")
    axes.set_ylabel(plain(label))


def _dress(axes: Axes, end: float) -> None:
    axes.set_xlim(0.0, end)
    axes.grid(color="#e3e6ea", linewidth=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.margins(y=0.08)
