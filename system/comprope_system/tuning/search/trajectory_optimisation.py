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

from comprope.drive.parameters import INTERVALS, Curve, Drive
from comprope.drive.trajectory.free_curve import FreeCurve
from comprope.drive.trajectory.reference_trajectory import ReferenceTrajectory

from ...vibration.reduced_model.sampled_motion import sample_motion
from ...vibration.reduced_model.swing import (
    READ_POSITIONS,
    SEARCH_STEP,
    ReducedModel,
    Swing,
    departures_from_rest,
    largest_swing,
    swing_of_departures,
)
from .profile_families import REST_BEFORE, Route, trajectory_of

Floats = NDArray[np.float64]

PROGRAMS = 20
RELEVANT_SHARE = 0.5  # of the largest departure: smaller ones are left out of a program
INITIAL_CHANGE, FINAL_CHANGE = 0.3, 0.005  # of the largest acceleration: how far a program may change a knot
DIFFERENCE_STEP = 0.02  # of the largest acceleration, by which the response is differenced
SAMPLING = 6  # moments and places that a program looks at besides peaks in time
MIN_IMPROVEMENT = 2e-3  # of the cost: with less the search ends
LIMIT_MARGIN = 1e-4  # of each limit, so that rounding keeps it
EXCESS_WEIGHT = 10.0


@dataclass(frozen=True)
class Objective:
    """Objective: weights [1/m] of the largest displacements during and after the trip, and a cap for both [m]."""

    during: float
    after: float
    caps: Swing = Swing(np.inf, np.inf)  # noqa: RUF009 -- frozen

    def cost(self, swing: Swing) -> float:
        """Weighted sum of the swings; the part above a cap has EXCESS_WEIGHT times the weight."""
        over = max(swing.during - self.caps.during, 0.0), max(swing.after - self.caps.after, 0.0)
        return self.during * (swing.during + EXCESS_WEIGHT * over[0]) + self.after * (swing.after + EXCESS_WEIGHT * over[1])


@dataclass(frozen=True)
class Limits:
    """Inequality constraints (m, k) of the knots' accelerations with limits (m,); and the row of the distance (k,)."""

    rows: Floats
    maximum: Floats
    final_speed: Floats
    distance: Floats


def optimised_drive(
    drive: Drive,
    route: Route,
    time: float,
    models: Sequence[ReducedModel],
    observation: float,
    objective: Objective,
    first: ReferenceTrajectory,
    smoothing: float = 0.0,
) -> Drive | None:
    """The drive with the free-form curve of least swing for a trip of `time` [s], starting from the accelerations of `first`.

    The time includes `smoothing` [s] of a moving average.

    With several cases (ropes) the worst one counts. None if no curve of INTERVALS intervals is so fast.
    """
    limits = _limits(drive, route, time - smoothing)
    knots = np.array([first.at(first.start_time + first.duration * k / INTERVALS).acceleration for k in range(INTERVALS + 1)])
    a = _feasible(np.sign(route.destination - route.origin) * knots, limits, route, drive.profile.acceleration)
    if a is None:
        return None
    response = _Response(route, time, smoothing, models, observation)
    swing, best = response.swing(a), a
    bound = INITIAL_CHANGE
    for _ in range(PROGRAMS):
        change = _linear_program(
            response, best, limits, objective, bound * drive.profile.acceleration, drive.profile.acceleration
        )
        if change is not None and objective.cost(now := response.swing(best + change)) < objective.cost(swing):
            better = 1.0 - objective.cost(now) / objective.cost(swing)
            swing, best, bound = now, best + change, min(2.0 * bound, INITIAL_CHANGE)
            if better < MIN_IMPROVEMENT:
                break
        else:
            bound /= 3.0
        if bound < FINAL_CHANGE:
            break
    return _as_drive(drive, route, time, smoothing, best)


