"""The linear look at every hypothesis: what it would explain beside the plant, and where its refinement begins."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..estimation.gauss_newton import FitResult
from ..estimation.linearisation import effect_jacobian, finite_difference_jacobian, fit_directions, one_step_away, point_at
from ..estimation.mass_search import MASS, fits_at_masses
from ..estimation.model_score import complexity_penalty, penalised_chi_square, prior_cost
from ..estimation.per_run_phase import solve_per_run_phases
from ..estimation.weighted_least_squares import LeastSquaresProblem, solve_in_scale
from ..hypotheses.effect_hypotheses import Hypothesis, effect_hypotheses, instrument_hypotheses
from ..hypotheses.plant_parameters import PLANT_PARAMETERS
from ..prediction.parameter_point import ParameterPoint
from ..prediction.replay import coarsening_factor
from ..settings import SCREENING
from .frequency_candidates import residual_peak_frequencies, sway_frequencies

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ScreenedHypothesis:
    """A hypothesis after the linear look: start of its refinement, predicted misfit, its direction free of the plant's.

    `visible` is the share of its trace that the plant cannot imitate; `alternatives` are the ways in which its effect was tried.
    """

    hypothesis: Hypothesis
    start: Floats
    chi_square: float
    orthogonal_part: Floats
    distinct_share: float
    alternatives: int

    @property
    def penalised_chi_square(self) -> float:
        """The misfit, raised as the price and the plant's strain lower the score."""
        return penalised_chi_square(self.chi_square, complexity_penalty(self.hypothesis, self.alternatives) + self.prior_cost)

    @property
    def prior_cost(self) -> float:
        """What the plant costs where its refinement begins."""
        return prior_cost(self.start)

    @cached_property
    def span(self) -> Floats:
        """An orthonormal basis (N, directions) of the directions free of the plant's."""
        return np.asarray(np.linalg.qr(self.orthogonal_part)[0])


def indistinguishable(a: ScreenedHypothesis, b: ScreenedHypothesis) -> bool:
    """Whether two effects look the same in these data: the largest cosine between what their traces span, free of the plant's."""
    return bool(np.linalg.svd(a.span.T @ b.span, compute_uv=False)[0] > SCREENING.indistinguishable)


def screen_hypotheses(
    problem: LeastSquaresProblem,
    origin: ParameterPoint,
    baseline: FitResult,
    nominal: FitResult | None = None,
    tried: tuple[float, ...] | None = None,
) -> list[ScreenedHypothesis]:
    """Every effect's best alternative, most promising first; effects that `origin` has, or that are ruled out, are not.

    Looks are taken from the fit `none`, and from `nominal` as well where that fit misses much: it is bent for what it lacks.
    `tried` are frequencies [Hz] for effects that have one; by default promising ones.
    """
    left_out = {key.split(".")[1] for key in origin.effects} | problem.ruled_out
    known = effect_hypotheses(problem.campaign.model, promising_frequencies(problem, baseline) if tried is None else tried)
    columns = dict(_effect_columns(problem, origin, [one for one in known if one.effect not in left_out]))
    faults = instrument_hypotheses(problem.campaign.channels)
    columns |= {one: effect_jacobian(problem, one, origin, baseline.predictions) for one in faults if one.effect not in left_out}
    return best_per_effect(screen_about_fits(problem, columns, baseline, nominal))


def best_per_effect(looks: Sequence[ScreenedHypothesis]) -> list[ScreenedHypothesis]:
    """Every effect's most promising look, the most promising effect first."""
    best: dict[str, ScreenedHypothesis] = {}
    for look in sorted(looks, key=lambda one: one.penalised_chi_square):
        best.setdefault(look.hypothesis.effect, look)
    return list(best.values())


def promising_frequencies(problem: LeastSquaresProblem, fitted: FitResult) -> tuple[float, ...]:
    """Frequencies [Hz] to try for effects that have one: where swaying would explain most, and the residual's peaks."""
    peaks, swayed = (
        residual_peak_frequencies(problem, fitted.predictions),
        sway_frequencies(problem, fitted, coarsening_factor(problem.campaign.model)),
    )
    return tuple(dict.fromkeys([*swayed, *peaks]))


