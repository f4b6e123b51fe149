"""Optimisation of a free-form trip by sequential linear programming with the reduced model.

The displacement of the rope is linearised in the accelerations at the knots. Each linear program computes the change of
these that minimises a weighted sum of the largest displacements during and after the trip, subject to the limits of speed,
acceleration and jerk, the distance and the travel time. Changes are bounded by a trust region, which is reduced when the
predicted improvement is not attained.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from comprope.drive.parameters import PARTS, Curve, Drive
from comprope.drive.trajectory.free_curve import FreeCurve
from comprope.drive.trajectory.reference_trajectory import ReferenceTrajectory

from ...reduced_model.sampled_motion import moves
from ...reduced_model.swing import DT, PLACES, Case, Swing, displacements, larger, spread
from .profile_families import START, Way, course_of

Floats = NDArray[np.float64]

PROGRAMS = 20
COUNTS = 0.5  # of the largest departure: smaller ones are left out of a program
FIRST_BOUND, LAST_BOUND = 0.3, 0.005  # of the largest acceleration: how far a program may change a knot
NUDGE = 0.02  # of the largest acceleration, by which the response is differenced
EVERY = 6  # moments and places that a program looks at besides peaks in time
LEAST_GAIN = 2e-3  # of the cost: with less the search ends
MARGIN = 1e-4  # of each limit, so that rounding keeps it
EXCESS = 10.0


@dataclass(frozen=True)
class Goal:
    """Objective: weights [1/m] of the largest displacements during and after the trip, and a cap for both [m]."""

    during: float
    after: float
    caps: Swing = Swing(np.inf, np.inf)  # noqa: RUF009 -- frozen

    def cost(self, swing: Swing) -> float:
        """Weighted sum of the swings; the part above a cap has EXCESS times the weight."""
        over = max(swing.during - self.caps.during, 0.0), max(swing.after - self.caps.after, 0.0)
        return self.during * (swing.during + EXCESS * over[0]) + self.after * (swing.after + EXCESS * over[1])


@dataclass(frozen=True)
class Limits:
    """Inequality constraints (m, k) of the knots' accelerations with limits (m,); and the row of the distance (k,)."""

    rows: Floats
    most: Floats
    stop: Floats
    way: Floats


def free_drive(
    drive: Drive,
    way: Way,
    time: float,
    cases: Sequence[Case],
    watched: float,
    goal: Goal,
    first: ReferenceTrajectory,
    smoothing: float = 0.0,
) -> Drive | None:
    """The drive with the free-form curve of least swing for a trip of `time` [s], starting from the accelerations of `first`.

    The time includes `smoothing` [s] of a moving average.

    With several cases (ropes) the worst one counts. None if no curve of PARTS intervals is so fast.
    """
    limits = _limits(drive, way, time - smoothing)
    knots = np.array([first.at(first.start_time + first.duration * k / PARTS).acceleration for k in range(PARTS + 1)])
    a = _feasible(np.sign(way.destination - way.origin) * knots, limits, way, drive.profile.acceleration)
    if a is None:
        return None
    seen = _Seen(way, time, smoothing, cases, watched)
    swing, best = seen.swing(a), a
    bound = FIRST_BOUND
    for _ in range(PROGRAMS):
        change = _program(seen, best, limits, goal, bound * drive.profile.acceleration, drive.profile.acceleration)
        if change is not None and goal.cost(now := seen.swing(best + change)) < goal.cost(swing):
            better = 1.0 - goal.cost(now) / goal.cost(swing)
            swing, best, bound = now, best + change, min(2.0 * bound, FIRST_BOUND)
            if better < LEAST_GAIN:
                break
        else:
            bound /= 3.0
        if bound < LAST_BOUND:
            break
    return _as_drive(drive, way, time, smoothing, best)


class _Seen:
    """Displacements of the rope for accelerations at the knots."""

    def __init__(self, way: Way, time: float, smoothing: float, cases: Sequence[Case], watched: float) -> None:
        self.way, self.time, self.smoothing, self.cases, self.watched = way, time, smoothing, cases, watched

    def departures(self, a: Floats) -> tuple[Floats, Floats]:
        """Times (n,) and displacements (cases and sides, n, places) [m], zero near the sheave."""
        trip = FreeCurve(START, self.way.origin, self.way.destination, self.time - self.smoothing, tuple(a / np.abs(a).max()))
        course = ReferenceTrajectory(trip, self.smoothing)
        moved, found = moves(course, course.end_time + self.watched, DT), []
        for case in self.cases:
            for length, departure in displacements(case, moved).values():
                found.append(np.where(length[:, None] * PLACES >= case.clear, departure, 0.0))
        return moved.time, np.array(found)

    def swing(self, a: Floats) -> Swing:
        """The worst swing of all cases."""
        time, found = self.departures(a)
        return larger([spread(one, time > START + self.time) for one in found])

    def response(self, a: Floats, nudge: float) -> tuple[Floats, Floats, NDArray[np.bool_]]:
        """Displacements (m,), their derivatives with respect to the inner knots (m, k), and which are after the trip (m,).

        Selected values only: peaks in time at every place, and a coarse grid of times and places.
        """
        time, base = self.departures(a)
        late = np.broadcast_to((time > START + self.time)[None, :, None], base.shape)
        some = _telling(base) | (late & _telling(np.where(late, base, 0.0)))
        columns = []
        for k in range(1, PARTS):
            moved = a.copy()
            moved[k] += nudge
            columns.append((self.departures(moved)[1][some] - base[some]) / nudge)
        return base[some], np.array(columns).T, late[some]


