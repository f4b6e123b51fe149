"""Fits on a coarse mesh and continued on the full one give what fits on the full mesh alone give."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from comprope.rope.model_file import with_changes
from comprope_system.identification.data.campaign import load_campaign
from comprope_system.identification.estimation.coarse_to_fine import fit_coarse_to_fine, problem_of_fits, with_derivatives
from comprope_system.identification.estimation.gauss_newton import gauss_newton
from comprope_system.identification.estimation.weighted_least_squares import build_problem
from comprope_system.identification.prediction.parameter_point import ParameterPoint, collect_predictions, submit_replays
from comprope_system.identification.prediction.plant_parameters import PLANT_PARAMETERS
from comprope_system.parallel.executors import threads

from . import virtual_elevator


def test_a_fit_continued_from_the_coarse_mesh_ends_where_one_on_the_full_mesh_does(tmp_path, monkeypatch):
    """Elements of 6 cm can be doubled on a sheave of 0.4 m radius; the fit on the full mesh alone is the reference."""
    finer = with_changes(virtual_elevator.MODEL, {"rope.element_length": 0.06})
    monkeypatch.setattr(virtual_elevator, "MODEL", finer)
    campaign = load_campaign(virtual_elevator.campaign(tmp_path, {}))
    runs, start = campaign.of_role("fit"), np.zeros(len(PLANT_PARAMETERS))
    with threads() as executor:
        nominal = collect_predictions(runs, submit_replays(campaign, runs, ParameterPoint(), executor))
        problem = build_problem(campaign, runs, executor, nominal)
        assert problem.coarsened(ParameterPoint(), nominal).coarse == 2.0
        found = fit_coarse_to_fine(problem, None, start, ParameterPoint())
        found = with_derivatives(problem, found, ParameterPoint())
        reference = gauss_newton(problem, None, start, ParameterPoint())
    count = len(problem.data)
    assert found.chi_square < 1.1 * count  # noise alone is left
    assert found.cost(1.0) == pytest.approx(reference.cost(1.0), abs=0.01 * count)
    # What is left of their difference is small beside the noise, which has a standard deviation of 1.
    apart = problem.whitened(found.predictions) - problem.whitened(reference.predictions)
    assert np.sqrt(np.mean(apart**2)) < 0.15
    errors = np.sqrt(np.diag(found.covariance) / np.diag(reference.covariance))
    assert errors == pytest.approx(np.ones(len(start)), rel=0.5)


@pytest.mark.parametrize(("left", "error", "on_coarse_mesh"), [(3.0, 0.2, True), (3.0, 0.3, False), (1.05, 0.3, True)])
def test_effects_are_fitted_on_the_full_mesh_where_the_coarse_one_errs_by_what_they_explain(
    tmp_path, monkeypatch, left, error, on_coarse_mesh
):
    """The plant leaves some multiple of the noise. The coarse mesh errs by a share of what is beyond it."""
    monkeypatch.setattr(virtual_elevator, "MODEL", with_changes(virtual_elevator.MODEL, {"rope.element_length": 0.06}))
    campaign = load_campaign(virtual_elevator.campaign(tmp_path, {}))
    runs = campaign.of_role("fit")
    with threads() as executor:
        nominal = collect_predictions(runs, submit_replays(campaign, runs, ParameterPoint(), executor))
        problem = build_problem(campaign, runs, executor, nominal)
        coarse, count = problem.coarsened(ParameterPoint(), nominal), len(problem.data)
        rough = replace(coarse, data=coarse.data + np.sqrt((left - 1.0) * error))
        baseline = SimpleNamespace(point=ParameterPoint(), predictions=nominal, chi_square=left * count)
        found = problem_of_fits(problem, rough, baseline)
    assert found.coarse == (coarse.coarse if on_coarse_mesh else 1.0)