def screen_about_fits(
    problem: LeastSquaresProblem, columns: Mapping[Hypothesis, Floats], baseline: FitResult, nominal: FitResult | None
) -> list[ScreenedHypothesis]:
    """All looks at hypotheses with their derivatives (N, directions).

    What each would leave is told as a share of what `none` leaves.
    """
    looks: list[ScreenedHypothesis] = []
    for at in (
        [baseline] if nominal is None or baseline.chi_square < SCREENING.close_fit * len(problem.data) else [baseline, nominal]
    ):
        plain = solve_in_scale(problem.residual(at.predictions), at.jacobian, fit_directions(at.hypothesis), at.coefficients)
        share = baseline.chi_square / plain.chi_square
        looks += [look for one, by in columns.items() for look in _screened_about(problem, one, by, columns, at, share)]
    return looks


def _effect_columns(
    problem: LeastSquaresProblem, origin: ParameterPoint, tried: Sequence[Hypothesis]
) -> Iterator[tuple[Hypothesis, Floats]]:
    """Derivatives (N, directions) of every hypothesis that can be simulated, all replays side by side.

    What an effect changes is seen on a coarse mesh as well.
    """
    points = [origin, *(point for one in tried for point in one_step_away(origin, one))]
    moved = iter(problem.attempts(*points, coarse=coarsening_factor(problem.campaign.model)))
    if (before := next(moved)) is None:
        return
    for one in tried:
        found = [at for _ in one.directions if (at := next(moved)) is not None]
        if len(found) == len(one.directions):
            yield one, finite_difference_jacobian(problem, one, before, found)


def _screened_about(
    problem: LeastSquaresProblem, one: Hypothesis, by: Floats, among: Mapping[Hypothesis, Floats], at: FitResult, share: float
) -> Iterator[ScreenedHypothesis]:
    """The hypothesis with one phase for all runs and, where it has a phase, with one for each, seen from the fit `at`.

    Misfits are multiplied by `share`.
    """
    others, residual, begin = fit_directions(at.hypothesis), problem.residual(at.predictions), at.coefficients
    weights = np.vstack([at.jacobian, np.diag([1.0 / p.prior for p in others])])
    padded = np.vstack([by, np.zeros((len(others), by.shape[1]))])
    orthogonal_part = (padded - weights @ np.linalg.lstsq(weights, padded, rcond=None)[0])[: len(by)]
    distinct_share = float(np.linalg.norm(orthogonal_part)) / max(float(np.linalg.norm(by)), 1e-300)
    same = sum(other.effect == one.effect for other in among)
    start = np.concatenate([begin, np.zeros(by.shape[1])])
    solution = solve_in_scale(residual, np.hstack([at.jacobian, by]), [*others, *one.directions], start)
    yield ScreenedHypothesis(one, solution.coefficients, share * solution.chi_square, orthogonal_part, distinct_share, same)
    if one.polar and len(problem.runs) > 1:
        turned, found, chi_square = solve_per_run_phases(problem, at, by, one)
        yield ScreenedHypothesis(turned, found, share * chi_square, orthogonal_part, distinct_share, 2 * same)


# -- at other masses of the rope ----------------------------------------------------------------------
#
# A large effect swings the rope, and where the model's mass is not the rope's, its swings go out of step with those
# measured: from there its trace looks like nothing that was measured, and the misfit without it does not tell the
# mass either.


def screen_at_other_masses(
    problem: LeastSquaresProblem, origin: ParameterPoint, initial_fit: FitResult
) -> list[ScreenedHypothesis]:
    """Every effect's best look from another mass, most promising first; `begun` has the derivatives by the plant as stated."""
    looks: list[ScreenedHypothesis] = []
    for stand in _fits_at_masses(problem, initial_fit, origin):
        # Where a rope is shaken it answers at that frequency, whatever its mass.
        looks += screen_hypotheses(
            problem, _origin_at_mass(origin, stand), stand, tried=residual_peak_frequencies(problem, stand.predictions)
        )
    return best_per_effect(looks)


def _fits_at_masses(problem: LeastSquaresProblem, initial_fit: FitResult, origin: ParameterPoint) -> Iterator[FitResult]:
    """The model with other masses; its misfit is that with all else refitted, by the derivatives of `begun`."""
    for x, predictions, solution in fits_at_masses(problem, initial_fit, origin, SCREENING.masses):
        point = point_at(initial_fit.hypothesis, list(x), origin)
        yield replace(initial_fit, coefficients=x, point=point, predictions=predictions, chi_square=solution.chi_square)


def _origin_at_mass(origin: ParameterPoint, stand: FitResult) -> ParameterPoint:
    """Where effects' derivatives are taken for a stand: at its mass."""
    name = PLANT_PARAMETERS[MASS].name
    return replace(origin, plant=dict(origin.plant) | {name: float(stand.coefficients[MASS])})
