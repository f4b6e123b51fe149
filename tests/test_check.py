"""`comprope check`: every fault of a campaign's files, told without a simulation."""

import io
import json
import shutil

import numpy as np
import pandas as pd
import pytest

import comprope_system
from comprope.errors import InputError
from comprope.rope.model_file import dump, with_changes
from comprope_system.cli import main
from comprope_system.identification.comparison.nrmse import channel_error, moves
from comprope_system.identification.data.campaign import load_campaign
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited
from comprope_system.report.plot_style import label, legend, panels, plain

from .virtual_elevator import END, MODEL, PHASES, SAMPLING, description

TIME = np.arange(0.0, END, SAMPLING)
TRIP = jerk_limited(2.0, 9.0, 1.0, PHASES)


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """A campaign of one run whose lasers see the rope where its ends let them, without vibration but with noise."""
    folder = tmp_path_factory.mktemp("sound")
    dump(MODEL, folder / "elevator.toml")
    table().to_csv(folder / "up.csv", index=False, float_format="%.5f")
    text = description()
    (folder / "campaign.toml").write_text(text[: text.index('[[runs]]\nfile = "down')])
    return folder


def table() -> pd.DataFrame:
    random = np.random.default_rng(3)
    car = TRIP.value(TIME)
    noise = random.standard_normal((5, len(TIME)))
    swinging = 10.0 * np.sin(2.0 * TIME) * (TIME > 1.0)
    return pd.DataFrame({
        "time": TIME, "car_position": car + 5e-4 * noise[0],
        "cw_low": np.where(14.0 - car > 6.0, swinging + 0.3 * noise[1], np.nan),
        "car_low": swinging + 0.3 * noise[2],
        "axle": 0.1 * swinging + 0.05 * noise[3],
        "turning": TRIP.derivative(TIME, 1) / MODEL.sheave.radius + 0.01 * noise[4],
    })  # fmt: skip


@pytest.fixture
def campaign(sound, tmp_path):
    """A copy of the sound campaign to spoil; its laser on the counterweight's side is 6 m high, where the end passes it."""
    shutil.copytree(sound, tmp_path / "campaign")
    dump(MODEL.model_copy(update={"sensors": (MODEL.sensors[0].model_copy(update={"height": 6.0}), MODEL.sensors[1])}),
         tmp_path / "campaign" / "elevator.toml")  # fmt: skip
    return tmp_path / "campaign"


def spoil(campaign, **columns):
    """Write the run with other columns, each a function of the sound one."""
    spoilt = table()
    for name, change in columns.items():
        spoilt[name] = change(spoilt[name].to_numpy(copy=True))
    spoilt.to_csv(campaign / "up.csv", index=False, float_format="%.5f")
    return comprope_system.check(campaign)


def test_a_sound_campaign_has_nothing_to_remark(campaign, capsys):
    result = comprope_system.check(campaign)
    assert result.problems == () and result.remarks == ()
    with pytest.raises(SystemExit) as ended:
        main(["check", str(campaign), "--json", str(campaign / "check.json"), "--report", str(campaign / "check.html")])
    assert ended.value.code == 0 and "nothing to remark" in capsys.readouterr().out
    found = json.loads((campaign / "check.json").read_text())
    assert found["runs"] == [{"file": "up.csv", "problems": [], "remarks": []}]
    assert "can be used" in (campaign / "check.html").read_text("utf-8")


def _part(change, start=100, stop=130):
    def changed(values):
        values[start:stop] = change(values[start:stop]) if callable(change) else change
        return values

    return changed


REMARKS = [
    ({"car_low": lambda v: 0.0 * v + 3.0}, "car_low: flat, 3 in every sample"),
    ({"car_low": lambda v: np.nan * v}, "car_low: no values in this run"),
    ({"car_low": lambda v: np.where(TIME < 1.5, np.nan, v)}, "car_low shows nothing before the trip"),
    ({"car_low": lambda v: np.clip(v, -6.0, 6.0)}, "clipped at -6 and 6"),
    ({"car_low": _part(np.inf, 100, 101)}, "car_low: 1 sample is infinite"),
    ({"car_low": _part(-9999.0)}, "car_low: 30 samples are -9999"),
    ({"car_low": _part(0.0, 240, 270)}, "car_low: 30 samples are stuck at one value"),
    ({"car_low": lambda v: np.repeat(v[::5], 5)[: len(v)]}, "car_low: updated only every 5 samples"),
    ({"turning": lambda v: -v}, "turning: negative while the car goes up"),
    ({"turning": lambda v: v * 30.0 / np.pi}, 'its unit is probably "rpm"'),
    ({"turning": lambda v: np.interp(TIME - 0.3, TIME, v)}, "turning: 0.3 s later than the car's motion"),
    ({"turning": lambda v: table()["axle"].to_numpy(), "axle": lambda v: table()["turning"].to_numpy()}, "probably swapped"),
    ({"car_low": lambda v: 1e-3 * v}, "check its unit"),
    ({"car_low": lambda v: 0.1 * v}, 'about 0.1 times those of the other lasers: if it is in cm, write unit'),
    ({"cw_low": lambda v: table()["car_low"].to_numpy(), "car_low": lambda v: table()["cw_low"].to_numpy()},
     "car_low: does not see the rope where sensor car_low would, but where sensor cw_low would"),
]


