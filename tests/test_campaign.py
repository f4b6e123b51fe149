"""Campaigns as they come: all problems of all files at once, each with its key, value and what is accepted."""

import numpy as np
import pandas as pd
import pytest

from comprope.errors import InputError
from comprope.rope.model_file import dump
from comprope_system.identification.data.campaign import load_campaign

from .virtual_elevator import END, MODEL, PHASES, SAMPLING, description

CHANNEL = '[[channels]]\ncolumn = "cw_low"\nquantity = "lateral_displacement"\nsensor = "cw_low"\nunit = "mm"\n'
RUN = '[[runs]]\nfile = "up.csv"\nrole = "fit"\n'


@pytest.fixture
def folder(tmp_path):
    """A campaign whose files are right; nothing is simulated, so the channels say little."""
    dump(MODEL, tmp_path / "elevator.toml")
    table(tmp_path, "up.csv", 2.0, 7.0)
    table(tmp_path, "down_light.csv", 10.0, -7.0)
    table(tmp_path, "up_short.csv", 4.0, 5.0)
    (tmp_path / "campaign.toml").write_text(description())
    return tmp_path


def table(folder, file, start, way, **columns):
    """Write the CSV of a trip; `columns` replace or, if None, take out."""
    from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited

    time = np.arange(0.0, END, SAMPLING)
    whole = {"time": time, "car_position": jerk_limited(start, way, 1.0, PHASES).value(time)}
    whole |= {name: np.full(len(time), 5.0) for name in ("cw_low", "car_low", "axle", "turning")} | columns
    kept = {name: values for name, values in whole.items() if values is not None}
    pd.DataFrame(kept).to_csv(folder / file, index=False)


def told(folder) -> list[str]:
    """The lines of the error that loading raises."""
    with pytest.raises(InputError) as error:
        load_campaign(folder)
    return str(error.value).splitlines()


def test_a_good_campaign_is_read_in_si_units(folder):
    campaign = load_campaign(folder)
    assert [run.file for run in campaign.of_role("validate")] == ["up_short.csv"]
    up = campaign.runs[0]
    assert up.changes == {"sheave.mass": 120.0}
    assert np.allclose(up.values["cw_low"], 5e-3) and np.allclose(up.values["turning"], 5.0)
    assert up.trip.position(0.0) == pytest.approx(2.0, abs=1e-4) and up.trip.position(END) == pytest.approx(9.0, abs=1e-4)
    assert up.counterweight.position(0.0) == pytest.approx(12.0, abs=1e-4)
    assert 0.9 < up.trip.rest_before < 1.1  # s, where the fitted profile begins


def test_a_measured_counterweight_and_gaps_are_taken_as_they_are(folder):
    load = np.where(np.arange(0.0, END, SAMPLING) > 3.0, np.nan, 5.0)
    car = pd.read_csv(folder / "up.csv")["car_position"]
    table(folder, "up.csv", 2.0, 7.0, cw_low=load, counterweight_position=14.5 - car)
    up = load_campaign(folder).runs[0]
    assert np.isnan(up.values["cw_low"][-1]) and up.values["cw_low"][0] == pytest.approx(5e-3)
    assert up.counterweight.position(0.0) == pytest.approx(12.5, abs=1e-3)


def test_every_problem_of_every_file_is_told_at_once(folder):
    text = (folder / "campaign.toml").read_text()
    text = text.replace('unit = "rad/s"', 'unit = "furlong"').replace('sensor = "car_low"', 'sensor = "nowhere"', 1)
    (folder / "campaign.toml").write_text(text.replace('"sheave.mass" = 70.0', '"sheave.mas" = 70.0'))
    table(folder, "up.csv", 2.0, 7.0, cw_low=["x", *([5.0] * (round(END / SAMPLING) - 1))])
    table(folder, "up_short.csv", 4.0, 5.0, axle=None)
    lines = told(folder)
    wanted = [
        ("channels[2].sensor", '"nowhere"', "cw_low, car_low"),
        ("channels[4].unit", '"furlong"', "rad/s, deg/s, rpm"),
        ("up.csv", "cw_low = 'x' in row 2", "a number or an empty cell is accepted"),
        ("down_light.csv", "sheave.mas = 70.0", 'did you mean "mass"?'),
        ("up_short.csv", "no column axle", "the header has time, car_position, cw_low"),
    ]
    for key, value, accepted in wanted:
        assert any(key in line and value in line and accepted in line for line in lines), (key, lines)
    assert len(lines) == len(wanted)


