"""Swing of the rope on a trip, with the reduced model and with the full model.

Swing is the displacement of either side relative to its static shape for the same car position, anywhere from a few bending
lengths above the axle to the end of the rope: the maximum during the trip, and half the peak-to-peak value after it.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comprope.drive.trajectory.reference_trajectory import ReferenceTrajectory
from comprope.rope.effects import RopeModel
from comprope.rope.simulator.rope import CompensationRope
from comprope.rope.simulator.side_shape import side_shape

from ..modal.hanging_string import side_string
from ..prescribed_trip import record_trip
from .finite_elements import ELEMENTS, nodes
from .hoist_bounce import HoistBounce
from .sampled_motion import SampledMotion, sample_motion
from .string_dynamics import StringParameters, rest_shape, simulate_string

Floats = NDArray[np.float64]

SIDES = {"car": 1.0, "counterweight": -1.0}
READ_NODES = slice(4, ELEMENTS, 4)  # nodes that are looked at
READ_POSITIONS = nodes()[READ_NODES]  # of a side's length, from the axle to the end
CLEARANCE = 6.0  # bending lengths above the axle: below that the rope leans on the sheave
OBSERVED_PERIODS = 1.25  # slowest periods watched after the trip
SEARCH_STEP = 0.03  # s, step of the search; the slowest swings take seconds


@dataclass(frozen=True)
class Swing:
    """Maximum during the trip and half the peak-to-peak value after it [m], of the side with the larger value."""

    during: float
    after: float


@dataclass(frozen=True)
class ReducedModel:
    """Rope, shaft and hoist for the search; without a hoist the ends follow the trajectory exactly."""

    rope: StringParameters
    height: float
    pit: float
    hoist: HoistBounce | None = None

    @property
    def clearance(self) -> float:
        """Height above the axle [m] from which on the rope is clear of the sheave."""
        return CLEARANCE * self.rope.bending_length

    def length(self, side: str, car: Floats) -> Floats:
        """Length of a side [m] for car heights `car` [m]."""
        return self.pit + (car if side == "car" else self.height - car)

    def ends(self, motion: SampledMotion) -> dict[str, Floats]:
        """Length [m], speed and acceleration of the end, up positive, and contact force on the groove [N] (4, n), by side."""
        bounces = self.hoist.ends(motion) if self.hoist else (0.0, 0.0)
        ends = [
            np.array([self.length(side, motion.position), sign * motion.speed, sign * motion.acceleration]) + added
            for (side, sign), added in zip(SIDES.items(), bounces, strict=True)
        ]
        rotation, translation = (0.5 * (ends[0][2] - sign * ends[1][2]) for sign in (1.0, -1.0))
        level = self.rope.weight + self.rope.vertical_mass * translation
        return {
            side: np.vstack([end, level + sign * self.rope.rotating_mass * rotation])
            for (side, sign), end in zip(SIDES.items(), ends, strict=True)
        }


def observation_time(model: RopeModel, destination: float) -> float:
    """Time [s] after a trip over which the swing is evaluated."""
    return OBSERVED_PERIODS * max(side_string(model, destination, side).period() for side in SIDES)


def departures_from_rest(reduced: ReducedModel, motion: SampledMotion) -> dict[str, tuple[Floats, Floats]]:
    """Lengths (n,) [m] and outward displacements relative to rest (n, places) [m] of the reduced model, by side."""
    found = {}
    for side, (length, speed, acceleration, groove_force) in reduced.ends(motion).items():
        outward = simulate_string(reduced.rope, motion.dt, length, speed, acceleration, groove_force)[:, READ_NODES]
        found[side] = length, outward - rest_shape(reduced.rope, length, READ_POSITIONS)
    return found


def reduced_swing(reduced: ReducedModel, trajectory: ReferenceTrajectory, observation: float, dt: float = SEARCH_STEP) -> Swing:
    """Swing of the reduced model during a trajectory and `observation` [s] after it."""
    motion = sample_motion(trajectory, trajectory.end_time + observation, dt)
    sides = departures_from_rest(reduced, motion).values()
    return largest_swing(
        [side_swing(reduced, motion.time, trajectory.end_time, length, departure) for length, departure in sides]
    )


def side_swing(
    reduced: ReducedModel, time: Floats, end: float, length: Floats, departure: Floats, places: Floats = READ_POSITIONS
) -> Swing:
    """Swing of a side from its displacements (n, places) and lengths (n,); NaN (rope not there) is ignored."""
    samples = np.where(length[:, None] * places >= reduced.clearance, departure, np.nan)
    return swing_of_departures(samples, time > end)


def swing_of_departures(samples: Floats, after: NDArray[np.bool_]) -> Swing:
    """Maximum during the trip and half the peak-to-peak value after it, of displacements (n, places) that may be NaN."""
    during = np.where(np.isfinite(samples), np.abs(samples), 0.0).max()
    rest = samples[after]
    rest = rest[:, np.isfinite(rest).all(axis=0)]
    return Swing(float(during), float(0.5 * np.ptp(rest, axis=0).max(initial=0.0)) if rest.size else 0.0)


def largest_swing(found: list[Swing]) -> Swing:
    """The larger of both values, during and after the trip separately."""
    return Swing(max(one.during for one in found), max(one.after for one in found))


def full_model_swing(
    model: RopeModel, reduced: ReducedModel, trajectory: ReferenceTrajectory, observation: float
) -> tuple[Swing, dict[str, Floats]]:
    """Swing of the full model, the ends following the trajectory exactly; and time [s] and displacements by side."""

    def evaluate(rope: CompensationRope) -> Floats:
        axle, n, q = -model.shaft.pit, rope.n, rope.state.q
        ends = {"car": -q[0], "counterweight": -q[n - 1]}
        return np.array([side_shape(rope, side, axle + READ_POSITIONS * (ends[side] - axle)) for side in SIDES])

    time, samples = record_trip(model, trajectory, trajectory.end_time + observation, evaluate)
    car = np.array([trajectory.at(one).position for one in time])
    traces, found = {"time": time}, []
    for k, side in enumerate(SIDES):
        length = reduced.length(side, car)
        traces[side] = samples[:, k] - rest_shape(reduced.rope, length, READ_POSITIONS)
        found.append(side_swing(reduced, time, trajectory.end_time, length, traces[side]))
    return largest_swing(found), traces