@pytest.mark.parametrize("option", ["--json", "--report"])
def test_a_hyphen_is_no_name_of_an_output_file(campaign, capsys, monkeypatch, option):
    monkeypatch.chdir(campaign)
    with pytest.raises(SystemExit, match="2"):
        main(["check", str(campaign), option, "-"])
    assert len(capsys.readouterr().err.splitlines()) == 1 and not (campaign / "-").exists()


@pytest.mark.parametrize(("columns", "told"), REMARKS, ids=[told for _, told in REMARKS])
def test_a_fault_of_a_channel_is_told_and_its_samples_are_not_used(campaign, columns, told):
    result = spoil(campaign, **columns)
    assert result.problems == () and any(told in one for one in result.remarks), result.remarks


PROBLEMS = [
    ({"car_position": lambda v: 14.0 - v}, "car_position counts downward?"),
    ({"car_position": lambda v: v - 8.0}, "outside of the shaft"),
    ({"car_position": lambda v: v * 40.0}, "outside of the shaft"),
    ({"time": lambda v: v / 60.0}, "check the unit of the car"),
    ({"time": lambda v: np.where(v > 5.0, v - 4.0, v)}, "must be later than the row before"),
    ({"car_position": lambda v: np.full(len(v), np.nan)}, "at least 20 are needed"),
]


@pytest.mark.parametrize(("columns", "told"), PROBLEMS, ids=[told for _, told in PROBLEMS])
def test_a_run_whose_car_is_none_is_a_problem_with_what_to_do(campaign, capsys, columns, told):
    result = spoil(campaign, **columns)
    (problem,) = result.problems
    assert told in problem and "up.csv" in problem
    with pytest.raises(SystemExit) as ended:
        main(["check", str(campaign)])
    assert ended.value.code == 2 and "problem: " in capsys.readouterr().out


def test_a_run_in_millimetres_and_milliseconds_is_read_with_remarks(campaign):
    result = spoil(campaign, car_position=lambda v: 1e3 * v, time=lambda v: 1e3 * v)
    assert result.problems == () and len(result.remarks) == 2
    assert np.allclose(result.runs[0].run.car_position, table()["car_position"], atol=3e-3)
    assert np.allclose(result.runs[0].run.time, TIME, atol=1e-5)


def test_campaign_toml_states_what_the_files_do_not(campaign):
    text = (campaign / "campaign.toml").read_text()
    text = text.replace("[[channels]]", '[car]\nsign = -1\nzero = 14.0\n\n[file]\nmissing = [77]\n\n[[channels]]', 1)
    before, last, after = text.rpartition("[[channels]]")
    stated = after.replace("sign = 1", "sign = -1").replace("factor = 1.0", "scale = 0.5").replace("zero = 0.0", "zero = 1.0")
    (campaign / "campaign.toml").write_text(before + last + stated)
    result = spoil(campaign, car_position=lambda v: 14.0 - v, turning=lambda v: 1.0 - 2.0 * v, car_low=_part(77.0, 60, 63))
    assert result.problems == () and result.remarks == ()
    run = result.runs[0].run
    assert np.allclose(run.values["turning"], table()["turning"], atol=1e-4) and np.isnan(run.values["car_low"][60:63]).all()


def test_runs_that_do_not_begin_where_the_one_before_ended_are_told(campaign):
    text = (campaign / "campaign.toml").read_text()
    (campaign / "campaign.toml").write_text(f'{text}[[runs]]\nfile = "next.csv"\n')
    stamps = pd.Timestamp("2026-11-02 09:12:01") + pd.to_timedelta(TIME, unit="s")
    table().assign(time=stamps).to_csv(campaign / "up.csv", index=False)
    table().assign(time=stamps + pd.Timedelta(minutes=3)).to_csv(campaign / "next.csv", index=False)
    result = comprope_system.check(campaign)
    (remark,) = result.remarks
    assert "next.csv: begins at 2 m, but the run before it, up.csv, ended at 11 m" in remark


ODD_NAMES = ["cw low", "laser-1", "Laser 1 [mm]", "y (mm)", "$a_b^$ {c}", "effects.x.y", "Größe"]


@pytest.mark.parametrize("name", ODD_NAMES)
def test_a_channel_may_have_any_name(name):
    changed = with_changes(MODEL, {f"effects.sensor_gain.{name}": 1.25, f"effects.sensor_delay.{name}": 0.1})
    assert changed.effects.sensor_gain == {name: 1.25} and changed.effects.sensor_delay == {name: 0.1}
    figure, (axes,) = panels()
    axes.plot([0.0, 1.0], label=plain(name))
    label(axes, name, f"{name} [mm]", name)
    legend(axes)
    figure.savefig(io.BytesIO())


def test_the_error_of_a_channel_that_never_moves_is_not_defined():
    still, moving = np.full(50, 3e-3), np.linspace(0.0, 1e-3, 50)
    assert np.isnan(channel_error(still, moving, 1e-4)) and np.isfinite(channel_error(moving, still, 1e-4))
    assert not moves(still * 1e-3) and moves(moving) and not moves(np.array([]))


def test_a_campaign_without_any_value_is_refused(campaign):
    spoil(campaign, **{name: lambda v: np.nan * v for name in ("cw_low", "car_low", "axle", "turning")})
    with pytest.raises(InputError, match="no channel has values in a fit run"):
        load_campaign(campaign)