class _Response:
    """Displacements of the rope for accelerations at the knots."""

    def __init__(self, route: Route, time: float, smoothing: float, models: Sequence[ReducedModel], observation: float) -> None:
        self.route, self.time, self.smoothing, self.models, self.observation = route, time, smoothing, models, observation

    def departures(self, a: Floats) -> tuple[Floats, Floats]:
        """Times (n,) and displacements (cases and sides, n, places) [m], zero near the sheave."""
        trip = FreeCurve(
            REST_BEFORE, self.route.origin, self.route.destination, self.time - self.smoothing, tuple(a / np.abs(a).max())
        )
        trajectory = ReferenceTrajectory(trip, self.smoothing)
        motion, found = sample_motion(trajectory, trajectory.end_time + self.observation, SEARCH_STEP), []
        for reduced in self.models:
            for length, departure in departures_from_rest(reduced, motion).values():
                found.append(np.where(length[:, None] * READ_POSITIONS >= reduced.clearance, departure, 0.0))
        return motion.time, np.array(found)

    def swing(self, a: Floats) -> Swing:
        """The worst swing of all cases."""
        time, found = self.departures(a)
        return largest_swing([swing_of_departures(one, time > REST_BEFORE + self.time) for one in found])

    def linearised(self, a: Floats, nudge: float) -> tuple[Floats, Floats, NDArray[np.bool_]]:
        """Displacements (m,), their derivatives with respect to the inner knots (m, k), and which are after the trip (m,).

        Selected values only: peaks in time at every place, and a coarse grid of times and places.
        """
        time, base = self.departures(a)
        late = np.broadcast_to((time > REST_BEFORE + self.time)[None, :, None], base.shape)
        some = _relevant(base) | (late & _relevant(np.where(late, base, 0.0)))
        columns = []
        for k in range(1, INTERVALS):
            motion = a.copy()
            motion[k] += nudge
            columns.append((self.departures(motion)[1][some] - base[some]) / nudge)
        return base[some], np.array(columns).T, late[some]


def _relevant(departures: Floats) -> NDArray[np.bool_]:
    """Selected displacements (sides, n, places): large ones that are peaks in time or on the evaluation grid."""
    size = np.abs(departures)
    peak = np.zeros(size.shape, bool)
    peak[:, 1:-1] = (size[:, 1:-1] >= size[:, :-2]) & (size[:, 1:-1] >= size[:, 2:])
    peak[:, ::SAMPLING, ::SAMPLING] = True
    return peak & (size >= RELEVANT_SHARE * size.max())


def _limits(drive: Drive, route: Route, time: float) -> Limits:
    """Speed and jerk at most, speed at least 0; no speed left at the end; the distance."""
    n, dt, eye = INTERVALS + 1, time / INTERVALS, np.eye(INTERVALS + 1)
    speeds = np.vstack([np.zeros(n), np.cumsum(0.5 * dt * (eye[1:] + eye[:-1]), axis=0)])
    jerks = np.diff(eye, axis=0) / dt
    row = (dt * speeds[:-1] + dt**2 * (2.0 * eye[:-1] + eye[1:]) / 6.0).sum(axis=0)
    maximum = np.concatenate([
        np.full(n, drive.profile.speed * (1.0 - LIMIT_MARGIN)), np.zeros(n),
        np.full(2 * INTERVALS, drive.profile.jerk * (1.0 - LIMIT_MARGIN)),
    ])  # fmt: skip
    return Limits(np.vstack([speeds, -speeds, jerks, -jerks]), maximum, speeds[-1], row)


