"""Files as loggers write them: each is read as the plain one, refused, or read with a remark; none is silently wrong."""

import gzip
import os
import sys
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import pytest
import scipy.io

from comprope.errors import InputError
from comprope_system.cli import main
from comprope_system.measurements.campaign_file import CampaignFile, Channel, RunSpec, read_campaign_file
from comprope_system.measurements.files import RawTable, read_raw_table
from comprope_system.measurements.files.file_format import FileFormat
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited
from comprope_system.measurements.runs.run_table import read_run_table
from comprope_system.measurements.units import is_unit, split_unit, unit_named

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from raw_log_variants import FURTHER, LOGGERS, READING, Variant, blind_and_broken, stated_wrongly

HEIGHT = 50.0  # m
LASERS = ("cw_low", "cw_mid", "car_low")
CHANNELS = (
    *(Channel(column=name, quantity="lateral_displacement", sensor=name, unit="mm", reference="rest") for name in LASERS),
    Channel(column="sheave_dx", quantity="sheave_displacement", unit="mm", reference="rest"),
    Channel(column="sheave_w", quantity="sheave_angular_velocity", unit="rad/s"),
)


def plain() -> pd.DataFrame:
    """A run of 33 s at 25 Hz as a plain table, one laser blind at the end."""
    time = np.round(np.arange(826) * 0.04, 2)
    trip = jerk_limited(0.0, 45.0, 5.0, np.array([1.0, 2.0, 1.0, 14.0, 1.0, 2.0, 1.0]))
    random = np.random.default_rng(5)
    car = trip.value(time) + 5e-4 * random.standard_normal(826)
    table = pd.DataFrame({"time": time, "car_position": car})
    for k, name in enumerate((*LASERS, "sheave_dx")):
        table[name] = 10.0 * np.sin((1.0 + k) * time) * np.clip(time - 5.0, 0.0, 1.0) + 0.2 * random.standard_normal(826)
    table["cw_mid"] = table["cw_mid"].where(car < 40.0)
    return table.assign(sheave_w=trip.derivative(time, 1) / 0.4).round(4)


PLAIN = plain()

VARIANTS = [one for group in (*READING, *FURTHER, *LOGGERS) for one in group(PLAIN)]
RIGHT = {"semicolon, decimal point", "tab, decimal comma", "quoted decimal commas between commas", "CR", "footer of statistics",
         "header in a comment", "header and units repeated", "thousands separated", "encoding utf-16-le", "encoding latin-1",
         "time: ms in brackets", "time: over midnight", "time: days of Excel", "time: comma before milliseconds, between commas",
         "time: epoch in ns", "time: sample numbers, rate above", "car in ft, stated", "MATLAB structure", "HDF5 compound",
         "MATLAB 7.3", "TDMS waveforms", "Parquet with time stamps", "Excel with dates",
         "blanks, in names too",
         "a constant column named time", "LabVIEW, times beside each channel", "LabVIEW without times",
         "Parquet with a time zone",
         "MATLAB structure of Simulink", "HDF5 with a time in each group",
         "three decimals after a comma, semicolons", "thousands points and decimal commas", "Swiss thousands",
         "car and channels in turn", "page breaks", "names with commas, quoted", "names that differ in case only",
         "time: milliseconds in a column of their own", "time: digits of date and time",
         "time: digits of the time of day, over a minute", "time: cycle time of a controller beside it",
         "time: time to landing beside it", "time: door time beside it", "time: rate in kS/s above",
         "time: rate with the unit in its name", "time: interval with the unit in its name",
         "netCDF with scaled whole numbers", "Parquet with the time as index", "Parquet with durations",
         "Excel with a sheet of notes first", "Excel with times of day", "TDMS with channels of other lengths",
         "catman ASCII", "DEWESoft", "DIAdem", "Graphtec", "FAMOS, tabs", "Keyence", "settings beside the rows",
         "labels above the names",
         "times before the trigger", "counterweight only", "numpy.savetxt", "Markdown", "line breaks in quoted names",
         "French thousands",
         "unit after a comma", "unit after an underscore", "years of two digits over midnight", "American dates over midnight",
         "the end of summer time, with zones", "durations in days", "a time beside each channel",
         "a slower clock beside one channel",
         "Excel with a table of limits beside", "Excel with date and time of day",
         "gzip", "ZIP", "every row twice", "some rows twice", "newest row first", "one value a row", "one channel a row",
         "durations of ISO 8601", "times as literals of IEC 61131", "descriptions and units below the names",
         "times in ticks of Windows", "times in ticks of .NET", "Rockwell, Millitm", "Siemens data log", "Campbell TOA5",
         "TwinCAT Scope, times in ms beside each channel", "InfluxDB", "Grafana, a series after the other",
         "historian with tags and qualities", "long table with units", "pandas melt", "PicoScope", "Keysight BenchLink, UTF-16",
         "Yokogawa DL850", "Hioki", "times named by their channels", "LabVIEW, decimal commas, units in the header",
         "LabVIEW, no X column", "a unit row in German", "percent signs as comments", "dSPACE structure",
         "a pair of times and values for each channel", "TDMS with a channel of times", "TDMS with groups of other rates",
         "MDF 3", "MDF 4 with scaled whole numbers", "MDF 4 with groups of other rates", "Excel with a hidden sheet",
         "Excel, dates since 1904", "HDF5 with times as attributes", "MATLAB structures for each channel",
         "MATLAB columns of names and a matrix", "a time beside each channel, named as nothing"}  # fmt: skip


