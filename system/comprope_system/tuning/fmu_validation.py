"""The drive's FMU and the rope's FMU on one trip, with sensors all along both sides: the validation of a controller."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comprope.drive.parameters import Drive
from comprope.drive.trajectory.reference_trajectory import ReferenceTrajectory
from comprope.rope.effects import RopeModel
from comprope.rope.parameters import Sensor

from ..simulation.cosim import co_simulate
from ..simulation.trips.elevator import driven_elevator
from ..simulation.trips.result_columns import lateral_output, view_output
from ..vibration.reduced_model.string_dynamics import rest_shape
from ..vibration.reduced_model.swing import SIDES, ReducedModel, Swing, largest_swing, swing_of_departures
from .search.profile_families import Route, trajectory_of

Floats = NDArray[np.float64]

SENSORS_PER_LENGTH = 8  # sensors over a side as it is before the trip, and as many over it as it is after
STEP = 0.02  # s, communication step
REST_BEFORE = 0.5  # s at rest before the trip


@dataclass(frozen=True)
class DepartureTrace:
    """Times (n,) [s], the car's height (n,) [m], and by side the departures from rest (n, sensors) [m], NaN without the rope."""

    time: Floats
    car: Floats
    end: float
    departures: dict[str, Floats]

    def swing(self) -> Swing:
        """The swing of both sides."""
        return largest_swing([swing_of_departures(one, self.time > self.end) for one in self.departures.values()])

    def largest(self) -> Floats:
        """The largest departure anywhere at each time (n,) [m]."""
        both = np.hstack(list(self.departures.values()))
        return np.where(np.isfinite(both), np.abs(both), 0.0).max(axis=1)


def simulate_route(
    model: RopeModel, reduced: ReducedModel, drive: Drive, route: Route, observation: float, direct: bool = False
) -> DepartureTrace:
    """Run drive and rope, as FMUs unless `direct`, along a route and `observation` [s] after it."""
    heights = {side: _heights(reduced, route, side) for side in SIDES}
    sensors = tuple(
        Sensor(name=f"{side}{k}", side=side, height=float(height))  # type: ignore[arg-type]
        for side, each in heights.items()
        for k, height in enumerate(each)
    )
    trip = {"start_position": route.origin, "destination": route.destination, "start_time": REST_BEFORE}
    trip_drive = drive.model_copy(update={"trip": drive.trip.model_copy(update=trip)})
    trajectory: ReferenceTrajectory = trajectory_of(trip_drive, route, REST_BEFORE)
    times, cars, samples = [], [], []
    with driven_elevator(model.model_copy(update={"sensors": sensors}), trip_drive, direct) as elevator:
        for sample in co_simulate(elevator.participants, elevator.connections, trajectory.end_time + observation, STEP):
            rope_outputs = sample.outputs["rope"]
            times.append(sample.time)
            cars.append(sample.outputs["motion"]["car_position"])
            samples.append(
                [rope_outputs[lateral_output(k)] if rope_outputs[view_output(k)] else np.nan for k in range(len(sensors))]
            )
    return _trace(reduced, heights, trajectory.end_time, np.array(times), np.array(cars), np.array(samples))


def _heights(reduced: ReducedModel, route: Route, side: str) -> Floats:
    """Where the sensors of a side are [m above the bottom landing]."""
    lengths = reduced.length(side, np.array([route.origin, route.destination]))
    return np.concatenate([length * np.linspace(0.08, 0.92, SENSORS_PER_LENGTH) for length in lengths]) - reduced.pit


def _trace(
    reduced: ReducedModel, heights: dict[str, Floats], end: float, time: Floats, car: Floats, samples: Floats
) -> DepartureTrace:
    """Displacements of both sides relative to their static shapes, at sensors above the sheave."""
    departures, first = {}, 0
    for side, each in heights.items():
        length, above = reduced.length(side, car), each + reduced.pit
        rest = np.array([rest_shape(reduced.rope, np.array([one]), np.minimum(above / one, 1.0))[0] for one in length])
        own = samples[:, first : first + len(each)] - rest
        departures[side] = np.where(above >= reduced.clearance, own, np.nan)
        first += len(each)
    return DepartureTrace(time, car, end, departures)
