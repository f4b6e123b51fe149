"""A model from a data sheet: estimates by the rope's construction, what is stated first, tolerances for the fits."""

import tomllib

import numpy as np
import pandas as pd
import pytest

import comprope_system
from comprope.errors import InputError
from comprope.rope.model_file import load
from comprope_system.campaign_setup.elevator_model.data_sheet import from_data_sheet
from comprope_system.campaign_setup.elevator_model.rope_catalogue import catalogue_rope
from comprope_system.identification.prediction.plant_parameters import plant_values, with_tolerances
from comprope_system.measurements.campaign_file import read_campaign_file
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited

from .virtual_elevator import PHASES

SHEET = """
[shaft]
height = 15.0
pit = 1.5
[rope]
diameter = 0.016
construction = "8x19S-FC"
[sheave]
diameter = 0.8
mass = 480
ropes = 4
[[sensors]]
name = "cw_low"
side = "counterweight"
height = 0.5
"""


@pytest.fixture
def run(tmp_path):
    """A file with the car's position and one laser."""
    time = np.arange(0.0, 14.0, 0.02)
    car = jerk_limited(2.0, 9.0, 1.0, PHASES).value(time)
    laser = 5.0 * np.sin(2.0 * time) * (time > 1.0) + 0.1 * np.random.default_rng(1).standard_normal(len(time))
    pd.DataFrame({"time": time, "car_position": car, "cw_low [mm]": laser}).to_csv(tmp_path / "up.csv", index=False)
    return tmp_path / "up.csv"


@pytest.mark.parametrize(
    ("diameter", "construction", "mass", "area"),
    # kg/m and mm2 of catalogues: DIN EN 12385-5 ropes of 13 and 16 mm with fibre core, 24 mm with steel core
    [(0.013, "8x19S-FC", 0.575, 59.0), (0.016, "8 x 19 W + SFC", 0.870, 89.3), (0.024, "6x36WS-IWRC", 2.36, 265.0),
     (0.016, "8x25FFC", 0.870, 89.3)],
)  # fmt: skip
def test_mass_and_stiffness_follow_from_diameter_and_construction(diameter, construction, mass, area):
    found = catalogue_rope(diameter, construction)
    assert found["mass_per_length"].value == pytest.approx(mass, rel=0.005)
    assert 50e3 * area < found["axial_stiffness"].value < 120e3 * area  # N, at 50 to 120 GPa
    free, bonded = 1.1e7 * diameter**4, 430 * 2.2e7 * diameter**4  # N m2
    spread = 1.0 + found["bending_stiffness"].tolerance
    assert free < found["bending_stiffness"].value / spread and found["bending_stiffness"].value * spread < bonded


@pytest.mark.parametrize("construction", ["8x19", "7x19-FC", "8x3-FC", "rope", "", "8x19-XYZ", "8x900-FC"])
def test_a_construction_that_is_not_known_is_refused_with_what_is_accepted(construction):
    with pytest.raises(InputError, match="are accepted, such as 8x19-FC"):
        catalogue_rope(0.016, construction)


def test_what_the_sheet_states_goes_before_what_is_estimated():
    stated = SHEET.replace("diameter = 0.016", "diameter = 0.016\nmass_per_length = 0.91").replace(
        "mass = 480", "mass = 480\ninertia = 30.0"
    )
    found = from_data_sheet(tomllib.loads(stated + "[contact]\nfriction_coefficient = 0.1\n"), "sheet.toml")
    model = found.model
    assert (model.rope.mass_per_length, model.sheave.inertia, model.contact.friction_coefficient) == (0.91, 30.0, 0.1)
    assert (model.sheave.radius, model.sheave.mass_per_rope) == (0.4, 120.0)
    assert set(found.tolerances) == {"rope.axial_stiffness", "rope.bending_stiffness"}
    assert "contact.friction_coefficient" not in found.estimates and "contact.stiffness" in found.estimates


def test_all_problems_of_a_sheet_are_told_at_once():
    wrong = (
        SHEET.replace("8x19S-FC", "8x19").replace("height = 15.0", "hight = 15.0").replace("diameter = 0.8", 'diameter = "0.8 m"')
    )
    with pytest.raises(InputError) as error:
        from_data_sheet(tomllib.loads(wrong), "sheet.toml")
    lines = str(error.value).splitlines()
    assert all(one.startswith("sheet.toml: ") for one in lines)
    keys = [one.split(": ")[1].split(" = ")[0] for one in lines]
    assert keys == ["rope.construction", "sheave.diameter", "shaft.height", "shaft.hight"]


def test_a_new_campaign_from_a_data_sheet_states_how_well_the_plant_is_known(tmp_path, run):
    (tmp_path / "sheet.toml").write_text(SHEET)
    result = comprope_system.new(tmp_path / "campaign", [run], model=tmp_path / "sheet.toml")
    assert result.check.problems == ()
    written = read_campaign_file(tmp_path / "campaign" / "campaign.toml")
    model = load(tmp_path / "campaign" / written.model)
    priors = {one.name: one.prior for one in with_tolerances(written.plant, plant_values(model))}
    assert priors["rope.bending_stiffness"] == pytest.approx(np.log(3.0))
    assert priors["sheave.inertia"] == pytest.approx(np.log(1.3)) and priors["sheave.mass"] == 0.01
    assert any(one.startswith("rope.mass_per_length = 0.8704 kg/m, estimated within 10 %: W = 0.34") for one in result.remarks)
    (tmp_path / "campaign" / "campaign.toml").unlink()
    comprope_system.new(tmp_path / "campaign", [run], model=tmp_path / "sheet.toml")  # again, with the same model
    (tmp_path / "campaign" / "campaign.toml").unlink()
    (tmp_path / "sheet.toml").write_text(SHEET.replace("480", "400"))
    with pytest.raises(InputError, match=r"model.toml: exists with another content"):
        comprope_system.new(tmp_path / "campaign", [run], model=tmp_path / "sheet.toml")


def test_a_model_is_asked_for_where_none_is_named(tmp_path, run):
    answers = {
        "Model of the elevator": ["13 mm 8x19", "16 mm 8x19-FC"], "elevator: travel": ["15"], "elevator: sheave axle": ["1.2"],
        "elevator: ropes": ["2.5", "4"], "elevator: mass": ["480"], "elevator: radius": ["0.4"],
        "elevator: a sensor": ["cw_low counterweight", "cw_low left 0.5", "cw_low counterweight 0.5", "-"], "up.csv: mass": [""],
    }  # fmt: skip

    def ask(question: str, default: str) -> str:
        key = next(key for key in answers if question.splitlines()[-1].startswith(key))
        return answers[key].pop(0) or default

    result = comprope_system.new(tmp_path / "campaign", [run], ask=ask)
    assert result.check.problems == () and not any(answers.values())
    model = load(tmp_path / "campaign" / "model.toml")
    assert (model.shaft.height, model.shaft.pit, model.sheave.ropes) == (15.0, 1.2, 4.0)
    assert model.rope.mass_per_length == pytest.approx(0.8704) and model.sensors[0].side == "counterweight"
