"""Scores, penalties, priors and weighted least squares, each against its definition."""

import math

import numpy as np
import pytest

from comprope_system.identification.comparison.nrmse import channel_error, overall
from comprope_system.identification.estimation.mass_search import promises
from comprope_system.identification.estimation.model_score import (
    NoiseLevel,
    chi_square_resolution,
    complexity_penalty,
    least_noticed,
    log_score,
    penalised_chi_square,
    prior_cost,
)
from comprope_system.identification.estimation.weighted_least_squares import Solution, compressed, scale_of, solve, solve_in_scale
from comprope_system.identification.prediction.effect_hypotheses import Hypothesis
from comprope_system.identification.prediction.plant_parameters import PLANT_PARAMETERS, Direction


def directions(count: int, prior: float = 1.0, **bounds: float) -> tuple[Direction, ...]:
    return tuple(Direction(f"x{k}", {}, prior, **bounds) for k in range(count))


NOISE = NoiseLevel(3000, 0.8)


def test_where_noise_is_all_that_is_left_the_score_is_the_likelihood() -> None:
    """Half of chi-square over that of a datum of noise, in each of 3000 data, beyond the 0.5 % that the model may err."""
    explained = 0.8 * 3000.0 * 1.005
    gain = log_score(explained, NOISE) - log_score(explained + 0.1, NOISE)
    assert gain == pytest.approx(0.5 * 0.1 / 0.8, rel=1e-3)
    assert log_score(0.8 * 3000.0, NOISE) == log_score(explained, NOISE) == 0.0


def test_a_discrepancy_counts_as_two_hundred_amplitudes() -> None:
    """Halving a chi-square that is mostly discrepancy gains 100 ln 2, however many data there are."""
    assert log_score(1e9, NOISE) - log_score(2e9, NOISE) == pytest.approx(100.0 * math.log(2.0), rel=1e-4)
    assert log_score(4e3, NOISE) == pytest.approx(-100.0 * math.log1p((4e3 / 0.8 - 3015.0) / 200.0), rel=1e-14)
    assert log_score(4e3, NOISE, 7.5) == pytest.approx(log_score(4e3, NOISE) - 7.5, rel=1e-14)


def test_the_best_fit_tells_the_noise_as_far_as_it_can_be_noise() -> None:
    assert NoiseLevel.of_fits(1000, [950.0, 870.0, 4e4]).reduced == 0.87
    assert NoiseLevel.of_fits(1000, [1300.0, 4e4]).reduced == 1.1


@pytest.mark.parametrize("chi_square", [2400.0, 1e4])
def test_the_least_decrease_that_is_noticed_is_worth_its_cost(chi_square: float) -> None:
    """Of a model that lacks an effect, beside the best fit, which leaves `chi_square`."""
    raised = chi_square + least_noticed(chi_square, NOISE, 12.0)
    assert log_score(chi_square, NOISE) - log_score(raised, NOISE) == pytest.approx(12.0, rel=1e-9)


@pytest.mark.parametrize("chi_square", [2400.0, 1e6])
def test_a_fit_ends_where_the_score_gains_little(chi_square: float) -> None:
    """Near the noise a decrease of chi-square by two data's noise is one unit of score; of a large one it is one per cent."""
    step = chi_square_resolution(chi_square, 3000, 1.0)
    assert step == pytest.approx(1.6 if chi_square == 2400.0 else 0.01 * (chi_square - 3000.0 * 1.1 * 1.005 + 220.0), rel=1e-9)


@pytest.mark.parametrize(
    ("here", "there", "promising"),
    [(2900.0, 2700.0, True), (2700.0, 2690.0, False), (1.00e6, 0.90e6, True), (1.00e6, 0.92e6, False), (2700.0, 2900.0, False)],
)
def test_another_mass_is_tried_for_a_tenth_of_much_or_for_twenty_of_noise(here: float, there: float, promising: bool) -> None:
    """Noise that is stated too large hides a mass that is a tenth off, unless all that it leaves is counted."""
    found = {mass: Solution(np.zeros(1), left, left, np.zeros((1, 1))) for mass, left in ((0.0, here), (0.1, there))}
    assert promises(found, 0.1, 0.0, 3470) is promising
    assert not promises(found, 0.0, 0.0, 3470)
    assert not promises({0.1: found[0.1]}, 0.1, 0.0, 3470)


def test_an_orthogonal_transform_keeps_every_sum_of_squares() -> None:
    random = np.random.default_rng(5)
    matrix, residual = random.normal(size=(400, 3)), random.normal(size=400)
    small, left = compressed(matrix, residual)
    assert small.shape == (4, 3)
    for x in random.normal(size=(4, 3)):
        assert np.sum((left - small @ x) ** 2) == pytest.approx(np.sum((residual - matrix @ x) ** 2), rel=1e-12)


