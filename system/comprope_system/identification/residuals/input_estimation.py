"""Input estimation: which force, acting where and how over time, would explain the residual of the fitted plant.

Each location is a hypothesis of its own; the estimate and its cross-validation are in `regularised_deconvolution`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from comprope.errors import SimulationError

from ..comparison.error_metrics import rms
from ..data.campaign import Campaign
from ..data.runs import Channel, Run
from ..data.trip_phases import phases
from ..estimation.gauss_newton import FitResult
from ..estimation.weighted_least_squares import LeastSquaresProblem
from ..prediction.parameter_point import ParameterPoint, submit_replays
from ..prediction.replay import Floats, coarsening_factor
from ..progress import ProgressCallback, no_progress
from ..settings import CORRELATION, FORCE_REPORT
from .force_locations import ForceLocation, force_locations, responses, splines_of
from .regularised_deconvolution import Deconvolution, cross_validation_folds, deconvolve
from .residual_correlation import ResidualCorrelation, correlations_of
from .residual_series import ResidualSeries, motion_coordinates


@dataclass(frozen=True)
class TimeHistory:
    """Force over one run: value (n,) in the unit of its location at time (n,) [s]."""

    time: Floats
    value: Floats


@dataclass(frozen=True)
class ForceEstimate:
    """Estimated force at one location, by run.

    `share` is the part of the excess of chi-square over noise that it explains, by cross-validation.
    """

    location: ForceLocation
    share: float
    histories: dict[str, TimeHistory]

    @property
    def size(self) -> float:
        """Root mean square of the force over all runs, in the unit of the location."""
        return rms(np.concatenate([one.value for one in self.histories.values()]))

    def sized(self) -> str:
        """Root mean square with its unit, as text."""
        return f"{self.size:.2g} {self.location.unit.replace('.', ' ')}"

    def to_json(self, correlations: Sequence[ResidualCorrelation]) -> dict[str, Any]:
        """Location, share, size, correlations and time histories."""
        return {
            "place": self.location.name, "share": self.share, "size": self.size, "unit": self.location.unit,
            "locked_to": [{"coordinate": one.coordinate, "share": one.share, "peak": one.peak} for one in correlations],
            "courses": {file: {"time": one.time, "value": one.value} for file, one in self.histories.items()},
        }  # fmt: skip


@dataclass(frozen=True)
class InputEstimation:
    """Estimates at all locations, largest share first, and the correlations of the first with coordinates."""

    estimates: tuple[ForceEstimate, ...]
    correlations: tuple[ResidualCorrelation, ...]

    def sentence(self) -> str:
        """The best estimate, its clearest correlation and locations that are hardly distinguished from it, in one sentence."""
        best = self.estimates[0]
        explains = f"explains {100.0 * best.share:.0f} % of the residual beyond noise"
        if best.share < CORRELATION.min_share:
            return f"No force at a single location explains the residual; the best, {best.location.name}, {explains}"
        first = f"{best.location.name} of {best.sized()} rms {explains}"
        similar = [
            f"{one.location.name} ({100.0 * one.share:.0f} %)"
            for one in self.estimates[1:]
            if one.share > best.share - FORCE_REPORT.similar_share
        ]
        others = f"; these data hardly distinguish it from {', '.join(similar)}" if similar else ""
        return f"{first[0].upper()}{first[1:]}; {self._correlation()}{others}"

    def _correlation(self) -> str:
        """The clearest correlation: a profile that is the same in all runs, else a sinusoid with a phase in each run."""
        profiles = [one for one in self.correlations if one.peak is None and one.share > CORRELATION.min_share]
        clear = profiles or [one for one in self.correlations if one.share > FORCE_REPORT.min_sinusoid_share]
        if not clear:
            return "it correlates with nothing from run to run"
        where = f" at {clear[0].peak:.3g} {clear[0].unit}" if clear[0].peak is not None else ""
        return f"it correlates with {clear[0].coordinate}{where}"

    def to_json(self) -> list[dict[str, Any]]:
        """All estimates, largest share first; correlations are those of the first."""
        return [one.to_json(self.correlations if one is self.estimates[0] else ()) for one in self.estimates]


def estimate_residual_force(
    problem: LeastSquaresProblem, fitted: FitResult, report_progress: ProgressCallback = no_progress
) -> InputEstimation | None:
    """Force at each location that explains the residual of `fitted`, the fitted plant; None where it cannot be simulated."""
    locations = force_locations(problem.campaign.model)
    report_progress("input estimation: force that would explain the residual")
    try:
        matrices = responses(problem, fitted.point, locations)
        velocities = _sheave_velocities(problem, fitted.point)
    except SimulationError:
        return None
    r = problem.residual(fitted.predictions)
    priors = np.array([one.prior for one in problem.plant])
    plant, coefficients = fitted.jacobian * priors, fitted.coefficients / priors
    times = {run.file: run.time for run in problem.runs}
    fold = cross_validation_folds(problem.whitened_channels, [one.means(times[one.run]) for one in problem.whitened_channels])
    found = []
    for location, own in zip(locations, matrices, strict=True):
        solution = deconvolve(own, plant, r + plant @ coefficients, problem.rows_of_runs, fold)
        found.append(_force_estimate(problem, location, solution, float(r @ r)))
    best_first = sorted(found, key=lambda one: -one.share)
    histories = best_first[0].histories
    series = [_force_series(problem.campaign, run, histories[run.file], velocities[run.file]) for run in problem.runs]
    return InputEstimation(tuple(best_first), tuple(correlations_of(_scaled(series))))


def _force_estimate(
    problem: LeastSquaresProblem, location: ForceLocation, solution: Deconvolution, chi_square: float
) -> ForceEstimate:
    """Estimate from a deconvolution; `chi_square` is that without a force."""
    excess = max(chi_square - len(problem.data), 1e-300)
    histories = {}
    for run, coefficients in zip(problem.runs, solution.coefficients, strict=True):
        time = np.arange(run.time[0], run.time[-1], FORCE_REPORT.sampling_interval)
        histories[run.file] = TimeHistory(time, splines_of(run).at(time) @ coefficients)
    return ForceEstimate(location, min(max((chi_square - solution.held_out_chi_square) / excess, 0.0), 1.0), histories)


def _sheave_velocities(problem: LeastSquaresProblem, point: ParameterPoint) -> dict[str, Floats]:
    """Vertical velocity (n,) [m/s] of the sheave in each run of the fitted model, up positive, by file."""
    axle = {"axle": Channel.model_validate({"column": "axle", "quantity": "sheave_displacement", "unit": "m"})}
    with_axle = replace(problem.campaign, channels=axle)
    coarse = coarsening_factor(with_axle.model)
    jobs = submit_replays(with_axle, problem.runs, problem.with_held_fixed(point), problem.executor, coarse)
    return {run.file: np.gradient(job.result()["axle"], run.time) for run, job in zip(problem.runs, jobs, strict=True)}


def _force_series(campaign: Campaign, run: Run, history: TimeHistory, sheave_velocity: Floats) -> ResidualSeries:
    """Force beside the coordinates that it may correlate with; channels relative to rest leave its mean unknown."""
    t = history.time
    at = motion_coordinates(campaign, run, t) | {"sheave_velocity": np.interp(t, run.time, sheave_velocity)}
    x, at_rest = history.value - history.value.mean(), phases(run.trip, t)["rest"]
    return ResidualSeries(run.file, "force", x, at, at_rest, np.abs(run.trip.velocity(t)) > 0.0, floating=True)


def _scaled(series: Sequence[ResidualSeries]) -> list[ResidualSeries]:
    """The series over their rms in all runs."""
    size = max(rms(np.concatenate([one.x for one in series])), 1e-300)
    return [replace(one, x=one.x / size) for one in series]
