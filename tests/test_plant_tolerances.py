"""How well a user knows the plant: priors stated in campaign.toml."""

from dataclasses import replace
from math import log

import numpy as np
import pytest

from comprope.errors import InputError
from comprope_system.identification.data.campaign import load_campaign
from comprope_system.identification.estimation.weighted_least_squares import build_problem
from comprope_system.identification.prediction.plant_parameters import (
    PLANT_PARAMETERS,
    USER,
    fixed_parameters,
    plant_values,
    with_tolerances,
)
from comprope_system.measurements.campaign_file import Tolerance
from comprope_system.parallel.executors import threads

from . import virtual_elevator

VALUES = plant_values(virtual_elevator.MODEL)
MASS, DAMPING, CLOCK = "rope.mass_per_length", "rope.external_damping", "clock.offset"


def prior(stated: dict, key: str) -> float:
    return next(one.prior for one in with_tolerances(stated, VALUES) if one.name == key)


def test_without_a_statement_priors_are_the_default_ones() -> None:
    assert with_tolerances({}, VALUES) == PLANT_PARAMETERS


def test_a_relative_tolerance_is_a_factor_and_an_absolute_one_an_amount() -> None:
    assert prior({MASS: Tolerance(relative=0.02)}, MASS) == pytest.approx(log(1.02))
    assert prior({MASS: Tolerance(absolute=0.1 * VALUES[MASS])}, MASS) == pytest.approx(log(1.1))
    assert prior({DAMPING: Tolerance(absolute=0.3)}, DAMPING) == 0.3
    assert prior({CLOCK: Tolerance(absolute=0.5)}, CLOCK) == 0.5
    stated = with_tolerances({MASS: Tolerance(relative=0.02)}, VALUES)
    assert [one.name for one in stated if one.origin == USER] == [MASS]


def test_what_is_fixed_is_held() -> None:
    assert fixed_parameters({MASS: "fixed", DAMPING: Tolerance(absolute=0.1)}) == {MASS}


def test_all_that_is_no_tolerance_is_told_at_once() -> None:
    wrong = {
        "rope.colour": "fixed", MASS: Tolerance(), "sheave.mass": Tolerance(relative=0.1, absolute=1.0),
        DAMPING: Tolerance(relative=0.1),
    }  # fmt: skip
    with pytest.raises(InputError) as error:
        with_tolerances(wrong, VALUES)
    lines = str(error.value).splitlines()
    assert len(lines) == 4
    assert lines[0].startswith('plant."rope.colour": no parameter that fits adjust; accepted are rope.bending_stiffness')


def test_the_file_s_tolerances_reach_the_fits(tmp_path) -> None:
    folder = virtual_elevator.campaign(tmp_path / "known", {})
    file = folder / "campaign.toml"
    file.write_text(f'{file.read_text()}\n[plant]\n"{MASS}" = {{ relative = 0.01 }}\n"sheave.mass" = "fixed"\n')
    campaign = load_campaign(folder)
    run = campaign.runs[0]
    flat = {(run.file, column): np.zeros(len(run.time)) for column in campaign.channels}
    with threads() as executor:
        problem = build_problem(campaign, [run], executor, flat)
    assert next(one.prior for one in problem.plant if one.name == MASS) == pytest.approx(log(1.01))
    assert problem.held == {"sheave.mass"}
    off = np.array([0.01 if one.name == MASS else 0.0 for one in problem.plant])
    loose = replace(problem, campaign=replace(campaign, tolerances={}))
    assert problem.prior_cost(off) > 10.0 * loose.prior_cost(off)


@pytest.mark.parametrize("text", ['"rope.mass_per_length" = { relative = -0.1 }', '"rope.mass_per_length" = "known"'])
def test_a_tolerance_out_of_bounds_is_refused_with_its_key(tmp_path, text: str) -> None:
    folder = virtual_elevator.campaign(tmp_path / "wrong", {})
    file = folder / "campaign.toml"
    file.write_text(f"{file.read_text()}\n[plant]\n{text}\n")
    with pytest.raises(InputError, match="mass_per_length"):
        load_campaign(folder)
