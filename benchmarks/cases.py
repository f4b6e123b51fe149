"""What the benchmarks run: ropes of the presets, and trips of their ends."""

import time
from dataclasses import dataclass

import numpy as np

from comprope.drive.parameters import Profile
from comprope.drive.trajectory.s_curve import SCurve, plan_s_curve
from comprope.rope.model_file import RopeModel, load, with_changes
from comprope.rope.simulator.rope import CompensationRope
from comprope_system.presets import model_path

COMMUNICATION = 0.02  # s
PROFILES = {"tower50": Profile(), "building200": Profile(speed=9.0, acceleration=1.1, jerk=0.93)}


def model(preset: str, **changes: float) -> RopeModel:
    """A preset with values such as `solver__step` changed."""
    return with_changes(load(model_path(preset)), {key.replace("__", "."): value for key, value in changes.items()})


def trip(preset: str, origin: float, destination: float) -> SCurve:
    """The fastest trip between two heights [m] that the preset's elevator makes, half a second after the start."""
    return plan_s_curve(PROFILES[preset], origin, destination, 0.5)


def path(model: RopeModel, trip: SCurve, start: float, end: float) -> np.ndarray:
    """The way of the ends from one time to another [s]; the counterweight mirrors the car."""
    ways, radius = np.zeros((4, 6)), model.sheave.radius
    ways[1, [0, 3]], ways[3, [0, 3]] = -radius, radius
    for column, at in ((0, trip.at(start)), (3, trip.at(end))):
        ways[0, column : column + 3] = -at.position, -at.velocity, -at.acceleration
        ways[2, column : column + 3] = at.position - model.shaft.height, at.velocity, at.acceleration
    return ways.ravel()


@dataclass(frozen=True)
class Cost:
    """What a run has cost: seconds of processor time, seconds simulated, and the counts of the solver."""

    cpu: float
    simulated: float
    nodes: int
    steps: int
    newton: int
    halved: int

    @property
    def per_second(self) -> float:
        """Processor seconds per simulated second."""
        return self.cpu / self.simulated

    @property
    def per_iteration(self) -> float:
        """Microseconds per Newton iteration."""
        return 1e6 * self.cpu / self.newton


def ride(model: RopeModel, trip: SCurve, until: float) -> tuple[CompensationRope, Cost]:
    """The rope at time `until` [s] of a trip, and what it cost from rest to there; settling is not in the cost."""
    rope = CompensationRope(model)
    rope.solve_equilibrium(trip.origin, model.shaft.height - trip.origin)
    rope.step(COMMUNICATION, path(model, trip, 0.0, 0.0))  # loads what is compiled
    rope.solve_equilibrium(trip.origin, model.shaft.height - trip.origin)
    count, begin = round(until / COMMUNICATION), time.process_time()
    for k in range(count):
        rope.step(COMMUNICATION, path(model, trip, k * COMMUNICATION, (k + 1) * COMMUNICATION))
    return rope, Cost(time.process_time() - begin, count * COMMUNICATION, rope.n, **rope.count)