BAD = [
    ("", ["name: missing", "model: missing", "channels: missing", "runs: missing"]),
    ('name = "x"\nmodel = "elevator.toml"\nruns = 3\n' + CHANNEL, ["runs = 3: "]),
    ('name = "x"\nmodel = "absent.toml"\n' + CHANNEL + RUN, ["absent.toml: cannot be read"]),
    ('name = "x"\nmodel = "elevator.toml"\ncolour = 1\n' + CHANNEL + RUN, ["colour = 1: unknown key"]),
    ('name = "x"\nmodel = "elevator.toml"\n' + CHANNEL + CHANNEL + RUN, ["column cw_low is described twice"]),
    (
        'name = "x"\nmodel = "elevator.toml"\n' + CHANNEL.replace("mm", "inch") + RUN,
        ['unit = "inch"', "m, cm, mm, um, in are accepted"],
    ),
    (
        'name = "x"\nmodel = "elevator.toml"\n' + CHANNEL + RUN.replace("fit", "test"),
        ['role = "test"', '"fit" or "validate" is accepted'],
    ),
    ('name = "x"\nmodel = "elevator.toml"\n' + CHANNEL + RUN.replace("fit", "validate"), ['at least one with role = "fit"']),
    ('name = "x"\nmodel = "elevator.toml"\n' + CHANNEL + "noise = -1.0\n" + RUN, ["channels[1].noise = -1.0"]),
    ('name = "x"\nmodel = "elevator.toml"\n' + CHANNEL + RUN.replace("up.csv", "absent.csv"), ["absent.csv: cannot be read"]),
]


@pytest.mark.parametrize(("text", "wanted"), BAD)
def test_what_campaign_toml_may_not_say(folder, text, wanted):
    (folder / "campaign.toml").write_text(text)
    lines = told(folder)
    for one in wanted:
        assert any(one in line for line in lines), lines


@pytest.mark.parametrize(
    ("columns", "wanted"),
    [
        ({"time": np.zeros(round(END / SAMPLING))}, "must be later than the row before"),
        ({"car_position": np.linspace(2.0, 9.0, round(END / SAMPLING)).round()}, "position: changes in steps of 1 m"),
        ({"car_position": np.full(round(END / SAMPLING), np.nan)}, "at least 20 are needed"),
    ],
)
def test_a_run_that_cannot_be_driven_is_refused(folder, columns, wanted):
    table(folder, "up.csv", 2.0, 7.0, **columns)
    (line,) = told(folder)
    assert "up.csv" in line and wanted in line


def test_no_campaign_at_all(tmp_path):
    (line,) = told(tmp_path / "nowhere")
    assert "nowhere" in line and "cannot be read" in line


def test_a_run_may_have_units_and_signs_of_its_own(folder):
    usual = load_campaign(folder).runs[0]
    table(folder, "up.csv", 2.0, 7.0, cw_low=np.full(len(np.arange(0.0, END, SAMPLING)), -0.7))
    path = folder / "campaign.toml"
    own = 'file = "up.csv"\nreadings = { cw_low = { unit = "cm", sign = -1, zero = -0.2 } }'
    path.write_text(path.read_text().replace('file = "up.csv"', own))
    found = load_campaign(folder)
    assert np.allclose(found.runs[0].values["cw_low"], usual.values["cw_low"])  # -1 * (-0.7 + 0.2) cm, 5 mm
    assert np.allclose(found.runs[1].values["cw_low"], 5e-3)  # the others are read as before
    assert found.channels["cw_low"].unit == "mm"


def test_names_in_a_run_that_stand_for_nothing_are_refused(folder):
    path = folder / "campaign.toml"
    own = (
        'file = "up.csv"\nfiles = { cw_lwo = "laser.csv", cw_low = "up.csv" }\noffsets = { "lasers.csv" = 0.3 }\n'
        'readings = { axle = { unit = "rpm" } }'
    )
    path.write_text(path.read_text().replace('file = "up.csv"', own))
    lines = [line.split("campaign.toml: ")[1] for line in told(folder)]
    assert lines == [
        'runs[1].files."cw_lwo": no channel of the run; did you mean "cw_low"?',
        'runs[1].offsets."lasers.csv": no other file of the run; did you mean "laser.csv"?',
        'runs[1].readings."axle".unit = "rpm": for sheave_displacement m, cm, mm, um, in are accepted',
    ]