def test_what_was_free_to_choose_has_its_penalty() -> None:
    """2.5 for the effect and for each direction, 1 for each run's own phase, and the choice among alternatives."""
    plain = Hypothesis("air_drag", directions(2))
    assert complexity_penalty(plain, 1) == 2.5 * 3
    assert complexity_penalty(plain, 8) == pytest.approx(2.5 * 3 + math.log(8.0), rel=1e-14)
    turned = Hypothesis("building_sway", directions(4), phase_runs=("a.csv", "b.csv"))
    assert complexity_penalty(turned, 1) == 2.5 * 3 + 2 * 1.0
    both = Hypothesis("two", directions(6), parts=(plain, turned))
    assert complexity_penalty(both, 1) == 2.5 * 5 + 2 * 1.0


def test_a_plant_off_its_data_sheet_costs_student_s_t_of_four_degrees_of_freedom() -> None:
    off = np.zeros(len(PLANT_PARAMETERS) + 3)
    off[0], off[-1] = 2.0 * PLANT_PARAMETERS[0].prior, 1e3  # what follows the plant's coefficients is no plant
    assert prior_cost(off) == pytest.approx(2.5 * math.log(2.0), rel=1e-12)
    off[3] = -PLANT_PARAMETERS[3].prior
    assert prior_cost(off) == pytest.approx(2.5 * (math.log(2.0) + math.log(1.25)), rel=1e-12)


def test_a_cost_lowers_the_score_of_a_discrepancy_by_itself_when_it_raises_chi_square() -> None:
    raised = penalised_chi_square(3e9, 4.0)
    assert log_score(raised, NOISE) == pytest.approx(log_score(3e9, NOISE) - 4.0, rel=1e-4)


@pytest.mark.parametrize(("chi_square", "count", "expected"), [(500.0, 100, 5.0), (50.0, 100, 1.0), (3.0, 0, 3.0)])
def test_squares_stand_for_noise_or_for_whatever_is_more(chi_square: float, count: int, expected: float) -> None:
    assert scale_of(chi_square, count) == expected


RANDOM = np.random.default_rng(4)
MATRIX, RESIDUAL = RANDOM.normal(size=(40, 3)), RANDOM.normal(size=40)
PRIOR, START = np.array([0.5, 2.0, 0.1]), np.array([0.3, -0.2, 0.05])
THREE = tuple(Direction(f"x{k}", {}, float(prior)) for k, prior in enumerate(PRIOR))


@pytest.mark.parametrize("scale", [1.0, 7.0])
def test_the_fit_is_the_most_likely_under_its_gaussian_priors(scale: float) -> None:
    """Normal equations of |r - A (x - start)|^2 / scale + |x / prior|^2; the covariance is that without a scale."""
    found = solve(RESIDUAL, MATRIX, THREE, START, scale)
    normal = MATRIX.T @ MATRIX + scale * np.diag(PRIOR**-2.0)
    expected = np.linalg.solve(normal, MATRIX.T @ (RESIDUAL + MATRIX @ START))
    left = RESIDUAL - MATRIX @ (expected - START)
    assert found.coefficients == pytest.approx(expected, rel=1e-9)
    assert found.chi_square == pytest.approx(float(left @ left), rel=1e-9)
    assert found.cost == pytest.approx(float(left @ left + scale * ((expected / PRIOR) ** 2).sum()), rel=1e-9)
    assert found.covariance == pytest.approx(np.linalg.inv(MATRIX.T @ MATRIX + np.diag(PRIOR**-2.0)), rel=1e-9)


def test_bounds_are_kept() -> None:
    bounded = (Direction("x", {}, 10.0, lower=0.0, upper=0.2),)
    up, down = (solve(sense * 5.0 * MATRIX[:, 0], MATRIX[:, :1], bounded, np.zeros(1)) for sense in (1.0, -1.0))
    assert float(up.coefficients[0]) == pytest.approx(0.2, abs=1e-9)
    assert float(down.coefficients[0]) == pytest.approx(0.0, abs=1e-9)


def test_a_model_that_misses_more_than_noise_is_fitted_in_the_scale_of_what_is_left() -> None:
    loud = 10.0 * RESIDUAL
    sharp = solve(loud, MATRIX, THREE, START)
    expected = solve(loud, MATRIX, THREE, START, sharp.chi_square / 40)
    assert solve_in_scale(loud, MATRIX, THREE, START).coefficients == pytest.approx(expected.coefficients, rel=1e-12)
    assert sharp.chi_square / 40 > 10.0


def test_an_error_is_relative_to_the_variation_of_good_samples() -> None:
    wave = np.sin(np.linspace(0.0, 40.0, 1000))
    measured, predicted = wave.copy(), 0.9 * wave
    measured[500], predicted[700] = 50.0, np.nan  # an outlier; out of view
    kept = np.setdiff1d(np.arange(1000), (500, 700))
    expected = np.sqrt(np.mean((0.1 * wave[kept]) ** 2)) / np.std(wave[kept])
    assert channel_error(measured, predicted, 0.01) == pytest.approx(expected, rel=1e-9)
    assert math.isnan(channel_error(np.full(5, np.nan), np.zeros(5), 0.01))
    assert overall([0.3, float("nan"), 0.4]) == pytest.approx(math.sqrt(0.125), rel=1e-12)
    assert math.isnan(overall([]))
