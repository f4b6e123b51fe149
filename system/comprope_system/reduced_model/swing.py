"""How far the rope swings on a trip: on the small linear rope, and on the full model.

Swing is the departure of either side from the shape it would have at rest with the car where it is, anywhere from a few
bending lengths above the axle to the rope's end: the farthest during the trip, and half the range after it.
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
    """The farthest from rest during the trip and half the range after it [m], on whichever side it is larger."""

    during: float
    after: float


@dataclass(frozen=True)
class Case:
    """A rope in its shaft as the search sees it, its ends carried by a hoist; without one they follow the course exactly."""

    rope: Rope
    height: float
    pit: float
    hoist: Hoist | None = None

    @property
    def clear(self) -> float:
        """How far above the axle [m] the rope no longer leans on the sheave."""
        return CLEAR * self.rope.bending_length

    def length(self, side: str, car: Floats) -> Floats:
        """A side's length [m] with the car at heights `car` [m]."""
        return self.pit + (car if side == "car" else self.height - car)

    def ends(self, moved: Moves) -> dict[str, Floats]:
        """Length [m], speed and acceleration of the end, up positive, and the press on the groove [N] (4, n), by side."""
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
    """How long [s] to watch the rope after a trip."""
    return TAIL * max(side_string(model, destination, side).period() for side in SIDES)


def displacements(case: Case, moved: Moves) -> dict[str, tuple[Floats, Floats]]:
    """Lengths (n,) [m] and outward departures from rest (n, places) [m] on the small rope, by side."""
    found = {}
    for side, (length, speed, acceleration, press) in case.ends(moved).items():
        outward = sway(case.rope, moved.dt, length, speed, acceleration, press)[:, READ]
        found[side] = length, outward - at_rest(case.rope, length, PLACES)
    return found


def small_swing(case: Case, course: ReferenceTrajectory, watched: float, dt: float = DT) -> Swing:
    """The swing on a course and `watched` [s] after it, on the small rope."""
    moved = moves(course, course.end_time + watched, dt)
    sides = displacements(case, moved).values()
    return larger([swing_of(case, moved.time, course.end_time, length, departure) for length, departure in sides])


def swing_of(case: Case, time: Floats, end: float, length: Floats, departure: Floats, places: Floats = PLACES) -> Swing:
    """The swing of a side from its departures (n, places) and lengths (n,); moments without the rope (NaN) do not count."""
    seen = np.where(length[:, None] * places >= case.clear, departure, np.nan)
    return spread(seen, time > end)


def spread(seen: Floats, after: NDArray[np.bool_]) -> Swing:
    """The farthest and, after the trip, half the range of departures (n, places) that may be NaN."""
    during = np.where(np.isfinite(seen), np.abs(seen), 0.0).max()
    rest = seen[after]
    rest = rest[:, np.isfinite(rest).all(axis=0)]
    return Swing(float(during), float(0.5 * np.ptp(rest, axis=0).max(initial=0.0)) if rest.size else 0.0)


def larger(found: list[Swing]) -> Swing:
    """The larger of each."""
    return Swing(max(one.during for one in found), max(one.after for one in found))


def full_swing(model: RopeModel, case: Case, course: ReferenceTrajectory, watched: float) -> tuple[Swing, dict[str, Floats]]:
    """The swing on the full model, ends carried along the course exactly; and time [s] and departures by side."""

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
