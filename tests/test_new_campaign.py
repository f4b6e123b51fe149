"""`comprope new`: raw logger files become a campaign that can be read, and nothing is replaced."""

import json
import os
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import comprope_system
from comprope.errors import InputError
from comprope.rope.model_file import dump
from comprope_system.cli import main
from comprope_system.measurements.campaign_file import read_campaign_file
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited

from .virtual_elevator import END, MODEL, PHASES, SAMPLING

TIME = np.arange(0.0, END, SAMPLING)


def raw(start: float, way: float, seed: int) -> pd.DataFrame:
    """A run as a logger might have written it, with names of its own and the sheave turning the other way round."""
    random = np.random.default_rng(seed)
    trip = jerk_limited(start, way, 1.0, PHASES)
    noise = random.standard_normal((5, len(TIME)))
    swinging = 10.0 * np.sin(2.0 * TIME) * (TIME > 1.0)
    return pd.DataFrame({
        "Zeit [ms]": 1e3 * TIME, "Kabinenposition [mm]": 1e3 * (trip.value(TIME) + 5e-4 * noise[0]),
        "Laser GG unten [mm]": swinging + 0.3 * noise[1], "Laser Kabine [mm]": swinging + 0.3 * noise[2],
        "Scheibe Weg (mm)": 0.1 * swinging + 0.05 * noise[3],
        "Drehzahl [U/min]": -trip.derivative(TIME, 1) / MODEL.sheave.radius * 30.0 / np.pi + 0.1 * noise[4],
        "Temperatur [°C]": 21.0 + 0.01 * noise[4], "Status": "OK",
    })  # fmt: skip


@pytest.fixture
def files(tmp_path):
    """Two raw files, one with semicolons and decimal commas in Latin-1, and a model."""
    folder = tmp_path / "raw"
    folder.mkdir()
    raw(2.0, 9.0, 1).to_csv(folder / "up.csv", index=False, float_format="%.4f")
    raw(11.0, -5.0, 2).to_csv(folder / "down.csv", index=False, sep=";", decimal=",", encoding="latin-1", float_format="%.4f")
    dump(MODEL, folder / "elevator.toml")
    return [folder / "up.csv", folder / "down.csv"]


def test_raw_files_become_a_campaign_that_can_be_read(tmp_path, files, capsys):
    folder = tmp_path / "campaign"
    with pytest.raises(SystemExit) as ended:
        main(["new", str(folder), *map(str, files), "--model", str(files[0].parent / "elevator.toml"), "--yes",
              "--json", str(tmp_path / "new.json")])  # fmt: skip
    assert ended.value.code == 0, capsys.readouterr().err
    written = read_campaign_file(folder / "campaign.toml")
    found = {one.column: (one.quantity, one.sensor, one.unit, one.sign) for one in written.channels}
    assert found == {
        "Laser GG unten [mm]": ("lateral_displacement", "cw_low", "mm", 1),
        "Laser Kabine [mm]": ("lateral_displacement", "car_low", "mm", 1),
        "Scheibe Weg (mm)": ("sheave_displacement", None, "mm", 1),
        "Drehzahl [U/min]": ("sheave_angular_velocity", None, "rpm", -1),
    }
    assert written.channels[0].noise == pytest.approx(0.3, rel=0.3)
    assert {one.file: one.role for one in written.runs} == {"up.csv": "fit", "down.csv": "validate"}
    assert sorted(one.name for one in folder.iterdir()) == ["campaign.toml", "down.csv", "elevator.toml", "up.csv"]
    run = comprope_system.check(folder).runs[1].run
    assert run.trip.position(END) == pytest.approx(6.0, abs=0.01)
    assert np.corrcoef(run.values["Drehzahl [U/min]"], run.trip.velocity(run.time))[0, 1] > 0.99
    told = json.loads((tmp_path / "new.json").read_text())
    assert any("the sheave of the model, 120 kg, is taken in every run" in one for one in told["remarks"])
    assert {key: told["columns"][-1][key] for key in ("column", "quantity")} == {"column": "Temperatur [°C]", "quantity": None}


def test_nothing_is_replaced(tmp_path, files):
    folder = tmp_path / "campaign"
    comprope_system.new(folder, files, model=MODEL)
    before = {path: path.read_bytes() for path in folder.iterdir()}
    with pytest.raises(InputError, match="exists and is not replaced"):
        comprope_system.new(folder, files, model=MODEL)
    (folder / "campaign.toml").unlink()
    (folder / "up.csv").write_text("other")
    with pytest.raises(InputError, match="exists"):
        comprope_system.new(folder, files, model=files[0].parent / "elevator.toml")
    assert (folder / "up.csv").read_text() == "other" and before


