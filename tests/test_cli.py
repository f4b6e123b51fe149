"""The command line: what it writes, what it says, and its exit status."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from comprope.errors import SimulationError
from comprope_system import cli, presets
from comprope_system.simulation.trips import workflow

# A coarse rope in a low shaft: seconds matter here, not millimetres.
QUICK = [
    *("--set", "rope.element_length=0.2", "--set", "solver.step=0.005", "--set", "shaft.height=12"),
    *("--from", "1", "--to", "2", "--step", "0.05", "--direct"),
]


def run(capsys, *arguments):
    """Exit status, standard output and standard error of a command."""
    with pytest.raises(SystemExit) as done:
        cli.main([str(one) for one in arguments])
    return done.value.code, *capsys.readouterr()


def test_a_trip_writes_its_files_and_sums_up(capsys, tmp_path):
    out, plot = tmp_path / "new" / "trip.csv", tmp_path / "trip.png"
    status, told, errors = run(capsys, "simulate", "tower50", *QUICK, "--time", "3", "--out", out, "--plot", plot)
    assert (status, errors) == (0, "")
    assert [line.split("  ")[0] for line in told.splitlines()][:3] == ["duration", "car", "peak at cw_low"]
    table = pd.read_csv(out)
    assert list(table)[:9] == [
        *("time", "car_position", "car_velocity", "car_acceleration", "counterweight_position"),
        *("cw_low", "cw_mid", "cw_high", "car_low"),
    ]
    assert np.allclose(table["time"], 0.05 * np.arange(61))
    assert plot.read_bytes().startswith(b"\x89PNG")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["new", "trip.png"]


def test_cells_are_empty_where_the_rope_has_passed_the_sensor(capsys, tmp_path):
    out = tmp_path / "trip.csv"
    options = ["--set", "sensors[2].height=10.5", "--set", "sensors[3].height=11.5"]  # the counterweight goes from 11 to 10 m
    assert run(capsys, "simulate", "tower50", *QUICK, *options, "--out", out)[0] == 0
    table = pd.read_csv(out)
    assert table["cw_high"].isna().all()
    assert table["cw_mid"].notna().iloc[0] and table["cw_mid"].isna().iloc[-1]
    seen = table["counterweight_position"] > 10.5
    assert (seen == table["cw_mid"].notna()).mean() > 0.95


def test_a_simulated_trip_can_be_driven_again(capsys, tmp_path):
    """What is written is a run too: recovered and simulated once more, the rope does the same."""
    first, second = tmp_path / "first.csv", tmp_path / "second.csv"
    fine = [*QUICK[:6], "--step", "0.01", "--direct"]
    assert run(capsys, "simulate", "tower50", *fine, "--from", 1, "--to", 2, "--out", first)[0] == 0
    status, _, errors = run(capsys, "simulate", "tower50", *fine, "--car", first, "--out", second, "--plot", tmp_path / "p.png")
    assert (status, errors) == (0, "")
    one, two = pd.read_csv(first), pd.read_csv(second)
    assert np.abs(one["car_position"] - two["car_position"]).max() < 1e-4
    assert np.abs(one["cw_low"] - two["cw_low"]).max() < 1e-4


def test_a_campaign_beside_the_run_tells_units_and_changes(tmp_path):
    from comprope_system.simulation.trips.measured_run import read_run

    time = np.arange(0.0, 12.0, 0.02)
    way = np.clip((time - 2.0) / 6.0, 0.0, 1.0)
    table = pd.DataFrame({"time": time, "car_position": 2.0 + way**3 * (10.0 - 15.0 * way + 6.0 * way**2), "laser": 5.0})
    table.to_csv(tmp_path / "up.csv", index=False)
    (tmp_path / "campaign.toml").write_text(
        'name = "x"\nmodel = "m.toml"\n'
        '[[channels]]\ncolumn = "laser"\nquantity = "lateral_displacement"\nsensor = "cw_low"\nunit = "mm"\nreference = "rest"\n'
        '[[runs]]\nfile = "up.csv"\nrole = "fit"\nset = { "sheave.mass" = 60.0 }\n'
    )
    measured = read_run(tmp_path / "up.csv", 50.0, ["cw_low"])
    assert measured.changes == {"sheave.mass": 60.0}
    assert measured.channels["cw_low"].from_rest
    assert np.allclose(measured.channels["cw_low"].value, 5e-3)


BAD = [
    (["nowhere"], "nowhere: neither a file nor a preset; accepted are building200, tower50, tower50_light"),
    (["tower5O"], 'tower5O: neither a file nor a preset; did you mean "tower50"?'),
    (["absent.toml"], "absent.toml: cannot be read: No such file or directory"),
    (["tower50", "--set", "sheave.mas=1"], '--set: sheave.mas = 1: unknown key; did you mean "mass"?'),
    (["tower50", "--set", "sheave.mass"], "--set sheave.mass: KEY=VALUE is accepted"),
    (["tower50", "--set", "servo.x=1"], "drive: servo.x = 1: unknown key; accepted are position_bandwidth"),
    (["tower50", "--speed", "-1"], "drive: profile.speed = -1.0: a number from 0.01 to 25 m/s is accepted"),
    (["tower50", "--to", "60"], "drive: trip.destination = 60 m: accepted is 0 to shaft.height = 50 m"),
    (["tower50", "--drive", "absent.toml"], "absent.toml: cannot be read"),
    (["tower50", "--car", "absent.csv"], "absent.csv: cannot be read"),
    (["tower50", "--step", "0"], "communication step = 0 s: above 0"),
    (["tower50", "--step", "nan"], "communication step = nan s: above 0"),
    (["tower50", "--time", "-1"], "duration = -1 s: a number above 0 is accepted"),
    (["tower50", "--plot", "a.gif"], "a.gif: a name that ends in .png, .pdf, .svg is accepted for a picture"),
    (["tower50", "--report", "a.pdf"], "a.pdf: a name that ends in .html, .htm is accepted for a page"),
    (["tower50", "--out", "."], ".: is a folder; give the name of a file"),
    (["tower50", "--speed", "fast"], "Invalid value for '--speed'"),
    (["tower50", "--nonsense"], "No such option"),
    ([], "Missing argument 'MODEL.toml'"),
]


@pytest.mark.parametrize(("arguments", "told"), BAD)
def test_bad_input_is_one_line_and_status_2(capsys, tmp_path, monkeypatch, arguments, told):
    monkeypatch.chdir(tmp_path)
    status, out, errors = run(capsys, "simulate", *arguments)
    assert (status, out) == (2, "")
    assert errors.startswith(told) and errors.count("\n") == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "not a CSV table"),
        ("time,position\n0,1\n", "no column car_position; the header has time, position"),
        ("time,car_position\n0,1\n1,x\n", "car_position = 'x' in row 3: a number or an empty cell is accepted"),
        ("time,car_position\n0,1\n1,1\n", "position: 2 numbers; at least 20"),
    ],
)
def test_a_run_that_is_none_is_refused(capsys, tmp_path, text, told):
    file = tmp_path / "run.csv"
    file.write_text(text)
    status, _, errors = run(capsys, "simulate", "tower50", "--car", file)
    assert status == 2 and told in errors and errors.startswith(f"{file}: ") and errors.count("\n") == 1


def test_what_fails_on_the_way_is_status_1_and_leaves_no_file(capsys, tmp_path, monkeypatch):
    for error, told in ((SimulationError("lost"), "lost\n"), (ZeroDivisionError("x"), "internal error: ZeroDivisionError: x\n")):

        def fail(*_, error=error):
            raise error

        monkeypatch.setattr(workflow, "simulate_trip", fail)
        status, _, errors = run(capsys, "simulate", "tower50", *QUICK, "--out", tmp_path / "trip.csv")
        assert (status, errors) == (1, told)
        assert not list(tmp_path.iterdir())


def test_a_command_that_fails_leaves_no_folder(capsys, tmp_path):
    new, taken = tmp_path / "new" / "results", tmp_path / "file"
    taken.write_text("")
    assert run(capsys, "tune", "tower50", "--times", "0.1", "--out", new)[0] == 2
    status, _, errors = run(capsys, "tune", "tower50", "--out", taken / "results")
    assert (status, errors) == (2, f"{taken / 'results' / 'tuning.html'}: its folder cannot be created: {taken} is a file\n")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_help_names_commands_and_presets(capsys):
    status, told, _ = run(capsys)
    assert status == 0 and "simulate" in told
    assert all(name in " ".join(told.split()) for name in presets.names())


def test_every_preset_has_a_drive_file():
    from comprope_system.presets.inputs import load_drive

    for name in presets.names():
        assert load_drive(presets.drive_path(name)).profile.speed > 0.0


def test_the_module_runs_as_a_command():
    command = [sys.executable, "-m", "comprope_system.cli", "simulate", "nowhere"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("nowhere: ") and "Traceback" not in done.stderr


def test_readme_commands_use_options_that_exist(capsys):
    """Options named in the README are those of the command."""
    text = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")
    _, told, _ = run(capsys, "simulate", "--help")
    used = {word for line in text.splitlines() if "comprope simulate" in line for word in re.findall(r"--\w[\w-]*", line)}
    assert used and all(word in told for word in used)
