"""Curves shown with an animation: sensor signals, and motion of car and sheave."""

from numpy.typing import ArrayLike

from ..measured_run import Run
from ..plot import alongside
from ..trip_simulation import Simulated
from .encoding import Trace

SAMPLES = 2400  # of a curve at most; a page shows about 500 across
OTHER_TRACES = (  # column, name, factor, unit
    ("car_velocity", "speed of the car", 1.0, "m/s"),
    ("sheave_displacement", "height of the sheave", 1e3, "mm"),
    ("sheave_force", "force on the sheave", 1.0, "N"),
    ("car_end_tension", "pull on the car", 1.0, "N"),
)


def traces(simulated: Simulated, measured: Run | None = None) -> list[Trace]:
    """Sensor signals [mm], followed by car and sheave, each with what was measured of it."""
    table = simulated.table.iloc[:: _stride(len(simulated.table))]
    time = table["time"]
    seen = [
        Trace(name, "mm", time, 1e3 * table[name], k, _measured(simulated, name, measured, 1e3))
        for k, name in enumerate(simulated.sensors)
    ]
    others = [
        Trace(name, unit, time, factor * table[column], None, _measured(simulated, column, measured, factor))
        for column, name, factor, unit in OTHER_TRACES
    ]
    return seen + others


def _measured(simulated: Simulated, name: str, measured: Run | None, factor: float) -> tuple[ArrayLike, ArrayLike] | None:
    if not measured or name not in measured.channels:
        return None
    time, value = alongside(measured.channels[name], measured, simulated, name)
    stride = _stride(len(time))
    return time[::stride], factor * value[::stride]


def _stride(length: int) -> int:
    return -(-length // SAMPLES)