def _telling(departures: Floats) -> NDArray[np.bool_]:
    """Selected displacements (sides, n, places): large ones that are peaks in time or on the evaluation grid."""
    size = np.abs(departures)
    peak = np.zeros(size.shape, bool)
    peak[:, 1:-1] = (size[:, 1:-1] >= size[:, :-2]) & (size[:, 1:-1] >= size[:, 2:])
    peak[:, ::EVERY, ::EVERY] = True
    return peak & (size >= COUNTS * size.max())


def _limits(drive: Drive, way: Way, time: float) -> Limits:
    """Speed and jerk at most, speed at least 0; no speed left at the end; the distance."""
    n, dt, eye = PARTS + 1, time / PARTS, np.eye(PARTS + 1)
    speeds = np.vstack([np.zeros(n), np.cumsum(0.5 * dt * (eye[1:] + eye[:-1]), axis=0)])
    jerks = np.diff(eye, axis=0) / dt
    row = (dt * speeds[:-1] + dt**2 * (2.0 * eye[:-1] + eye[1:]) / 6.0).sum(axis=0)
    most = np.concatenate([
        np.full(n, drive.profile.speed * (1.0 - MARGIN)), np.zeros(n), np.full(2 * PARTS, drive.profile.jerk * (1.0 - MARGIN))
    ])  # fmt: skip
    return Limits(np.vstack([speeds, -speeds, jerks, -jerks]), most, speeds[-1], row)


def _feasible(a: Floats, limits: Limits, way: Way, most: float) -> Floats | None:
    """The accelerations closest to `a` that meet the limits, stop the car and cover the distance; zero at both ends."""
    k = PARTS - 1
    eye, reach = np.eye(k), (1.0 - MARGIN) * most
    rows = np.vstack(
        [np.hstack([eye, -eye]), np.hstack([-eye, -eye]), np.hstack([limits.rows[:, 1:-1], 0.0 * limits.rows[:, 1:-1]])]
    )
    right = np.concatenate([a[1:-1], -a[1:-1], limits.most])
    equal = np.hstack([np.array([limits.stop, limits.way])[:, 1:-1], np.zeros((2, k))])
    cost = np.concatenate([np.zeros(k), np.ones(k)])
    found = linprog(cost, rows, right, equal, [0.0, way.distance], [(-reach, reach)] * k + [(0.0, None)] * k, method="highs")
    return np.concatenate([[0.0], found.x[:k], [0.0]]) if found.status == 0 else None


def _program(seen: _Seen, a: Floats, limits: Limits, goal: Goal, bound: float, most: float) -> Floats | None:
    """Change (PARTS + 1,) of the accelerations from the linear program; None if it is infeasible."""
    own, slope, after = seen.response(a, NUDGE * most)
    rows, right = [], []
    for kind, some in enumerate((np.ones_like(after), after)):
        sign = np.sign(own[some])
        rows.append(np.hstack([sign[:, None] * slope[some], _columns(len(sign), kind)]))
        right.append(-np.abs(own[some]))
    rows += [np.hstack([limits.rows[:, 1:-1], np.zeros((len(limits.most), 4))])]
    right += [np.maximum(limits.most - limits.rows @ a, 0.0)]
    equal = np.hstack([np.array([limits.stop, limits.way])[:, 1:-1], np.zeros((2, 4))])
    reach, caps = (1.0 - MARGIN) * most, (goal.caps.during, goal.caps.after)
    bounds = [(min(max(-bound, -reach - k), 0.0), max(min(bound, reach - k), 0.0)) for k in a[1:-1]]
    bounds += [(0.0, one if np.isfinite(one) else None) for one in caps] + [(0.0, None)] * 2
    cost = np.concatenate([np.zeros(PARTS - 1), np.outer([1.0, 1.0 + EXCESS], [goal.during, goal.after]).ravel()])
    found = linprog(cost, np.vstack(rows), np.concatenate(right), equal, [0.0, 0.0], bounds, method="highs")
    return np.concatenate([[0.0], found.x[: PARTS - 1], [0.0]]) if found.status == 0 else None


def _columns(count: int, kind: int) -> Floats:
    """Columns (count, 4) of the slack variables for the largest displacement of a kind, up to its cap and above it."""
    columns = np.zeros((count, 4))
    columns[:, [kind, kind + 2]] = -1.0
    return columns


def _as_drive(drive: Drive, way: Way, time: float, smoothing: float, a: Floats) -> Drive:
    """The drive with this curve; its acceleration limit is the maximum of the curve, so that the trip takes the given time."""
    shares = a / np.abs(a).max()
    speeds = np.maximum(np.cumsum(shares[1:-1] - shares[1:-1].mean()), 0.0)  # the program keeps 0 but for its tolerance
    speeds[-1] = 0.0
    shares[1:-1] = np.diff(speeds, prepend=0.0)
    shares /= np.abs(shares).max()
    shares[np.abs(shares) < 1e-12] = 0.0
    curve = Curve(**{f"a{k}": float(shares[k]) for k in range(1, PARTS)})
    made = drive.model_copy(update={"curve": curve})
    trip = course_of(made, way).trip
    needed = (
        np.abs(np.array(trip.knots[0])).max() * (trip.duration / (time - smoothing)) ** 2 if isinstance(trip, FreeCurve) else 0.0
    )
    own = drive.profile
    profile = own.model_copy(update={"acceleration": min(float(needed), own.acceleration), "smoothing": smoothing})
    return made.model_copy(update={"profile": profile, "shaper": drive.shaper.model_copy(update={"impulses": 1.0})})
