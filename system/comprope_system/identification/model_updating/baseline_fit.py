"""Fit of the plant parameters, and of the effects that a model has, from which every updating of the model starts."""

from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..data.campaign import Campaign
from ..estimation.coarse_to_fine import fit_coarse_to_fine, fit_from_file, problem_of_fits
from ..estimation.gauss_newton import FitResult, gauss_newton
from ..estimation.parameter_estimates import keys_set_by_runs
from ..estimation.weighted_least_squares import LeastSquaresProblem, build_problem
from ..prediction.effect_hypotheses import Hypothesis
from ..prediction.model_effects import effects_in_model
from ..prediction.parameter_point import ParameterPoint, collect_predictions, submit_replays
from ..prediction.plant_parameters import PLANT_PARAMETERS
from ..progress import ProgressCallback, no_progress

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class BaselineFit:
    """What every fit to a campaign starts from: its whitened data and the model with its plant parameters refitted.

    `initial_fit` has the derivatives by plant parameters and effects that are in the model already; `fitted` has both refitted.
    `coarse` is the factor of elements and time steps on which fits of effects begin, 1 where a coarse mesh errs too much.
    """

    campaign: Campaign
    problem: LeastSquaresProblem
    initial_fit: FitResult
    fitted: FitResult
    coarse: float

    def problem_about(self, known: FitResult) -> LeastSquaresProblem:
        """The problem on which starts of a fit are tried, corrected about a known fit where it is a coarse one."""
        return self.problem if self.coarse == 1.0 else self.problem.coarsened(known.point, known.predictions)

    def fit(self, hypothesis: Hypothesis | None, start: Floats) -> FitResult:
        """Fit of a hypothesis from the coefficients `start` (k,), from coarse to fine where the coarse mesh serves."""
        fit = gauss_newton if self.coarse == 1.0 else fit_coarse_to_fine
        return fit(self.problem, hypothesis, start, ParameterPoint())


def fit_baseline(campaign: Campaign, executor: Executor, report_progress: ProgressCallback = no_progress) -> BaselineFit:
    """Whiten the fit runs, and refit plant parameters and the effects that are in the model."""
    runs = campaign.of_role("fit")
    report_progress("simulating the model as given")
    nominal = collect_predictions(runs, submit_replays(campaign, runs, ParameterPoint(), executor))
    posed = build_problem(campaign, runs, executor, nominal)
    # A model file could not change what runs state.
    problem = replace(posed, held=posed.held | keys_set_by_runs(campaign))
    report_progress("fitting the plant parameters")
    hypothesis, coefficients = effects_in_model(campaign)
    start = np.concatenate([np.zeros(len(PLANT_PARAMETERS)), coefficients])
    rough, initial, fitted = fit_from_file(problem, hypothesis, start, ParameterPoint(), nominal)
    coarse = problem_of_fits(problem, rough, fitted).coarse
    return BaselineFit(campaign, problem, replace(initial, predictions=nominal), fitted, coarse)
