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

from ..modal.hanging_string import side_string
from ..prescribed_trip import record, side_shape
from .finite_elements import ELEMENTS, nodes
from .hoist_bounce import Hoist
from .sampled_motion import Moves, moves
from .string_dynamics import Rope, at_rest, sway

Floats = NDArray[np.float64]

SIDES = {"car": 1.0, "counterweight": -1.0}
READ = slice(4, ELEMENTS, 4)  # nodes that are looked at
PLACES = nodes()[READ]  # of a side's length, from the axle to the end
CLEAR = 6.0  # bending lengths above the axle: below that the rope leans on the sheave
TAIL = 1.25  # slowest periods watched after the trip
DT = 0.03  # s, step of the search; the slowest swings take seconds


@dataclass(frozen=True)
class Swing:
    """Maximum during the trip and half the peak-to-peak value after it [m], of the side with the larger value."""

    during: float
    after: float


@dataclass(frozen=True)
class Case:
    """Rope, shaft and hoist for the search; without a hoist the ends follow the trajectory exactly."""

    rope: Rope
    height: float
    pit: float
    hoist: Hoist | None = None

    @property
    def clear(self) -> float:
        """Height above the axle [m] from which on the rope is clear of the sheave."""
        return CLEAR * self.rope.bending_length

    def length(self, side: str, car: Floats) -> Floats:
        """Length of a side [m] for car heights `car` [m]."""
        return self.pit + (car if side == "car" else self.height - car)

    def ends(self, moved: Moves) -> dict[str, Floats]:
        """Length [m], speed and acceleration of the end, up positive, and contact force on the groove [N] (4, n), by side."""
        bounces = self.hoist.ends(moved) if self.hoist else (0.0, 0.0)
        ends = [
            np.array([self.length(side, moved.position), sign * moved.speed, sign * moved.acceleration]) + added
            for (side, sign), added in zip(SIDES.items(), bounces, strict=True)
        ]
        turning, lifting = (0.5 * (ends[0][2] - sign * ends[1][2]) for sign in (1.0, -1.0))
        level = self.rope.weight + self.rope.lifting * lifting
        return {
            side: np.vstack([end, level + sign * self.rope.turning * turning])
            for (side, sign), end in zip(SIDES.items(), ends, strict=True)
        }


def tail(model: RopeModel, destination: float) -> float:
    """Time [s] after a trip over which the swing is evaluated."""
    return TAIL * max(side_string(model, destination, side).period() for side in SIDES)


def displacements(case: Case, moved: Moves) -> dict[str, tuple[Floats, Floats]]:
    """Lengths (n,) [m] and outward displacements relative to rest (n, places) [m] of the reduced model, by side."""
    found = {}
    for side, (length, speed, acceleration, press) in case.ends(moved).items():
        outward = sway(case.rope, moved.dt, length, speed, acceleration, press)[:, READ]
        found[side] = length, outward - at_rest(case.rope, length, PLACES)
    return found


def small_swing(case: Case, course: ReferenceTrajectory, watched: float, dt: float = DT) -> Swing:
    """Swing of the reduced model during a trajectory and `watched` [s] after it."""
    moved = moves(course, course.end_time + watched, dt)
    sides = displacements(case, moved).values()
    return larger([swing_of(case, moved.time, course.end_time, length, departure) for length, departure in sides])


def swing_of(case: Case, time: Floats, end: float, length: Floats, departure: Floats, places: Floats = PLACES) -> Swing:
    """Swing of a side from its displacements (n, places) and lengths (n,); NaN (rope not there) is ignored."""
    seen = np.where(length[:, None] * places >= case.clear, departure, np.nan)
    return spread(seen, time > end)


def spread(seen: Floats, after: NDArray[np.bool_]) -> Swing:
    """Maximum during the trip and half the peak-to-peak value after it, of displacements (n, places) that may be NaN."""
    during = np.where(np.isfinite(seen), np.abs(seen), 0.0).max()
    rest = seen[after]
    rest = rest[:, np.isfinite(rest).all(axis=0)]
    return Swing(float(during), float(0.5 * np.ptp(rest, axis=0).max(initial=0.0)) if rest.size else 0.0)


def larger(found: list[Swing]) -> Swing:
    """The larger of both values, during and after the trip separately."""
    return Swing(max(one.during for one in found), max(one.after for one in found))


def full_swing(model: RopeModel, case: Case, course: ReferenceTrajectory, watched: float) -> tuple[Swing, dict[str, Floats]]:
    """Swing of the full model, the ends following the trajectory exactly; and time [s] and displacements by side."""

    def look(rope: CompensationRope) -> Floats:
        axle, n, q = -model.shaft.pit, rope.n, rope.state.q
        ends = {"car": -q[0], "counterweight": -q[n - 1]}
        return np.array([side_shape(rope, side, axle + PLACES * (ends[side] - axle)) for side in SIDES])

    time, seen = record(model, course, course.end_time + watched, look)
    car = np.array([course.at(one).position for one in time])
    traces, found = {"time": time}, []
    for k, side in enumerate(SIDES):
        length = case.length(side, car)
        traces[side] = seen[:, k] - at_rest(case.rope, length, PLACES)
        found.append(swing_of(case, time, course.end_time, length, traces[side]))
    return larger(found), traces