def test_a_column_that_was_guessed_is_asked_for_and_others_are_not(tmp_path, files):
    table = pd.read_csv(files[0]).rename(columns={"Laser Kabine [mm]": "ch7", "Kabinenposition [mm]": "ch1"})
    table["ch1"] *= 1e-3
    table.to_csv(files[0], index=False)
    asked = []
    answers = iter(["lateral_displacement car_low mm", "70", "5.1"])

    def ask(question: str, default: str) -> str:
        asked.append((question.splitlines()[-1].split(":")[0], default))
        return next(answers)

    result = comprope_system.new(tmp_path / "campaign", files[:1], model=MODEL, ask=ask)
    assert asked == [("ch7", "-"), ("up.csv", "120"), ("up.csv", f"{MODEL.sheave.inertia * 70.0 / 120.0:g}")]
    written = read_campaign_file(tmp_path / "campaign" / "campaign.toml")
    assert written.car.column == "ch1" and written.runs[0].set == {"sheave.mass": 70.0, "sheave.inertia": 5.1}
    assert any(one.column == "ch7" and one.sensor == "car_low" for one in written.channels)
    assert result.check.problems == ()


def test_files_that_name_their_columns_otherwise_are_one_campaign(tmp_path, files):
    table = pd.read_csv(files[0])
    names = {"Laser GG unten [mm]": "cw_low", "Laser Kabine [mm]": "Rope at the car (mm)", "Scheibe Weg (mm)": "sheave_dx"}
    table.rename(columns=names).to_csv(files[0], index=False)
    result = comprope_system.new(tmp_path / "campaign", files, model=MODEL)
    assert result.check.problems == ()
    written = read_campaign_file(tmp_path / "campaign" / "campaign.toml")
    assert sorted(one.column for one in written.channels if one.sensor) == ["Laser GG unten [mm]", "Rope at the car (mm)"]
    up, down = written.runs
    assert up.columns == {"Laser GG unten [mm]": "cw_low", "Scheibe Weg (mm)": "sheave_dx"}
    assert down.columns == {"Rope at the car (mm)": "Laser Kabine [mm]"}
    other = {one["column"]: one["same_as"] for one in result.to_json()["columns"]}
    assert other["Laser Kabine [mm]"] == "Rope at the car (mm)" and other["Scheibe Weg (mm)"] is None


def test_a_guess_is_left_out_unless_somebody_is_asked(tmp_path, files):
    table = pd.read_csv(files[0])
    table.assign(pit_load=1177.0 + 0.1 * np.sin(table["Zeit [ms]"])).to_csv(files[0], index=False)
    found = comprope_system.new(tmp_path / "a", files[:1], model=MODEL).columns["pit_load"]
    assert (found.quantity, found.certainty) == (None, "guess") and "perhaps sheave_force [N]" in found.why
    asked = comprope_system.new(tmp_path / "b", files[:1], model=MODEL, ask=lambda question, default: default)
    assert asked.columns["pit_load"].quantity == "sheave_force"


def test_units_that_no_file_states_are_said_with_the_size_of_the_motion(tmp_path, files):
    names = {"Laser GG unten [mm]": "cw_low", "Laser Kabine [mm]": "car_low"}
    table = pd.read_csv(files[0]).rename(columns=names)
    table.assign(cw_low=0.1 * table["cw_low"]).to_csv(files[0], index=False)
    result = comprope_system.new(tmp_path / "campaign", files[:1], model=MODEL)
    assert any("no file states a unit" in one and "cw_low moves by 1" in one for one in result.remarks), result.remarks
    assert any('cw_low: noise and motion are about 0.1 times' in one and 'unit = "cm"' in one for one in result.check.remarks)


def test_a_second_column_in_the_same_file_is_not_taken_for_the_first(tmp_path, files):
    table = pd.read_csv(files[0])
    table.assign(cw_low=table["Laser GG unten [mm]"]).to_csv(files[0], index=False)
    found = comprope_system.new(tmp_path / "campaign", files[:1], model=MODEL).columns["cw_low"]
    assert (found.quantity, found.same_as, found.certainty) == (None, None, "guess")


