"""Two effects fitted together: which of them is needed, and which explains most."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from comprope.rope.effects import REGISTRY
from comprope_system.identification.diagnosis import pair_fits
from comprope_system.identification.diagnosis.candidate_fits import CandidateFit, FitContext
from comprope_system.identification.diagnosis.linear_screening import ScreenedHypothesis
from comprope_system.identification.diagnosis.size_screening import with_sizes
from comprope_system.identification.estimation.gauss_newton import FitResult
from comprope_system.identification.prediction.effect_hypotheses import combine, hypotheses_of_effect
from comprope_system.identification.prediction.parameter_point import ParameterPoint
from comprope_system.identification.prediction.plant_parameters import PLANT_PARAMETERS

PLANT = len(PLANT_PARAMETERS)
HYSTERESIS = hypotheses_of_effect(REGISTRY["bending_hysteresis"], ())[0]
BEARING = hypotheses_of_effect(REGISTRY["bearing_friction"], ())[0]


def fit(hypothesis, chi_square: float) -> FitResult:
    """A fit whose coefficients and derivatives tell their places."""
    count = PLANT + len(hypothesis.directions)
    numbers = np.arange(float(count))
    covariance = np.add.outer(100.0 * numbers, numbers)
    return FitResult(hypothesis, ParameterPoint(), {}, numbers, covariance, np.tile(numbers, (3, 1)), chi_square, 0.0, 0.0)


def screened(hypothesis, chi_square: float = 1.0, sized: bool = False) -> ScreenedHypothesis:
    start = np.full(PLANT + len(hypothesis.directions), float(sized))
    return ScreenedHypothesis(hypothesis, start, chi_square, 0.0, np.zeros((3, len(hypothesis.directions))), 1.0, 1, sized)


def candidate(one: ScreenedHypothesis, fitted: FitResult, refined: bool = True) -> CandidateFit:
    """A fit to a problem that nobody asks for."""
    return CandidateFit(one, fitted, refined, SimpleNamespace(), fitted.chi_square)


def test_the_effects_of_a_combination_change_places_with_all_that_belongs_to_them() -> None:
    pair = fit(combine(HYSTERESIS, BEARING), 5.0)
    found = pair_fits.in_order(pair, ["bearing_friction", "bending_hysteresis"])
    first, others = len(HYSTERESIS.directions), len(BEARING.directions)
    columns = [*range(PLANT), *range(PLANT + first, PLANT + first + others), *range(PLANT, PLANT + first)]
    assert [part.effect for part in found.hypothesis.parts] == ["bearing_friction", "bending_hysteresis"]
    assert found.coefficients.tolist() == columns
    assert found.jacobian[0].tolist() == columns
    assert np.diag(found.covariance).tolist() == [101.0 * k for k in columns]
    back = pair_fits.in_order(found, ["bending_hysteresis", "bearing_friction"])
    assert back.coefficients.tolist() == pair.coefficients.tolist()


def test_each_effect_of_a_pair_is_fitted_alone_from_what_it_is_in_the_pair(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first one had stopped at a false minimum: alone, the second explains as much as both."""
    alone, starts = {"bending_hysteresis": 200.0, "bearing_friction": 5.1}, {}

    def fitted_alone(problem, hypothesis, start, base):
        starts[hypothesis.effect] = start
        return replace(fit(hypothesis, alone[hypothesis.effect]), coefficients=start)

    monkeypatch.setattr(pair_fits, "gauss_newton", fitted_alone)
    monkeypatch.setattr(pair_fits, "corrected_by_full_mesh", lambda context, one, fitted: candidate(one, fitted))
    monkeypatch.setattr(pair_fits, "with_mass_search", lambda context, one: one)
    context = FitContext(None, None, ParameterPoint(), fit(HYSTERESIS, 900.0), lambda stage: None)
    pair = candidate(screened(BEARING), fit(combine(HYSTERESIS, BEARING), 5.0))
    first = [
        candidate(screened(HYSTERESIS), fit(HYSTERESIS, 150.0)),
        candidate(screened(BEARING), fit(BEARING, 260.0), refined=False),
    ]
    found = pair_fits.with_single_fits(context, first, pair)
    by_name = {one.hypothesis.effect: one for one in found}
    assert by_name["bearing_friction"].fitted.chi_square == 5.1
    assert by_name["bearing_friction"].refined
    assert by_name["bending_hysteresis"].fitted.chi_square == 150.0  # what was known already is better
    assert [part.effect for part in found[-1].hypothesis.parts] == ["bearing_friction", "bending_hysteresis"]
    own = list(range(PLANT + len(HYSTERESIS.directions), PLANT + len(HYSTERESIS.directions) + len(BEARING.directions)))
    assert starts["bearing_friction"][PLANT:].tolist() == own


def test_a_size_that_explains_more_is_where_a_fit_begins() -> None:
    linear = [screened(HYSTERESIS, 50.0), screened(BEARING, 80.0)]
    found = with_sizes(linear, [screened(BEARING, 2.0, sized=True), screened(HYSTERESIS, 60.0, sized=True)])
    assert [one.hypothesis.effect for one in found] == ["bearing_friction", "bending_hysteresis"]
    assert [one.sized for one in found] == [True, False]
    assert found[0].start[-1] == 1.0
    assert found[0].orthogonal_part is linear[1].orthogonal_part
