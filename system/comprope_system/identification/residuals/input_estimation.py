"""The residual force: which force, acting where and how over time, would explain what the refitted model leaves.

Each place is a hypothesis of its own; see `residual_force_solve` for the estimate and its judgement.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from comprope.errors import SimulationError

from ..comparison.error_metrics import rms
from ..data.campaign import Campaign, Channel, Run
from ..data.trip_phases import phases
from ..estimation.gauss_newton import Fitted
from ..estimation.weighted_least_squares import Problem
from ..hypotheses.plant_parameters import NUISANCES
from ..prediction.parameter_point import Point, submit
from ..prediction.replay import Floats, coarseness
from .force_locations import Place, places, responses, splines_of
from .regularised_deconvolution import Estimate, estimate, folds
from .residual_correlation import CLEAR, Clue, Piece, locked, motion_of

GRID = 0.1  # s between the values of a course that are told
SURE = 0.6  # share above which a sinusoid is worth telling of a course, which is smooth and thus never far from one
ALIKE = 0.1  # difference of shares below which one place is hardly told from another
Say = Callable[[str], None]


@dataclass(frozen=True)
class Course:
    """A force over one run: value (n,) in the place's unit at time (n,) [s]."""

    time: Floats
    value: Floats


@dataclass(frozen=True)
class Suspect:
    """One place: the share of what is left beyond noise that its force explains where it was not fitted, and the force by run."""

    place: Place
    share: float
    courses: dict[str, Course]

    @property
    def size(self) -> float:
        """Root mean square of the force over all runs."""
        return rms(np.concatenate([one.value for one in self.courses.values()]))

    def sized(self) -> str:
        """The size with its unit."""
        return f"{self.size:.2g} {self.place.unit.replace('.', ' ')}"

    def to_json(self, clues: Sequence[Clue]) -> dict[str, Any]:
        """Place, share, size, what it is locked to, and its courses."""
        return {
            "place": self.place.name, "share": self.share, "size": self.size, "unit": self.place.unit,
            "locked_to": [{"coordinate": one.coordinate, "share": one.share, "peak": one.peak} for one in clues],
            "courses": {file: {"time": one.time, "value": one.value} for file, one in self.courses.items()},
        }  # fmt: skip


@dataclass(frozen=True)
class ResidualForce:
    """All places, the one that explains most first, and what its force is locked to."""

    suspects: tuple[Suspect, ...]
    clues: tuple[Clue, ...]

    def told(self) -> str:
        """One sentence."""
        best = self.suspects[0]
        explains = f"explains {100.0 * best.share:.0f} % of what is left"
        if best.share < CLEAR:
            return f"No force at one place accounts for it; the best, {best.place.name}, {explains}"
        told = f"{best.place.name} of {best.sized()} rms {explains}"
        # A profile that holds from run to run says more than a sinusoid that may begin anywhere in each.
        clear = [one for one in self.clues if one.peak is None and one.share > CLEAR] or [
            one for one in self.clues if one.share > SURE
        ]
        where = f" at {clear[0].peak:.3g} {clear[0].unit}" if clear and clear[0].peak is not None else ""
        follows = f"it follows {clear[0].coordinate}{where}" if clear else "it follows nothing from run to run"
        alike = [f"{one.place.name} ({100.0 * one.share:.0f} %)" for one in self.suspects[1:] if one.share > best.share - ALIKE]
        rivals = f"; these data hardly tell it from {', '.join(alike)}" if alike else ""
        return f"{told[0].upper()}{told[1:]}; {follows}{rivals}"

    def to_json(self) -> list[dict[str, Any]]:
        """The places, best first; only the best has been asked what it is locked to."""
        return [one.to_json(self.clues if one is self.suspects[0] else ()) for one in self.suspects]


def residual_force(problem: Problem, fitted: Fitted, say: Say = lambda _: None) -> ResidualForce | None:
    """Estimate the force at each place from what `fitted`, the refitted model, leaves; None where that cannot be simulated."""
    looked = places(problem.campaign.model)
    say("the force that would explain the rest")
    try:
        matrices = responses(problem, fitted.point, looked)
        speeds = _sheave_velocities(problem, fitted.point)
    except SimulationError:
        return None
    r = problem.residual(fitted.predictions)
    priors = np.array([one.prior for one in NUISANCES])
    plant, moved = fitted.by * priors, fitted.coefficients / priors
    times = {run.file: run.time for run in problem.runs}
    fold = folds(problem.parts, [one.means(times[one.run]) for one in problem.parts])
    found = [
        _suspect(problem, place, own, estimate(own, plant, r + plant @ moved, problem.rows_of_runs, fold), float(r @ r))
        for place, own in zip(looked, matrices, strict=True)
    ]
    best_first = sorted(found, key=lambda one: -one.share)
    pieces = [_piece(problem.campaign, run, best_first[0].courses[run.file], speeds[run.file]) for run in problem.runs]
    return ResidualForce(tuple(best_first), tuple(locked(_scaled(pieces))))


def _suspect(problem: Problem, place: Place, matrices: Sequence[Floats], found: Estimate, misfit: float) -> Suspect:
    excess = max(misfit - len(problem.data), 1e-300)
    courses = {}
    for run, coefficients in zip(problem.runs, found.courses, strict=True):
        time = np.arange(run.time[0], run.time[-1], GRID)
        courses[run.file] = Course(time, splines_of(run).at(time) @ coefficients)
    return Suspect(place, min(max((misfit - found.missed) / excess, 0.0), 1.0), courses)


def _sheave_velocities(problem: Problem, point: Point) -> dict[str, Floats]:
    """The sheave's vertical velocity (n,) [m/s] in each run of the refitted model, up positive."""
    axle = {"axle": Channel.model_validate({"column": "axle", "quantity": "sheave_displacement", "unit": "m"})}
    watched = replace(problem.campaign, channels=axle)
    jobs = submit(watched, problem.runs, problem.held_back(point), problem.executor, coarseness(watched.model))
    return {run.file: np.gradient(job.result()["axle"], run.time) for run, job in zip(problem.runs, jobs, strict=True)}


def _piece(campaign: Campaign, run: Run, course: Course, sheave_velocity: Floats) -> Piece:
    """A course beside the coordinates that it may be locked to; channels that count from rest hide its level."""
    t = course.time
    at = motion_of(campaign, run, t) | {"sheave_velocity": np.interp(t, run.time, sheave_velocity)}
    x, rest, moving = course.value - course.value.mean(), phases(run.trip, t)["rest"], np.abs(run.trip.velocity(t)) > 0.0
    return Piece(run.file, "force", x, at, rest, moving, floating=True)


def _scaled(pieces: Sequence[Piece]) -> list[Piece]:
    size = max(rms(np.concatenate([one.x for one in pieces])), 1e-300)
    return [replace(one, x=one.x / size) for one in pieces]