def test_an_answer_that_is_not_accepted_is_asked_for_again(tmp_path, files):
    answers, asked = iter(["heavy", "-3", "120"]), []

    def ask(question: str, default: str) -> str:
        asked.append(question)
        return next(answers)

    comprope_system.new(tmp_path / "campaign", files[:1], model=MODEL, ask=ask)
    assert len(asked) == 3
    assert "sheave.mass = heavy: a number from 0.1 to 20000 [kg] is accepted" in asked[1].splitlines()[0]
    assert "sheave.mass = -3" in asked[2].splitlines()[0] and asked[2].splitlines()[1:] == asked[0].splitlines()


def test_an_answer_that_is_none_and_files_that_are_none_are_refused(tmp_path, files):
    with pytest.raises(InputError, match="no files"):
        comprope_system.new(tmp_path / "a", [])
    with pytest.raises(InputError, match="a pipe or device"):
        comprope_system.new(tmp_path / "a", [Path("/dev/zero")])
    assert not (tmp_path / "a").exists()
    files[0].write_text("a,b\n1,2\n2,3\n")
    with pytest.raises(InputError, match="which column is the position of the car"):
        comprope_system.new(tmp_path / "b", files[:1], model=MODEL)
    with pytest.raises(InputError, match=r"sheave\.mass = heavy: a number from 0\.1"):
        comprope_system.new(tmp_path / "c", files[1:], model=MODEL, ask=lambda question, default: "heavy")
    assert not (tmp_path / "c" / "campaign.toml").exists()


def split(files, folder, shift=0.0, stamped=False) -> list[Path]:
    """Each run in two files: the drive's, and one of the lasers at another rate, in other units."""
    written = []
    for k, (file, sep, decimal) in enumerate(((files[0], ",", "."), (files[1], ";", ","))):
        table = pd.read_csv(file, sep=sep, decimal=decimal, encoding="latin-1" if k else "utf-8")
        time = table["Zeit [ms]"] * 1e-3 + shift
        if stamped:
            time = (pd.Timestamp("2026-11-02 09:00") + pd.Timedelta(hours=k) + pd.to_timedelta(time, unit="s")).astype(str)
        lasers = [name for name in table.columns if name.startswith("Laser")]
        drive = table.drop(columns=lasers).assign(time=time).drop(columns="Zeit [ms]")
        laser = table[lasers].rename(columns=lambda name: name.replace("[mm]", "[cm]")) * 0.1 if k else table[lasers]
        drive.to_csv(folder / f"run{k}_drive.csv", index=False)
        laser.assign(time=time)[1::2].to_csv(folder / f"run{k}_laser.csv", index=False)
        written += [folder / f"run{k}_drive.csv", folder / f"run{k}_laser.csv"]
    return written


@pytest.mark.parametrize("stamped", [False, True])
def test_files_without_the_car_are_part_of_the_run_that_their_names_or_dates_tell(tmp_path, files, stamped):
    parts = split(files, files[0].parent, stamped=stamped)
    result = comprope_system.new(tmp_path / "campaign", parts, model=MODEL)
    assert result.check.problems == ()
    told = "likely: by date and time" if stamped else "likely: by its name"
    assert result.to_json()["runs"][1]["with"] == {"run1_laser.csv": told}
    assert f"run0_drive.csv: fit, with run0_laser.csv ({told})" in result.summary()
    written = read_campaign_file(tmp_path / "campaign" / "campaign.toml")
    first, second = written.runs
    assert first.files == dict.fromkeys(("Laser GG unten [mm]", "Laser Kabine [mm]"), "run0_laser.csv")
    assert {key: one.unit for key, one in second.readings.items()} == dict.fromkeys(first.files, "cm")
    assert written.channels[-1].noise == pytest.approx(0.3, rel=0.3)
    for k, run in enumerate(one.run for one in result.check.runs):
        laser = run.values["Laser GG unten [mm]"]
        truth = raw(*((2.0, 9.0, 1) if k == 0 else (11.0, -5.0, 2)))["Laser GG unten [mm]"]
        assert np.allclose(laser[np.isfinite(laser)], 1e-3 * truth[1::2], atol=1e-5)


def test_files_may_be_stated_together_and_a_file_of_no_run_is_refused(tmp_path, files):
    parts = split(files, files[0].parent)
    other = [one.rename(one.with_name(f"{name}.csv")) for one, name in zip(parts, ("a", "x", "b", "y"), strict=True)]
    with pytest.raises(InputError, match=r"x.csv: holds no motion of the car, .* RUN\+x.csv with one of a.csv, b.csv"):
        comprope_system.new(tmp_path / "campaign", other, model=MODEL)
    stated = [f"{other[1]}+{other[0]}", f"{other[2]}+{other[3]}"]
    result = comprope_system.new(tmp_path / "campaign", stated, model=MODEL)
    assert result.check.problems == () and result.parts["a.csv"] == {"x.csv": "sure: as stated"}