def read(folder: Path, variant):
    """The table of a variant's run."""
    text = 'name = "x"\nmodel = "x"\n' + variant.extra
    for one in CHANNELS:
        sensor = f'sensor = "{one.sensor}"\n' if one.sensor else ""
        text += f'[[channels]]\ncolumn = "{one.column}"\nquantity = "{one.quantity}"\nunit = "{one.unit}"\n{sensor}'
    (folder / "campaign.toml").write_text(f'{text}[[runs]]\nfile = "{variant.file}"\n{variant.run_extra}\n', "utf-8")
    campaign = read_campaign_file(folder / "campaign.toml")
    return read_run_table(folder, campaign.runs[0], campaign, HEIGHT, folder)


def is_plain(table, variant) -> bool:
    """Whether a run is that of the plain table, or of what the variant says."""
    plain = PLAIN if variant.truth is None else variant.truth
    time = plain["time"].to_numpy()
    if len(table.time) != len(plain) or not np.allclose(table.time, time - time[0], rtol=0.0, atol=1e-6):
        return False
    car = plain["car_position"].to_numpy()
    same = np.allclose(table.car.value[: len(car)], car, rtol=0.0, atol=1e-4, equal_nan=True)
    for name, value in table.values.items():
        own, true = value, plain[name].to_numpy() * (1.0 if name == "sheave_w" else 1e-3)
        both = np.isfinite(own) & np.isfinite(true)
        same &= np.allclose(own[both], true[both], rtol=1e-9, atol=1e-12)
        same &= name == variant.asked or np.array_equal(np.isnan(own), np.isnan(true))
    return bool(same)


@pytest.mark.parametrize("variant", VARIANTS, ids=lambda one: one.name)
def test_a_file_is_read_as_the_plain_one_or_refused_or_read_with_a_remark(tmp_path, variant):
    variant.write(tmp_path / variant.file)
    try:
        table = read(tmp_path, variant)
    except InputError as error:
        assert variant.name not in RIGHT
        assert all(variant.file in line and len(line) < 600 and line.isprintable() for line in str(error).splitlines())
        return
    right = is_plain(table, variant)
    assert right or variant.name not in RIGHT
    gap = variant.name.endswith(("ten rows missing", "clock set forward"))  # told by what looks at the record, not at the file
    assert right or table.remarks or gap


@pytest.mark.parametrize(
    ("name", "said"),
    [("car in m, called mm", "moves by 45 mm in all: check its unit"), ("car to a centimetre", "changes in steps of 10 mm"),
     ("a blind laser shows zero", "stuck at one value"), ("single spikes in a laser", "12 samples lie apart from both"),
     ("a laser is knocked", "jumps by 12"), ("a sentinel twice", "2 samples are -999")],
)  # fmt: skip
def test_a_fault_that_a_single_file_shows_is_told(tmp_path, name, said):
    variant = next(one for group in (stated_wrongly, blind_and_broken) for one in group(PLAIN) if one.name == name)
    variant.write(tmp_path / variant.file)
    assert any(said in one for one in read(tmp_path, variant).remarks), read(tmp_path, variant).remarks


