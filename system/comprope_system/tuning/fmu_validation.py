"""The drive's FMU and the rope's FMU on one trip, with sensors all along both sides: the last word on a controller."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comprope.drive.parameters import Drive
from comprope.drive.trajectory.reference_trajectory import ReferenceTrajectory
from comprope.rope.effects import RopeModel
from comprope.rope.parameters import Sensor

from ..cosim import co_simulate
from ..reduced_model.string_dynamics import at_rest
from ..reduced_model.swing import SIDES, Case, Swing, larger, spread
from ..simulation.elevator import driven
from ..simulation.result_columns import lateral_output, view_output
from .search.profile_families import Way, course_of

Floats = NDArray[np.float64]

EACH = 8  # sensors over a side as it is before the trip, and as many over it as it is after
STEP = 0.02  # s, communication step
BEGIN = 0.5  # s at rest before the trip


@dataclass(frozen=True)
class Trace:
    """Times (n,) [s], the car's height (n,) [m], and by side the departures from rest (n, sensors) [m], NaN without the rope."""

    time: Floats
    car: Floats
    end: float
    departures: dict[str, Floats]

    def swing(self) -> Swing:
        """The swing of both sides."""
        return larger([spread(one, self.time > self.end) for one in self.departures.values()])

    def largest(self) -> Floats:
        """The largest departure anywhere at each time (n,) [m]."""
        both = np.hstack(list(self.departures.values()))
        return np.where(np.isfinite(both), np.abs(both), 0.0).max(axis=1)


def installed(model: RopeModel, case: Case, drive: Drive, way: Way, watched: float, direct: bool = False) -> Trace:
    """Run drive and rope, as FMUs unless `direct`, along a way and `watched` [s] after it."""
    heights = {side: _heights(case, way, side) for side in SIDES}
    sensors = tuple(
        Sensor(name=f"{side}{k}", side=side, height=float(height))  # type: ignore[arg-type]
        for side, each in heights.items()
        for k, height in enumerate(each)
    )
    trip = {"start_position": way.origin, "destination": way.destination, "start_time": BEGIN}
    set_out = drive.model_copy(update={"trip": drive.trip.model_copy(update=trip)})
    course: ReferenceTrajectory = course_of(set_out, way, BEGIN)
    times, cars, seen = [], [], []
    with driven(model.model_copy(update={"sensors": sensors}), set_out, direct) as lift:
        for sample in co_simulate(lift.participants, lift.connections, course.end_time + watched, STEP):
            out = sample.outputs["rope"]
            times.append(sample.time)
            cars.append(sample.outputs["motion"]["car_position"])
            seen.append([out[lateral_output(k)] if out[view_output(k)] else np.nan for k in range(len(sensors))])
    return _trace(case, heights, course.end_time, np.array(times), np.array(cars), np.array(seen))


def _heights(case: Case, way: Way, side: str) -> Floats:
    """Where the sensors of a side are [m above the bottom landing]."""
    lengths = case.length(side, np.array([way.origin, way.destination]))
    return np.concatenate([length * np.linspace(0.08, 0.92, EACH) for length in lengths]) - case.pit


def _trace(case: Case, heights: dict[str, Floats], end: float, time: Floats, car: Floats, seen: Floats) -> Trace:
    """Departures of both sides from their shapes at rest, where the sensors see the rope clear of the sheave."""
    departures, first = {}, 0
    for side, each in heights.items():
        length, above = case.length(side, car), each + case.pit
        rest = np.array([at_rest(case.rope, np.array([one]), np.minimum(above / one, 1.0))[0] for one in length])
        own = seen[:, first : first + len(each)] - rest
        departures[side] = np.where(above >= case.clear, own, np.nan)
        first += len(each)
    return Trace(time, car, end, departures)