def test_a_channel_named_value_is_named_by_its_file(tmp_path, files):
    table = raw(2.0, 9.0, 1)
    folder = files[0].parent
    table[["Zeit [ms]", "Kabinenposition [mm]"]].to_csv(folder / "up_drive.csv", index=False)
    for name, column in (("cw_low", "Laser GG unten [mm]"), ("car_low", "Laser Kabine [mm]")):
        table[["Zeit [ms]", column]].rename(columns={column: "Value [mm]"}).to_csv(folder / f"up_laser_{name}.csv", index=False)
    result = comprope_system.new(tmp_path / "campaign", sorted(folder.glob("up_*.csv")), model=MODEL)
    assert result.check.problems == ()
    written = read_campaign_file(tmp_path / "campaign" / "campaign.toml")
    assert {one.sensor: written.runs[0].files[one.column] for one in written.channels} == {
        "cw_low": "up_laser_cw_low.csv", "car_low": "up_laser_car_low.csv"}  # fmt: skip
    assert set(written.runs[0].columns.values()) == {"Value [mm]"}
    run = result.check.runs[0].run
    assert np.allclose(run.values[written.channels[0].column], 1e-3 * table["Laser Kabine [mm]"])


def test_a_counterweight_alone_gives_the_motion_of_the_car(tmp_path, files):
    for file, sep, decimal, encoding in ((files[0], ",", ".", "utf-8"), (files[1], ";", ",", "latin-1")):
        table = pd.read_csv(file, sep=sep, decimal=decimal, encoding=encoding)
        position = 1e3 * MODEL.shaft.height - table["Kabinenposition [mm]"]
        table.drop(columns="Kabinenposition [mm]").assign(**{"Gegengewicht_Position [mm]": position}).to_csv(file, index=False)
    result = comprope_system.new(tmp_path / "campaign", files, model=MODEL)
    assert result.check.problems == ()
    written = read_campaign_file(tmp_path / "campaign" / "campaign.toml")
    assert written.car.column is None and written.counterweight.column == "Gegengewicht_Position [mm]"
    assert next(one.sign for one in written.channels if one.quantity == "sheave_angular_velocity") == -1
    assert result.check.runs[0].run.trip.position(END) == pytest.approx(11.0, abs=0.01)


def test_a_channel_that_one_run_does_not_have_is_left_out_of_it(tmp_path, files):
    pd.read_csv(files[0]).drop(columns="Scheibe Weg (mm)").to_csv(files[0], index=False)
    result = comprope_system.new(tmp_path / "campaign", files, model=MODEL)
    assert result.check.problems == () and "up.csv: Scheibe Weg (mm): not measured in this run" in result.check.remarks
    written = read_campaign_file(tmp_path / "campaign" / "campaign.toml")
    assert written.runs[0].columns == {"Scheibe Weg (mm)": ""} and written.runs[1].columns == {}
    assert np.isnan(result.check.runs[0].run.values["Scheibe Weg (mm)"]).all()


def test_columns_that_differ_in_separators_only_are_two_where_one_file_has_both(tmp_path, files):
    table = pd.read_csv(files[0])
    table.assign(laser_kabine=table["Laser GG unten [mm]"]).to_csv(files[0], index=False)
    result = comprope_system.new(tmp_path / "campaign", files[:1], model=MODEL)
    assert {"laser_kabine", "Laser Kabine [mm]"} <= set(result.columns)


def test_where_a_car_starts_is_asked_if_no_column_gives_a_height(tmp_path, files):
    table = pd.read_csv(files[0])
    speed = 1e-3 * np.gradient(table["Kabinenposition [mm]"].rolling(9, min_periods=1).mean(), SAMPLING)
    table.drop(columns="Kabinenposition [mm]").assign(car_speed=speed).to_csv(files[0], index=False)
    answers = {"up.csv: height of the car": ["70", "2.0"], "up.csv: mass": ["120"]}

    def ask(question: str, default: str) -> str:
        key = next((key for key in answers if question.splitlines()[-1].startswith(key)), None)
        return answers[key].pop(0) if key else default

    result = comprope_system.new(tmp_path / "campaign", files[:1], model=MODEL, ask=ask)
    assert result.check.problems == () and not any(answers.values())
    assert result.check.runs[0].run.trip.position(0.0) == pytest.approx(2.0, abs=0.05)