def test_every_variant_that_must_be_read_is_generated():
    names = [one.name for one in VARIANTS]
    assert set(RIGHT) <= set(names) and len(names) == len(set(names)) > 100


def test_channels_of_two_clocks_and_two_files_are_set_on_the_clock_of_the_run(tmp_path):
    slow = PLAIN.iloc[::3, :2].rename(columns={"time": "t"})
    slow.assign(t=slow["t"] + 100.0).to_csv(tmp_path / "car.csv", index=False)
    PLAIN[["time", *LASERS]].assign(time=PLAIN["time"] + 100.02).to_csv(tmp_path / "lasers.csv", index=False)
    PLAIN[["time", "sheave_dx", "sheave_w"]].assign(time=PLAIN["time"] + 90.0).to_csv(tmp_path / "axle.csv", index=False)
    files = dict.fromkeys(LASERS, "lasers.csv") | {"sheave_dx": "axle.csv", "sheave_w": "axle.csv"}
    spec = RunSpec(file="car.csv", files=files, offsets={"axle.csv": 10.0})
    campaign = CampaignFile(name="x", model="x", channels=CHANNELS, runs=(spec,))
    table = read_run_table(tmp_path, spec, campaign, HEIGHT, tmp_path)
    assert np.allclose(table.car.time, slow["t"]) and len(table.time) == 2 * len(PLAIN)
    for name, late in (("cw_low", 0.02), ("sheave_w", 0.0)):
        at = table.sampled[name]
        assert np.allclose(table.time[at], PLAIN["time"] + late) and np.isnan(table.values[name][~at]).all()


def test_clocks_that_cannot_be_related_are_refused(tmp_path):
    PLAIN[["time", "car_position"]].to_csv(tmp_path / "car.csv", index=False)
    stamped = PLAIN.assign(time=[f"09:12:{second:06.3f}" for second in PLAIN["time"]])
    stamped.to_csv(tmp_path / "lasers.csv", index=False)
    spec = RunSpec(file="car.csv", files={one.column: "lasers.csv" for one in CHANNELS})
    campaign = CampaignFile(name="x", model="x", channels=CHANNELS, runs=(spec,))
    with pytest.raises(InputError, match=r"time of day, those of the car seconds .* offsets"):
        read_run_table(tmp_path, spec, campaign, HEIGHT, tmp_path)


@pytest.mark.parametrize("ending", ["h5", "mat"])
def test_each_group_of_a_file_has_the_clock_that_stands_in_it(tmp_path, ending):
    groups = {"drive": (["car_position"], 0.0), "lasers": ([one.column for one in CHANNELS], 2.0)}
    arrays = {g: {**{n: PLAIN[n].to_numpy() for n in names}, "time": PLAIN["time"].to_numpy() + late}
              for g, (names, late) in groups.items()}  # fmt: skip
    if ending == "mat":
        scipy.io.savemat(tmp_path / "run.mat", arrays)
    else:
        with h5py.File(tmp_path / "run.h5", "w") as file:
            for group, own in arrays.items():
                for name, values in own.items():
                    file[f"{group}/{name}"] = values
    table = read(tmp_path, Variant("groups", f"run.{ending}", lambda path: None))
    assert table.car.time[0] == 0.0 and table.time[0] == 2.0 and len(table.time) == len(PLAIN)


@pytest.mark.parametrize("second", [100, 1e4, 1e7])
def test_ticks_of_an_unknown_clock_are_not_taken_for_the_nearest_unit(tmp_path, second):
    PLAIN.assign(time=(second * PLAIN["time"]).round().astype(int)).to_csv(tmp_path / "run.csv", index=False)
    with pytest.raises(InputError, match=r"write time_unit under .file., or, if time counts samples or ticks, their rate"):
        read(tmp_path, Variant("ticks", "run.csv", lambda path: None))
    stated = f'[file]\ntime_unit = "sample"\nrate = {second}\n'
    assert is_plain(read(tmp_path, Variant("ticks", "run.csv", lambda path: None, stated)), Variant("", "", lambda path: None))


