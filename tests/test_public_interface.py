"""`import comprope_system` in a script: every function, from outside the repository, printing and writing nothing."""

import inspect
import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import comprope_system
from comprope.errors import InputError
from comprope.rope.model_file import load
from comprope_system.presets import model_path

from . import virtual_elevator

COARSE = {"rope.element_length": 0.2, "solver.step": 0.005, "shaft.height": 12.0}
FUNCTIONS = ("add", "compare", "design", "diagnose", "fmu", "improve", "modes", "simulate", "tune")
SCRIPT = """
import sys
import comprope_system
assert not {"numpy", "numba", "pandas", "matplotlib"} & set(sys.modules), "heavy imports before the first use"
changes = {"rope.element_length": 0.2, "solver.step": 0.005, "shaft.height": 12.0}
motion = comprope_system.CarMotion(start=1.0, end=2.0)
trip = comprope_system.simulate("tower50", motion, changes=changes, duration=1.0, step=0.05)
assert list(trip.to_dataframe()["time"])[-1] == 1.0
found = comprope_system.modes("tower50", 3.0, 4, changes=changes)
assert len(found.modes) == 4
trip.save_html("trip.html")
"""


def checked(result):
    """The JSON of a result whose text, table and notebook view are there."""
    table = result.to_dataframe()
    assert len(table) and result.summary() and "\n" not in result.headline()
    assert result._repr_html_().count("<tr") >= min(len(table), 12) and type(result).__name__ in repr(result)
    return json.loads(json.dumps(result.to_json(), allow_nan=False))


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    return virtual_elevator.campaign(tmp_path_factory.mktemp("campaign"), {})


def test_a_script_outside_the_repository_needs_one_import_and_is_told_nothing(tmp_path):
    done = subprocess.run([sys.executable, "-c", SCRIPT], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert [path.name for path in tmp_path.iterdir()] == ["trip.html"]


def test_every_function_has_a_docstring_types_and_at_most_eight_arguments():
    assert set(FUNCTIONS) <= set(comprope_system.__all__) <= set(dir(comprope_system))
    for name in FUNCTIONS:
        function = getattr(comprope_system, name)
        signature = inspect.signature(function)
        assert function.__doc__ and len(signature.parameters) <= 8
        assert all(one.annotation is not one.empty for one in signature.parameters.values())
        assert hasattr(signature.return_annotation, "to_dataframe")
    with pytest.raises(AttributeError, match="no attribute 'journey'"):
        comprope_system.journey  # noqa: B018


def test_the_name_design_is_the_function_whatever_was_imported_before():
    import comprope_system.sheave_design.workflow

    assert comprope_system.design is comprope_system.sheave_design.workflow.design


def test_a_trip_is_one_result(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    steps = []
    result = comprope_system.simulate(
        load(model_path("tower50")), comprope_system.CarMotion(1.0, 2.0, speed=0.8), changes=COARSE, duration=2.0, step=0.05,
        progress=lambda *step: steps.append(step),
    )  # fmt: skip
    found = checked(result)
    assert steps[0] == ("simulating", 0, 40) and steps[-1] == ("simulating", 40, 40)
    assert capsys.readouterr() == ("", "") and not list(tmp_path.iterdir())
    assert found["units"]["car_position"] == "m" and len(found["table"]["time"]) == 41
    assert result.model.shaft.height == 12.0 and result.sensors == ("cw_low", "cw_mid", "cw_high", "car_low")
    texts = [f"{key}={value}" for key, value in COARSE.items()]
    again = comprope_system.simulate(
        "tower50", comprope_system.CarMotion(1.0, 2.0, speed=0.8), changes=texts, duration=2.0, step=0.05
    )
    assert again.table.equals(result.table)
    result.save_plot(tmp_path / "trip.png")
    assert (tmp_path / "trip.png").read_bytes().startswith(b"\x89PNG")


def test_a_page_that_plays_the_trip_needs_the_shape_that_an_fmu_does_not_show(tmp_path):
    result = comprope_system.simulate("tower50", comprope_system.CarMotion(1.0, 2.0), changes=COARSE, duration=0.2, step=0.1)
    with pytest.raises(InputError, match="fmu = True: "):
        type(result)(**vars(result) | {"recording": None}).save_html(tmp_path / "trip.html")
    assert not list(tmp_path.iterdir())


def test_modes_are_one_result(tmp_path):
    result = comprope_system.modes("tower50", 3.0, 5, changes=COARSE)
    found = checked(result)
    assert [one["period"] for one in found["modes"]] == list(result.to_dataframe()["period"])
    assert found["car_position"] == result.car == 3.0
    result.save_html(tmp_path / "modes.html")
    assert "<img" in (tmp_path / "modes.html").read_text("utf-8")
    with pytest.raises(InputError, match="count = 0: a whole number from 1 is accepted"):
        comprope_system.modes("tower50", count=0)


def test_a_comparison_is_one_result(capsys, campaign, tmp_path):
    with ThreadPoolExecutor(1) as executor:
        result = comprope_system.compare(campaign, executor=executor)
    found = checked(result)
    assert capsys.readouterr() == ("", "")
    assert found["nrmse"] == result.nrmse and found["reduced_chi_square"] == found["chi_square_per_sample"]
    table = result.to_dataframe()
    assert len(table) == len(result.runs) * len(result.campaign.channels) and {"nrmse", "rmse", "cruise"} <= set(table)
    assert np.sqrt(np.mean(table[table["role"] == "fit"]["nrmse"] ** 2)) == pytest.approx(result.fit_nrmse)
    assert result.headline().startswith("NRMSE ") and "Reduced chi-square" in result.summary()
    again = comprope_system.compare(result.campaign)  # what is loaded already is taken as it is
    assert again.to_json() == result.to_json()
    result.save_html(tmp_path / "page.html")
    result.save_json(tmp_path / "result.json")
    assert json.loads((tmp_path / "result.json").read_text()) == found


def test_bad_input_is_refused_before_anything_is_computed(campaign):
    for call, wanted in (
        (lambda: comprope_system.compare(campaign / "nowhere"), "nowhere/campaign.toml: cannot be read"),
        (lambda: comprope_system.diagnose(campaign, without=["air_drga"]), 'did you mean "air_drag"'),
        (lambda: comprope_system.add(campaign, "air_drga"), 'did you mean "air_drag"'),
        (lambda: comprope_system.simulate("tower5O"), 'did you mean "tower50"'),
        (lambda: comprope_system.simulate("tower50", changes={"sheave.mas": 1.0}), "changes: sheave.mas = 1.0: unknown key"),
        (lambda: comprope_system.tune("tower50", comprope_system.TuningOptions([(0.0, 60.0)])), "trip 0.0:60.0: two heights"),
        (lambda: comprope_system.tune("tower50", comprope_system.TuningOptions(travel_times=[0.9])), "travel_times: 0.9: "),
    ):
        with pytest.raises(InputError, match=wanted):
            call()
