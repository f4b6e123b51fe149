"""The residual force: which force, acting where and how over time, would explain what the refitted model leaves.

Each place is a hypothesis of its own; see `residual_force_solve` for the estimate and its judgement.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from comprope.errors import SimulationError

from ..comparison.error_metrics import rms
from ..data.campaign import Campaign, Channel, Run
from ..data.trip_phases import phases
from ..estimation.gauss_newton import FitResult
from ..estimation.weighted_least_squares import LeastSquaresProblem
from ..hypotheses.plant_parameters import PLANT_PARAMETERS
from ..prediction.parameter_point import ParameterPoint, submit_replays
from ..prediction.replay import Floats, coarsening_factor
from ..progress import ProgressCallback, no_progress
from ..settings import CORRELATION, FORCE_REPORT
from .force_locations import ForceLocation, force_locations, responses, splines_of
from .regularised_deconvolution import Deconvolution, cross_validation_folds, deconvolve
from .residual_correlation import ResidualCorrelation, ResidualSeries, correlations_of, motion_of


@dataclass(frozen=True)
class TimeHistory:
    """A force over one run: value (n,) in the place's unit at time (n,) [s]."""

    time: Floats
    value: Floats


@dataclass(frozen=True)
class ForceEstimate:
    """One place: the share of what is left beyond noise that its force explains where it was not fitted, and the force by run."""

    location: ForceLocation
    share: float
    histories: dict[str, TimeHistory]

    @property
    def size(self) -> float:
        """Root mean square of the force over all runs."""
        return rms(np.concatenate([one.value for one in self.histories.values()]))

    def sized(self) -> str:
        """The size with its unit."""
        return f"{self.size:.2g} {self.location.unit.replace('.', ' ')}"

    def to_json(self, correlations: Sequence[ResidualCorrelation]) -> dict[str, Any]:
        """Place, share, size, what it is locked to, and its courses."""
        return {
            "place": self.location.name, "share": self.share, "size": self.size, "unit": self.location.unit,
            "locked_to": [{"coordinate": one.coordinate, "share": one.share, "peak": one.peak} for one in correlations],
            "courses": {file: {"time": one.time, "value": one.value} for file, one in self.histories.items()},
        }  # fmt: skip


@dataclass(frozen=True)
class InputEstimation:
    """All places, the one that explains most first, and what its force is locked to."""

    estimates: tuple[ForceEstimate, ...]
    correlations: tuple[ResidualCorrelation, ...]

    def sentence(self) -> str:
        """One sentence."""
        best = self.estimates[0]
        explains = f"explains {100.0 * best.share:.0f} % of what is left"
        if best.share < CORRELATION.min_share:
            return f"No force at one place accounts for it; the best, {best.location.name}, {explains}"
        told = f"{best.location.name} of {best.sized()} rms {explains}"
        # A profile that holds from run to run says more than a sinusoid that may begin anywhere in each.
        clear = [one for one in self.correlations if one.peak is None and one.share > CORRELATION.min_share] or [
            one for one in self.correlations if one.share > FORCE_REPORT.min_sinusoid_share
        ]
        where = f" at {clear[0].peak:.3g} {clear[0].unit}" if clear and clear[0].peak is not None else ""
        follows = f"it follows {clear[0].coordinate}{where}" if clear else "it follows nothing from run to run"
        similar = [
            f"{one.location.name} ({100.0 * one.share:.0f} %)"
            for one in self.estimates[1:]
            if one.share > best.share - FORCE_REPORT.similar_share
        ]
        others = f"; these data hardly tell it from {', '.join(similar)}" if similar else ""
        return f"{told[0].upper()}{told[1:]}; {follows}{others}"

    def to_json(self) -> list[dict[str, Any]]:
        """The places, best first; only the best has been asked what it is locked to."""
        return [one.to_json(self.correlations if one is self.estimates[0] else ()) for one in self.estimates]


def estimate_residual_force(
    problem: LeastSquaresProblem, fitted: FitResult, report_progress: ProgressCallback = no_progress
) -> InputEstimation | None:
    """Estimate the force at each place from what `fitted`, the refitted model, leaves; None where that cannot be simulated."""
    looked = force_locations(problem.campaign.model)
    report_progress("the force that would explain the rest")
    try:
        matrices = responses(problem, fitted.point, looked)
        speeds = _sheave_velocities(problem, fitted.point)
    except SimulationError:
        return None
    r = problem.residual(fitted.predictions)
    priors = np.array([one.prior for one in PLANT_PARAMETERS])
    plant, moved = fitted.jacobian * priors, fitted.coefficients / priors
    times = {run.file: run.time for run in problem.runs}
    fold = cross_validation_folds(problem.whitened_channels, [one.means(times[one.run]) for one in problem.whitened_channels])
    found = [
        _suspect(problem, location, own, deconvolve(own, plant, r + plant @ moved, problem.rows_of_runs, fold), float(r @ r))
        for location, own in zip(looked, matrices, strict=True)
    ]
    best_first = sorted(found, key=lambda one: -one.share)
    pieces = [_piece(problem.campaign, run, best_first[0].histories[run.file], speeds[run.file]) for run in problem.runs]
    return InputEstimation(tuple(best_first), tuple(correlations_of(_scaled(pieces))))


def _suspect(
    problem: LeastSquaresProblem, location: ForceLocation, matrices: Sequence[Floats], found: Deconvolution, chi_square: float
) -> ForceEstimate:
    excess = max(chi_square - len(problem.data), 1e-300)
    histories = {}
    for run, coefficients in zip(problem.runs, found.histories, strict=True):
        time = np.arange(run.time[0], run.time[-1], FORCE_REPORT.sampling_interval)
        histories[run.file] = TimeHistory(time, splines_of(run).at(time) @ coefficients)
    return ForceEstimate(location, min(max((chi_square - found.missed) / excess, 0.0), 1.0), histories)


def _sheave_velocities(problem: LeastSquaresProblem, point: ParameterPoint) -> dict[str, Floats]:
    """The sheave's vertical velocity (n,) [m/s] in each run of the refitted model, up positive."""
    axle = {"axle": Channel.model_validate({"column": "axle", "quantity": "sheave_displacement", "unit": "m"})}
    watched = replace(problem.campaign, channels=axle)
    jobs = submit_replays(
        watched, problem.runs, problem.with_held_fixed(point), problem.executor, coarsening_factor(watched.model)
    )
    return {run.file: np.gradient(job.result()["axle"], run.time) for run, job in zip(problem.runs, jobs, strict=True)}


def _piece(campaign: Campaign, run: Run, course: TimeHistory, sheave_velocity: Floats) -> ResidualSeries:
    """A course beside the coordinates that it may be locked to; channels that count from rest hide its level."""
    t = course.time
    at = motion_of(campaign, run, t) | {"sheave_velocity": np.interp(t, run.time, sheave_velocity)}
    x, rest, moving = course.value - course.value.mean(), phases(run.trip, t)["rest"], np.abs(run.trip.velocity(t)) > 0.0
    return ResidualSeries(run.file, "force", x, at, rest, moving, floating=True)


def _scaled(pieces: Sequence[ResidualSeries]) -> list[ResidualSeries]:
    size = max(rms(np.concatenate([one.x for one in pieces])), 1e-300)
    return [replace(one, x=one.x / size) for one in pieces]