def test_archives_that_cannot_be_read_are_refused_in_one_sentence(tmp_path):
    text = PLAIN.to_csv(index=False).encode()
    with zipfile.ZipFile(tmp_path / "two.zip", "w") as archive:
        archive.writestr("up.csv", text)
        archive.writestr("down.csv", text)
    (tmp_path / "torn.csv.gz").write_bytes(gzip.compress(text)[:-2000])
    (tmp_path / "nested.gz").write_bytes(gzip.compress(gzip.compress(text)))
    told = {"two.zip": 'archive of 2 files: up.csv, down.csv; write sheet = "up.csv"', "torn.csv.gz": "damaged gzip archive",
            "nested.gz": "archive in an archive"}  # fmt: skip
    for name, sentence in told.items():
        with pytest.raises(InputError, match=sentence):
            read_raw_table(tmp_path / name, FileFormat())
    assert len(read_raw_table(tmp_path / "two.zip", FileFormat(sheet="down.csv")).columns) == PLAIN.shape[1]


def test_an_archive_that_grows_without_end_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("comprope_system.measurements.files.archive.LARGEST_UNPACKED", 1_000_000)
    (tmp_path / "bomb.csv.gz").write_bytes(gzip.compress(b"0" * 2_000_000))
    with pytest.raises(InputError, match="gzip archive of more than 1 MB; unpack it"):
        read_raw_table(tmp_path / "bomb.csv.gz", FileFormat())


def test_rows_of_one_time_with_values_that_contradict_each_other_are_refused(tmp_path):
    twice = pd.concat([PLAIN, PLAIN.iloc[400:410].assign(cw_low=1.0)]).sort_values("time", kind="stable")
    twice.to_csv(tmp_path / "run.csv", index=False)
    with pytest.raises(InputError, match="10 rows are at the same time"):
        read(tmp_path, Variant("twice", "run.csv", lambda path: None))


def test_files_outside_pipes_and_devices_are_refused(tmp_path):
    folder = tmp_path / "campaign"
    folder.mkdir()
    PLAIN.to_csv(tmp_path / "run.csv", index=False)
    (folder / "link.csv").symlink_to(tmp_path / "run.csv")
    os.mkfifo(folder / "pipe.csv")
    for path, told in (
        (folder / "link.csv", "outside of the campaign's folder"),
        (folder / ".." / "run.csv", "outside of the campaign's folder"),
        (folder / "pipe.csv", "a pipe or device"), (Path("/dev/zero"), "a pipe or device"), (folder, "is a folder"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=told):
            read_raw_table(path, FileFormat(), folder)
    assert isinstance(read_raw_table(folder / "link.csv", FileFormat()), RawTable)


def test_escape_characters_of_a_file_do_not_reach_the_terminal(tmp_path, capsys):
    (tmp_path / "run.csv").write_text("time,car_\x1b[31mposition\n0,1\n1,2\n")
    with pytest.raises(SystemExit):
        main(["simulate", "tower50", "--car", str(tmp_path / "run.csv")])
    assert "\x1b" not in capsys.readouterr().err


def test_a_missing_package_is_named_with_the_extra_that_brings_it(tmp_path, monkeypatch):
    PLAIN.to_parquet(tmp_path / "run.parquet")
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(InputError, match=r'pip install "comprope\[formats\]"'):
        read_raw_table(tmp_path / "run.parquet", FileFormat())


@pytest.mark.parametrize(
    ("name", "split"),
    [("Time [s]", ("Time", "s")), ("y (mm)", ("y", "mm")), ("z / mm", ("z", "mm")), ("Laser 1", ("Laser 1", None)),
     ("cw_low", ("cw_low", None)), ("a (left)", ("a (left)", None)), ("time_ms", ("time", "ms")), ("w [°/s]", ("w", "°/s"))],
)  # fmt: skip
def test_the_unit_in_a_name(name, split):
    assert split_unit(name) == split


def test_spellings_of_units():
    assert [unit_named(one) for one in ("µm", "U/min", "m/s²", "Sek", "KN")] == ["um", "rpm", "m/s2", "s", "kN"]
    assert [unit_named(one) for one in ("M", "MS", "°C")] == [None, None, None] and is_unit("°C")
