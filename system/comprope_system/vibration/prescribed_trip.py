"""Simulation of the rope on a prescribed jerk-limited trip, without drive and FMU, for studies and verification.

The car follows the trip exactly and the counterweight mirrors it. Within an interval the ends follow
quintics through position, velocity and acceleration at both of its ends, which equals the trip
except where its jerk is discontinuous.
"""

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from comprope.drive.trajectory.reference_trajectory import ReferenceTrajectory
from comprope.drive.trajectory.s_curve import SCurve, TrajectoryPoint
from comprope.rope.parameters import Base
from comprope.rope.simulator.rope import CompensationRope

Floats = NDArray[np.float64]

INTERVAL = 0.02  # s between samples



def ends_path(model: Base, trip: SCurve | ReferenceTrajectory, begin: float, end: float) -> Floats:
    """Path of both ends between two times [s], in the format of `CompensationRope.step`."""
    height, radius = model.shaft.height, model.sheave.radius
    rows = [_moments(trip.at(time), height, radius) for time in (begin, end)]
    return np.concatenate(rows, axis=1).ravel()


def _moments(motion: TrajectoryPoint, height: float, radius: float) -> Floats:
    """Position, velocity and acceleration (4, 3) of car x, car y, counterweight x and y; x is down."""
    x, v, a = motion.position, motion.velocity, motion.acceleration
    return np.array([[-x, -v, -a], [-radius, 0.0, 0.0], [x - height, v, a], [radius, 0.0, 0.0]])


def simulate_trip(
    rope: CompensationRope, trip: SCurve | ReferenceTrajectory, until: float, interval: float = INTERVAL
) -> Iterator[float]:
    """Solve static equilibrium at the start of the trip and simulate it; yields the time [s] of each sample, 0 first.

    Raises `SimulationError` where a step cannot be saved.
    """
    model = rope.model
    rope.solve_equilibrium(trip.origin, model.shaft.height - trip.origin)
    yield 0.0
    for k in range(max(1, round(until / interval))):
        rope.step(interval, ends_path(model, trip, k * interval, (k + 1) * interval))
        yield (k + 1) * interval


def record_trip(
    model: Base, trip: SCurve | ReferenceTrajectory, until: float, evaluate: Callable[[CompensationRope], Floats]
) -> tuple[Floats, Floats]:
    """Times (n,) and the values `evaluate` returns for the rope at each of them (n, ...)."""
    rope = CompensationRope(model)
    samples = [(time, evaluate(rope)) for time in simulate_trip(rope, trip, until)]
    return np.array([time for time, _ in samples]), np.array([values for _, values in samples])