def _feasible(a: Floats, limits: Limits, route: Route, maximum: float) -> Floats | None:
    """The accelerations closest to `a` that meet the limits, stop the car and cover the distance; zero at both ends."""
    k = INTERVALS - 1
    eye, reach = np.eye(k), (1.0 - LIMIT_MARGIN) * maximum
    rows = np.vstack(
        [np.hstack([eye, -eye]), np.hstack([-eye, -eye]), np.hstack([limits.rows[:, 1:-1], 0.0 * limits.rows[:, 1:-1]])]
    )
    right = np.concatenate([a[1:-1], -a[1:-1], limits.maximum])
    equal = np.hstack([np.array([limits.final_speed, limits.distance])[:, 1:-1], np.zeros((2, k))])
    cost = np.concatenate([np.zeros(k), np.ones(k)])
    found = linprog(cost, rows, right, equal, [0.0, route.distance], [(-reach, reach)] * k + [(0.0, None)] * k, method="highs")
    return np.concatenate([[0.0], found.x[:k], [0.0]]) if found.status == 0 else None


def _linear_program(
    response: _Response, a: Floats, limits: Limits, objective: Objective, bound: float, maximum: float
) -> Floats | None:
    """Change (INTERVALS + 1,) of the accelerations from the linear program; None if it is infeasible."""
    own, slope, after = response.linearised(a, DIFFERENCE_STEP * maximum)
    rows, right = [], []
    for kind, some in enumerate((np.ones_like(after), after)):
        sign = np.sign(own[some])
        rows.append(np.hstack([sign[:, None] * slope[some], _columns(len(sign), kind)]))
        right.append(-np.abs(own[some]))
    rows += [np.hstack([limits.rows[:, 1:-1], np.zeros((len(limits.maximum), 4))])]
    right += [np.maximum(limits.maximum - limits.rows @ a, 0.0)]
    equal = np.hstack([np.array([limits.final_speed, limits.distance])[:, 1:-1], np.zeros((2, 4))])
    reach, caps = (1.0 - LIMIT_MARGIN) * maximum, (objective.caps.during, objective.caps.after)
    bounds = [(min(max(-bound, -reach - k), 0.0), max(min(bound, reach - k), 0.0)) for k in a[1:-1]]
    bounds += [(0.0, one if np.isfinite(one) else None) for one in caps] + [(0.0, None)] * 2
    cost = np.concatenate(
        [np.zeros(INTERVALS - 1), np.outer([1.0, 1.0 + EXCESS_WEIGHT], [objective.during, objective.after]).ravel()]
    )
    found = linprog(cost, np.vstack(rows), np.concatenate(right), equal, [0.0, 0.0], bounds, method="highs")
    return np.concatenate([[0.0], found.x[: INTERVALS - 1], [0.0]]) if found.status == 0 else None


def _columns(count: int, kind: int) -> Floats:
    """Columns (count, 4) of the slack variables for the largest displacement of a kind, up to its cap and above it."""
    columns = np.zeros((count, 4))
    columns[:, [kind, kind + 2]] = -1.0
    return columns


def _as_drive(drive: Drive, route: Route, time: float, smoothing: float, a: Floats) -> Drive:
    """The drive with this curve; its acceleration limit is the maximum of the curve, so that the trip takes the given time."""
    shares = a / np.abs(a).max()
    speeds = np.maximum(np.cumsum(shares[1:-1] - shares[1:-1].mean()), 0.0)  # the program keeps 0 but for its tolerance
    speeds[-1] = 0.0
    shares[1:-1] = np.diff(speeds, prepend=0.0)
    shares /= np.abs(shares).max()
    shares[np.abs(shares) < 1e-12] = 0.0
    curve = Curve(**{f"a{k}": float(shares[k]) for k in range(1, INTERVALS)})
    made = drive.model_copy(update={"curve": curve})
    trip = trajectory_of(made, route).unshaped
    needed = (
        np.abs(np.array(trip.knots[0])).max() * (trip.duration / (time - smoothing)) ** 2 if isinstance(trip, FreeCurve) else 0.0
    )
    own = drive.profile
    profile = own.model_copy(update={"acceleration": min(float(needed), own.acceleration), "smoothing": smoothing})
    return made.model_copy(update={"profile": profile, "shaper": drive.shaper.model_copy(update={"impulses": 1.0})})