def test_runs_that_all_begin_at_the_bottom_landing_are_remarked_on(tmp_path):
    for name, way in (("up.csv", 9.0), ("up_short.csv", 5.0)):
        raw(0.0, way, 1).to_csv(tmp_path / name, index=False)
    result = comprope_system.new(tmp_path / "campaign", [tmp_path / "up.csv", tmp_path / "up_short.csv"], model=MODEL)
    assert sum("begins at the bottom landing, as every run does" in one for one in result.check.remarks) == 2


def test_files_named_twice_or_with_names_that_cannot_be_shown_are_refused(tmp_path, files):
    with pytest.raises(InputError, match=r"up.csv: named twice"):
        comprope_system.new(tmp_path / "campaign", [files[0], files[0]], model=MODEL)
    for name in (b"b\xffd.csv", b"new\nline.csv"):
        odd = Path(os.fsdecode(bytes(files[0].parent) + b"/" + name))
        shutil.copy(files[0], odd)
        with pytest.raises(InputError, match="rename the file") as error:
            comprope_system.new(tmp_path / "campaign", [odd], model=MODEL)
        assert str(error.value).isprintable() and not (tmp_path / "campaign" / "campaign.toml").exists()


def test_columns_that_nearly_hold_numbers_and_swapped_ones_are_left_out_with_a_reason(tmp_path, files):
    table = pd.read_csv(files[0])
    table["Laser Kabine [mm]"] = [f"{one} mm" for one in table["Laser Kabine [mm]"]]
    table["Scheibe Weg (mm)"] = 10.0 * table["Drehzahl [U/min]"]
    table.assign(datum="02.11.2026").to_csv(files[0], index=False)
    result = comprope_system.new(tmp_path / "campaign", files[:1], model=MODEL)
    unread = [one for one in result.remarks if "left out" in one]
    assert len(unread) == 1 and "up.csv: Laser Kabine [mm]: left out, because cells such as" in unread[0]
    assert result.columns["Scheibe Weg (mm)"].quantity is None
    assert "it follows the car's speed as no displacement does" in result.columns["Scheibe Weg (mm)"].why


def test_a_car_that_counts_downward_is_written_so_and_the_sheave_is_not_turned(tmp_path):
    table, height = raw(3.7, 10.0, 1), MODEL.shaft.height
    car = 1e-3 * table["Kabinenposition [mm]"]
    low = next(one.height for one in MODEL.sensors if one.name == "cw_low")
    table["Laser GG unten [mm]"] = table["Laser GG unten [mm]"].where(height - car > low)
    table["Kabinenposition [mm]"] = 1e3 * (height - car)
    table["Drehzahl [U/min]"] *= -1.0
    table.to_csv(tmp_path / "up.csv", index=False)
    result = comprope_system.new(tmp_path / "campaign", [tmp_path / "up.csv"], model=MODEL)
    written = read_campaign_file(tmp_path / "campaign" / "campaign.toml")
    assert (written.car.sign, written.car.zero) == (-1, 1e3 * height)  # in the unit of the column
    assert result.columns["Drehzahl [U/min]"].sign == 1
    assert any("counts downward" in one for one in result.remarks)
    assert result.check.runs[0].run.trip.position(END) == pytest.approx(13.7, abs=0.01)


def test_the_kind_of_motion_is_written_where_it_is_no_position(tmp_path, files):
    table = pd.read_csv(files[0])
    speed = 1e-3 * np.gradient(table["Kabinenposition [mm]"].rolling(9, min_periods=1).mean(), SAMPLING)
    table.drop(columns="Kabinenposition [mm]").assign(car_speed=speed).to_csv(files[0], index=False)
    result = comprope_system.new(tmp_path / "campaign", files[:1], model=MODEL)
    assert read_campaign_file(result.path).car.quantity == "speed"
    assert "gives no height: write car_start" in str(result.check.problems)
    text = result.path.read_text("utf-8").replace('quantity = "speed"\n', "")  # as somebody writes it who states the column only
    result.path.write_text(text, "utf-8")
    assert "gives no height: write car_start" in str(comprope_system.check(result.path).problems)


def test_a_column_that_cannot_be_read_is_refused_for_its_own_problem(tmp_path, files):
    pd.read_csv(files[0]).rename(columns={"Zeit [ms]": "Zeit"}).assign(Zeit=1e4 * TIME).to_csv(files[0], index=False)
    with pytest.raises(InputError, match="write time_unit under"):
        comprope_system.new(tmp_path / "campaign", files[:1], model=MODEL)
