"""Candidate fits: each effect fitted on the full nonlinear model where that is worth its time, else as screening predicts it."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from comprope.errors import SimulationError

from ..estimation.gauss_newton import FitResult, gauss_newton
from ..estimation.initial_guess import best_initial_guess
from ..estimation.mass_search import search_rope_mass
from ..estimation.model_score import NoiseLevel, complexity_penalty, log_score
from ..estimation.weighted_least_squares import LeastSquaresProblem
from ..prediction.effect_hypotheses import Hypothesis, combine
from ..prediction.model_effects import shape_hypotheses
from ..prediction.parameter_point import ParameterPoint
from ..prediction.plant_parameters import PLANT_PARAMETERS
from ..progress import ProgressCallback
from ..settings import CANDIDATES
from .linear_screening import ScreenedHypothesis


class CandidateFit(NamedTuple):
    """An effect as screened and as fitted, and whether the fit is one on the full model.

    A fit is made on the coarse mesh and then corrected by one replay on the full mesh: it is one to `problem`, which has the
    chi-square of the full mesh at its point. `rough` is the chi-square before, which those of other fits are compared with.
    """

    screening: ScreenedHypothesis
    fitted: FitResult
    refined: bool
    problem: LeastSquaresProblem
    rough: float

    @property
    def hypothesis(self) -> Hypothesis:
        """Hypothesis that is fitted."""
        assert self.fitted.hypothesis is not None
        return self.fitted.hypothesis

    @property
    def penalty(self) -> float:
        """What its score is charged for its parameters, its choice among others, and the plant's deviations."""
        return complexity_penalty(self.hypothesis, self.screening.alternatives) + self.fitted.prior_cost

    def log_score(self, noise: NoiseLevel) -> float:
        """Score of the fit."""
        return log_score(self.fitted.chi_square, noise, self.penalty)


@dataclass(frozen=True)
class FitContext:
    """What the candidate fits of a diagnosis share: the problem, the point without new effects, and the fit of the plant.

    `problem` is the one on which the fits are made. Where it is the coarsened one of `full_problem`, the best of them are
    continued on the full mesh.
    """

    full_problem: LeastSquaresProblem
    problem: LeastSquaresProblem
    origin: ParameterPoint
    baseline: FitResult
    report_progress: ProgressCallback


def noise_level(context: FitContext, found: Iterable[CandidateFit]) -> NoiseLevel:
    """The noise as the plant's fit and the fits of effects on the full model tell it."""
    fits = [context.baseline, *(one.fitted for one in found if one.refined)]
    return NoiseLevel.of_fits(len(context.problem.data), (one.chi_square for one in fits))


def least_chi_square(found: Iterable[CandidateFit], default: float) -> float:
    """Chi-square of the best fit on the full model, `default` where there is none."""
    return min((one.fitted.chi_square for one in found if one.refined), default=default)


def free_shape_parameters(
    problem: LeastSquaresProblem, origin: ParameterPoint, fitted: FitResult, abandon_above: float = float("inf")
) -> FitResult:
    """The fit with the shape parameters of its effects fitted as well, a frequency or a yield curvature, if that is better.

    Nothing is done where noise explains the residual already.
    """
    assert fitted.hypothesis is not None
    shapes = shape_hypotheses(fitted.hypothesis.parts or (fitted.hypothesis,), problem.longest)
    if not shapes or not CANDIDATES.shape_threshold * len(problem.data) < fitted.chi_square < abandon_above:
        return fitted
    hypothesis = replace(combine(fitted.hypothesis, *shapes), effect=fitted.hypothesis.effect)
    start = np.concatenate([fitted.coefficients, np.zeros(len(shapes))])
    freed = gauss_newton(problem, hypothesis, start, origin, abandon_above)
    return freed if freed.chi_square < CANDIDATES.shape_improvement * fitted.chi_square else fitted


def fit_on_full_model(context: FitContext, one: ScreenedHypothesis, found: Sequence[CandidateFit]) -> CandidateFit:
    """Fit of a screened effect, abandoned once it cannot come near the best of `found`.

    An effect that cannot be simulated explains nothing.
    """
    context.report_progress(f"{one.hypothesis.effect}: fit on the full model")
    problem, origin, baseline = context.problem, context.origin, context.baseline
    abandon_above = CANDIDATES.abandon_factor * min((one.rough for one in found if one.refined), default=float("inf"))
    try:
        start = one.start
        if not one.sized:
            start = best_initial_guess(problem, one.hypothesis, start, origin, baseline, expected=one.chi_square)
        fitted = gauss_newton(problem, one.hypothesis, start, origin, abandon_above)
        found_here = corrected_by_full_mesh(context, one, fitted, abandon_above)
    except SimulationError:
        absent = np.concatenate([baseline.coefficients[: len(PLANT_PARAMETERS)], np.zeros(len(one.hypothesis.directions))])
        fitted = replace(baseline, hypothesis=one.hypothesis, coefficients=absent)
        found_here = CandidateFit(one, fitted, True, problem, fitted.chi_square)
    left = found_here.fitted.chi_square / max(len(problem.data), 1)
    context.report_progress(f"{one.hypothesis.effect}: fitted, reduced chi-square {left:.3g}")
    return found_here


def corrected_by_full_mesh(
    context: FitContext, one: ScreenedHypothesis, fitted: FitResult, abandon_above: float = float("inf")
) -> CandidateFit:
    """A fit on the coarse mesh with what the full mesh leaves at its point, and with its shape parameters fitted there.

    An abandoned fit stays as it is. Raises `SimulationError` where the full mesh cannot be simulated.
    """
    problem, rough, full = context.problem, fitted.chi_square, context.full_problem
    if problem.coarse != full.coarse and rough < abandon_above:
        problem = full.corrected(problem.coarse, fitted.predictions, full.predictions(fitted.point)[0])
        residual = problem.residual(fitted.predictions)
        fitted = replace(fitted, chi_square=float(residual @ residual))
        abandon_above = float("inf")
    return CandidateFit(one, free_shape_parameters(problem, context.origin, fitted, abandon_above), True, problem, rough)


def with_mass_search(context: FitContext, one: CandidateFit) -> CandidateFit:
    """The candidate fit from a better mass of the rope, if there is one, with shape parameters fitted again."""
    moved = search_rope_mass(one.problem, one.fitted, context.origin)
    if moved is one.fitted:
        return one
    return one._replace(fitted=free_shape_parameters(one.problem, context.origin, moved))
