"""Variants of one run as other loggers would have written it, generated from its plain CSV file."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

START = datetime(2026, 11, 2, 9, 12, 1, 123000)  # of the record
Write = Callable[[Path], None]


@dataclass(frozen=True)
class Variant:
    """A file to write, its name, and what campaign.toml states about it (`extra`), also in the run (`run_extra`)."""

    name: str
    file: str
    write: Write
    extra: str = ""
    run_extra: str = ""
    asked: str = ""  # the channel of which campaign.toml leaves out samples


def variants(plain: Path) -> Iterator[Variant]:
    """All variants of a plain.csv."""
    table = pd.read_csv(plain)
    for group in (dialects, encodings, times, units, missing, faults, binaries):
        yield from group(table)


def csv(table: pd.DataFrame, **options: object) -> str:
    """The table as text."""
    return table.to_csv(index=False, **options)  # type: ignore[call-overload,no-any-return]


def text(name: str, content: str | bytes, extra: str = "", run_extra: str = "", file: str = "run.csv") -> Variant:
    """A variant with this content."""
    data = content.encode("utf-8") if isinstance(content, str) else content
    return Variant(name, file, lambda path: _write(path, data), extra, run_extra)


def _write(path: Path, data: bytes) -> None:
    path.write_bytes(data)


def dialects(table: pd.DataFrame) -> Iterator[Variant]:
    """Separators, decimal signs, quotation marks, lines around and within the table."""
    plain = csv(table)
    lines = plain.splitlines()
    comma = csv(table, sep=";", decimal=",")
    for name, sep, decimal in (
        ("semicolon, decimal point", ";", "."), ("tab, decimal comma", "\t", ","), ("bar", "|", "."),
        ("bar, decimal comma", "|", ","),
    ):  # fmt: skip
        yield text(name, csv(table, sep=sep, decimal=decimal))
    filled = table.fillna(-9999.0)
    yield text("blanks", filled.to_string(index=False))
    yield text("blanks, decimal comma", filled.to_string(index=False).replace(".", ","))
    named = "time [s]  car position [m]  cw low  cw mid  car low  sheave dx  sheave w\n"
    yield text("blanks, in names too", named + filled.to_string(index=False, header=False))
    yield text("all cells quoted", csv(table, quoting=1))
    texts = table.map(lambda one: "" if pd.isna(one) else f"{one}".replace(".", ","))
    yield text("quoted decimal commas between commas", csv(texts, quoting=1))
    yield text("decimal commas between commas, unquoted", comma.replace(";", ","))
    yield text("CRLF", plain.replace("\n", "\r\n"))
    yield text("CR", plain.replace("\n", "\r"))
    yield text("a delimiter at the end of each line", plain.replace("\n", ",\n"))
    ended = [f"{one},\n" for one in lines[1:]]
    yield text("a delimiter at the end of each row but not of the header", lines[0] + "\n" + "".join(ended))
    yield text("a blank line between rows", plain.replace("\n", "\n\n"))
    yield text("blanks after commas", plain.replace(",", ",  "))
    yield text("line sep=;", "sep=;\n" + comma)
    yield text("header in a comment", "# " + plain)
    yield text("comments above and within", "% logger 7\n% 2 Nov\n" + "\n".join([*lines[:300], "# marker pressed", *lines[300:]]))
    yield text("no header", "\n".join(lines[1:]))
    stated = [f"{name} = \"column {k}\"" for k, name in enumerate(table.columns, 1) if name not in ("time", "car_position")]
    run = f'columns = {{ car = "column 2", {", ".join(stated)} }}'
    yield text("no header, columns stated", "\n".join(lines[1:]), '[file]\ntime = "column 1"\n', run)
    yield text("header repeated", "\n".join([*lines[:400], lines[0], *lines[400:]]))
    head = [lines[0], "s,m,mm,mm,mm,mm,rad/s"]
    yield text("header and units repeated", "\n".join([*head, *lines[1:400], *head, *lines[400:]]))
    yield text("footer", plain + "\nEnd of file\nchecksum 7f3a\n")
    yield text("footer of statistics", plain + "Mean,1.0,2.0,3.0,4.0,5.0,6.0\nMax,1.0,2.0,3.0,4.0,5.0,6.0\n")
    yield text("last line torn", plain.rstrip("\n")[:-12])
    yield text("nine lines above", "Logger;X\nSerial;123\nSetup;A;B;C\nOperator;Max\n\nChannels;7\nNote;a;b\n\nRate;25\n" + comma)
    yield text("numbers in the lines above", "Gain,1,1,1,1,1,1\nLimits,-50,50,-20,20,0,1\n" + plain)
    yield text("a text column first", "\n".join(["status," + lines[0], *("OK," + one for one in lines[1:])]))
    yield text("row numbers first", "\n".join(["no," + lines[0], *(f"{k}," + one for k, one in enumerate(lines[1:], 1))]))
    yield text("a text column amid, sometimes empty", csv(_inserted(table, 3, "event", ["start"] + [""] * (len(table) - 1))))
    yield text("a constant column named time", csv(_inserted(table, 2, "response_time", 7.0)))
    yield text("two lines of names", "\n".join(["t,car,laser,laser,laser,sheave,sheave", *lines]))
    yield text("an empty column at the end", csv(table.assign(spare="")))
    yield text("columns in another order", csv(table[[*table.columns[::-1]]]))
    yield text("names in capitals with blanks", csv(table.rename(columns=lambda name: name.upper().replace("_", " "))))
    yield text("a column twice", csv(_inserted(table, 4, "cw_low", table["cw_mid"].to_numpy(), allow_duplicates=True)))
    thousands = table.assign(car_position=[f"{1e3 * x:,.1f}" for x in table["car_position"]]).rename(
        columns={"car_position": "car_position [mm]"}
    )
    yield text("thousands separated", csv(thousands, sep=";"))
    yield text("exponents", csv(table, float_format="%.9e"))
    yield text("exponents with D", csv(table, float_format="%.9e").replace("e-", "D-").replace("e+", "D+"))
    yield from labview(table)
    yield text("minus signs of typography", plain.replace("-", "−"))
    yield text("a cell with a word", plain.replace(lines[200], lines[200].replace(lines[200].split(",")[2], "0.1b", 1)))
    yield text("a row with a cell too many", "\n".join([*lines[:300], lines[300] + ",7.0", *lines[301:]]))
    yield text("escape characters in a name", plain.replace("cw_low", "cw_low\x1b[31m", 1))


LABVIEW = (
    "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\nX_Columns\t{columns}\nDate\t2026/11/02\n"
    "Time\t09:12:01,123\n***End_of_Header***\t\n\t\nChannels\t6\nSamples\t826{gap}826{gap}826{gap}826{gap}826{gap}826\n"
    "X0\t0,0E+0{gap}0,0E+0\nDelta_X\t0,04{gap}0,04{gap}0,04{gap}0,04{gap}0,04{gap}0,04\n***End_of_Header***\n"
)


def labview(table: pd.DataFrame) -> Iterator[Variant]:
    """LabVIEW measurement files with a time beside each channel, and without times."""
    cells = table.map(lambda one: "" if pd.isna(one) else f"{one}".replace(".", ","))
    names = [*table.columns[1:]]
    rows = ["\t".join(f"{row[0]}\t{one}" for one in row[1:]) for row in cells.itertuples(index=False)]
    head = LABVIEW.format(columns="Multi", gap="\t\t") + "\t".join(f"X_Value\t{one}" for one in names)
    yield text("LabVIEW, times beside each channel", "\n".join([f"{head}\tComment", *rows]), file="run.lvm")
    rows = ["\t".join(["", *row[1:]]) for row in cells.itertuples(index=False)]
    head = LABVIEW.format(columns="No", gap="\t") + "\t".join(["X_Value", *names])
    yield text("LabVIEW without times", "\n".join([f"{head}\tComment", *rows]), file="run.lvm")


def _inserted(table: pd.DataFrame, at: int, name: str, values: object, allow_duplicates: bool = False) -> pd.DataFrame:
    found = table.copy()
    found.insert(at, name, values, allow_duplicates=allow_duplicates)
    return found


def encodings(table: pd.DataFrame) -> Iterator[Variant]:
    """Encodings, with a spare column whose name needs them."""
    plain = csv(table.assign(**{"Größe [°C]": 20.5}))
    for encoding in ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "latin-1", "cp1252", "utf-32"):
        yield text(f"encoding {encoding}", plain.encode(encoding))
    yield text("encoding cp437, stated", plain.encode("cp437"), '[file]\nencoding = "cp437"\n')


def times(table: pd.DataFrame) -> Iterator[Variant]:
    """Times in other units and notations."""
    t = table["time"].to_numpy()
    epoch = (START - datetime(1970, 1, 1)).total_seconds()
    numbers: dict[str, tuple[str, object]] = {
        "ms in the name": ("time_ms", 1e3 * t), "ms in brackets": ("Time [ms]", 1e3 * t), "ms unlabelled": ("time", 1e3 * t),
        "us unlabelled": ("time", np.round(1e6 * t).astype(int)), "min in brackets": ("time [min]", t / 60.0),
        "min unlabelled": ("time", t / 60.0), "h unlabelled": ("time", t / 3600.0), "from 1000 s": ("time", 1000.0 + t),
        "from -1 s": ("time", t - 1.0), "epoch in ms": ("timestamp", np.round(1e3 * (epoch + t)).astype(np.int64)),
        "epoch in us": ("timestamp", np.round(1e6 * (epoch + t)).astype(np.int64)),
        "epoch in ns": ("timestamp", np.round(1e6 * (epoch + t)).astype(np.int64) * 1000), "epoch in s": ("time", epoch + t),
        "days of Excel": ("time", 46328.0 + 0.3833463 + t / 86400.0), "days of MATLAB": ("time", 740288.0 + 0.38 + t / 86400.0),
        "fraction of a day": ("time", 0.3833463 + t / 86400.0), "sample numbers, no rate": ("sample", np.arange(len(t))),
        "sample numbers called time": ("time", np.arange(len(t))), "time in a word": ("Zeit", t), "unknown name": ("Abszisse", t),
    }  # fmt: skip
    for name, (column, values) in numbers.items():
        changed = table.rename(columns={"time": column})
        changed[column] = values
        yield text(f"time: {name}", csv(changed))
    changed = table.rename(columns={"time": "sample"}).assign(sample=np.arange(len(t)))
    yield text("time: sample numbers, rate above", "Sample rate: 25 Hz\n\n" + csv(changed))
    yield text("time: sample numbers, rate stated", csv(changed), "[file]\nrate = 25.0\n")
    yield text("time: none, rate above", "Sampling interval;40 ms\n" + csv(table.drop(columns="time"), sep=";", decimal=","))
    yield text("time: none", csv(table.drop(columns="time")))
    stamps = [START + timedelta(microseconds=round(1e6 * one)) for one in t]
    night = [one + timedelta(hours=14, minutes=47, seconds=45) for one in stamps]
    forms: dict[str, list[str]] = {
        "ISO with Z": [f"{one.isoformat(timespec='milliseconds')}Z" for one in stamps],
        "ISO with a zone": [f"{one.isoformat(timespec='milliseconds')}+01:00" for one in stamps],
        "day first": [f"{one:%d.%m.%Y %H:%M:%S}.{one.microsecond // 1000:03d}" for one in stamps],
        "month first, AM": [f"{one:%m/%d/%Y %I:%M:%S}.{one.microsecond // 1000:03d} {one:%p}" for one in stamps],
        "year first": [f"{one:%Y/%m/%d %H:%M:%S}.{one.microsecond // 1000:03d}" for one in stamps],
        "minutes and seconds": [f"{one:%M:%S}.{one.microsecond // 1000:03d}" for one in stamps],
        "colon before milliseconds": [f"{one:%H:%M:%S}:{one.microsecond // 1000:03d}" for one in stamps],
        "over midnight": [f"{one:%H:%M:%S}.{one.microsecond // 1000:03d}" for one in night],
        "over midnight with the date": [f"{one:%d.%m.%Y %H:%M:%S}.{one.microsecond // 1000:03d}" for one in night],
        "whole seconds only": [f"{one:%H:%M:%S}" for one in stamps],
    }
    for name, column in forms.items():
        yield text(f"time: {name}", csv(table.assign(time=column)))
    commas = [f"{one:%H:%M:%S},{one.microsecond // 1000:03d}" for one in stamps]
    yield text("time: comma before milliseconds", csv(table.assign(time=commas), sep=";", decimal=","))
    yield text("time: comma before milliseconds, between commas", csv(table.assign(time=commas)).replace('"', ""))
    yield text("time: goes back", csv(pd.concat([table[:400], table])))
    yield text("time: one row twice", csv(pd.concat([table[:400], table[399:]])))
    yield text("time: a cell missing", csv(table.assign(time=np.where(table.index == 300, np.nan, t))))
    gap = table.drop(index=range(300, 310))
    yield text("time: ten rows missing", csv(gap))


def units(table: pd.DataFrame) -> Iterator[Variant]:
    """Units of the car and of channels, stated in the file or not."""
    car = table["car_position"]
    for name, column, values in (
        ("car in cm, stated", "car_position [cm]", 100.0 * car), ("car in ft, stated", "car_position (ft)", car / 0.3048),
        ("car in cm", "car_position", 100.0 * car), ("car in V, stated", "car_position [V]", car / 5.0),
        ("car in m, another name", "Kabinenposition / m", car),
    ):  # fmt: skip
        changed = table.rename(columns={"car_position": column})
        changed[column] = values
        yield text(name, csv(changed))
    yield text("car in counts, stated in campaign.toml", csv(table.assign(car_position=np.round(1e4 * car + 7))),
               '[car]\nunit = "m"\nscale = 0.0001\nzero = 7\n')  # fmt: skip
    changed = table.rename(columns={"cw_low": "cw_low [µm]"})
    changed["cw_low [µm]"] *= 1e3
    yield text("a laser in um, campaign.toml says mm", csv(changed))
    yield text("a laser in V, campaign.toml says mm", csv(table.rename(columns={"cw_low": "cw_low [V]"})))


def missing(table: pd.DataFrame) -> Iterator[Variant]:
    """What stands where there is no value, in 30 cells of one channel."""
    words = ("NaN", "n/a", "#N/A", "---", "Overload", "OVER", "<no data>", "?", "Inf")
    for word in (*words, "-999", "-9999.0", "1e30", "32767", "9.91e+37"):
        yield text(f"missing: {word}", csv(_with_word(table, word)))
    yield text("missing: a stated word", csv(_with_word(table, "kaputt")), '[file]\nmissing = ["kaputt"]\n')
    yield text("missing: an unknown word", csv(_with_word(table, "kaputt")))
    number = text("missing: a stated number", csv(_with_word(table, "12.345")), "[file]\nmissing = [12.345]\n")
    yield replace(number, asked="cw_mid")


def _with_word(table: pd.DataFrame, word: str) -> pd.DataFrame:
    cells = table["cw_mid"].map(lambda one: "" if np.isnan(one) else f"{one}").to_list()
    cells[300:330] = [word] * 30
    return table.assign(cw_mid=cells)


def faults(table: pd.DataFrame) -> Iterator[Variant]:
    """Faults of instruments that show in the data."""
    w, dx, low = (table[name].to_numpy(copy=True) for name in ("sheave_w", "sheave_dx", "cw_low"))
    stuck = low.copy()
    stuck[300:340] = 0.0
    changes: dict[str, dict[str, object]] = {
        "empty": {"cw_low": np.nan}, "flat": {"cw_low": 0.0}, "clipped": {"cw_low": np.clip(low, -8.0, 8.0)},
        "held": {"car_low": np.repeat(table["car_low"].to_numpy()[::4], 4)[: len(table)]}, "dropped out": {"cw_low": stuck},
        "wrong sign": {"sheave_w": -w}, "in rpm": {"sheave_w": w * 30.0 / np.pi}, "swapped": {"sheave_w": dx, "sheave_dx": w},
        "late": {"sheave_w": np.interp(table["time"] - 0.3, table["time"], w)}, "laser in m": {"cw_low": 1e-3 * low},
        "nothing before the trip": {"cw_low": np.where(table["time"] < 6.0, np.nan, low)},
        "lasers swapped": {"cw_mid": table["car_low"], "car_low": table["cw_mid"]},
        "car downward": {"car_position": 50.0 - table["car_position"]},
        "car from elsewhere": {"car_position": table["car_position"] - 5.0},
        "car jumps": {"car_position": np.where(table["time"] > 15.0, table["car_position"] - 3.0, table["car_position"])},
        "car too fast": {"time": table["time"] / 20.0},
    }  # fmt: skip
    for name, columns in changes.items():
        yield text(f"fault: {name}", csv(table.assign(**columns)))
    yield text("fault: no rest", csv(table[150:]))


def binaries(table: pd.DataFrame) -> Iterator[Variant]:
    """Files of other programs."""
    yield Variant("Excel with lines above", "run.xlsx", partial(_excel, table))
    stamped = table.assign(time=[START + timedelta(seconds=float(one)) for one in table["time"]])
    yield Variant("Excel with dates", "run.xlsx", partial(_excel, stamped))
    texts = table.map(lambda one: "" if pd.isna(one) else f"{one}".replace(".", ","))
    yield Variant("Excel with decimal commas as text", "run.xlsx", partial(_excel, texts))
    yield Variant("MATLAB structure", "run.mat", partial(_mat, {"run": {name: table[name].to_numpy() for name in table}}))
    arrays = {name: table[name].to_numpy() for name in table.columns[1:]}
    yield Variant("MATLAB without time, with fs", "run.mat", partial(_mat, {"fs": 25.0} | arrays))
    yield Variant("HDF5 compound", "run.h5", partial(_hdf5_compound, table))
    yield Variant("HDF5 matrix with names", "run.h5", partial(_hdf5_matrix, table))
    yield Variant("MATLAB 7.3", "run.mat", partial(_mat73, table))
    yield Variant("Parquet with time stamps", "run.parquet", lambda path: stamped.to_parquet(path))
    zoned = stamped.assign(time=pd.DatetimeIndex(stamped["time"]).tz_localize("Europe/Zurich"))
    yield Variant("Parquet with a time zone", "run.parquet", lambda path: zoned.to_parquet(path))
    yield Variant("MATLAB structure of Simulink", "run.mat", partial(_simulink, table))
    others = ", ".join(f'{name} = "{name}/values"' for name in table.columns[2:])
    groups = f'columns = {{ car = "car_position/values", {others} }}'
    yield Variant("HDF5 with a time in each group", "run.h5", partial(_hdf5_groups, table), run_extra=groups)
    yield Variant("TDMS waveforms", "run.tdms", partial(_tdms, table))
    yield Variant("a torn Parquet file", "run.parquet", partial(_torn, lambda path: table.to_parquet(path)))
    yield Variant("a torn Excel file", "run.xlsx", partial(_torn, partial(_excel, table)))
    yield Variant("a picture", "run.csv", lambda path: _write(path, b"\x89PNG\r\n\x1a\n" + bytes(200)))
    yield Variant("an empty file", "run.csv", lambda path: _write(path, b""))
    yield Variant("random bytes", "run.csv", lambda path: _write(path, np.random.default_rng(1).bytes(5000)))


def _excel(table: pd.DataFrame, path: Path) -> None:
    table.to_excel(path, index=False, startrow=4)


def _mat(content: dict[str, object], path: Path) -> None:
    import scipy.io

    scipy.io.savemat(path, content)


def _hdf5_compound(table: pd.DataFrame, path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        file.create_dataset("run/table", data=table.to_records(index=False))


def _hdf5_matrix(table: pd.DataFrame, path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        file.create_dataset("data", data=table.to_numpy()).attrs["columns"] = list(table.columns)


def _hdf5_groups(table: pd.DataFrame, path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        for name in table.columns[1:]:
            file.create_dataset(f"{name}/time", data=table["time"].to_numpy())
            file.create_dataset(f"{name}/values", data=table[name].to_numpy())


def _simulink(table: pd.DataFrame, path: Path) -> None:
    signals = np.zeros(len(table.columns) - 1, dtype=[("values", "O"), ("label", "O")])
    for k, name in enumerate(table.columns[1:]):
        signals[k] = (table[name].to_numpy()[:, None], name)
    _mat({"out": {"time": table["time"].to_numpy(), "signals": signals}}, path)


def _mat73(table: pd.DataFrame, path: Path) -> None:
    import h5py

    with h5py.File(path, "w", userblock_size=512) as file:
        for name in table:
            file.create_dataset(name, data=table[name].to_numpy()[None, :]).attrs["MATLAB_class"] = np.bytes_("double")
    data = bytearray(path.read_bytes())
    data[:19] = b"MATLAB 7.3 MAT-file"
    path.write_bytes(bytes(data))


def _tdms(table: pd.DataFrame, path: Path) -> None:
    from nptdms import ChannelObject, TdmsWriter

    properties = {"wf_increment": 0.04, "wf_start_offset": 0.0}
    channels = [ChannelObject("Run", name, table[name].to_numpy(), properties) for name in table.columns[1:]]
    with TdmsWriter(path) as writer:
        writer.write_segment(channels)


def _torn(write: Write, path: Path) -> None:
    write(path)
    path.write_bytes(path.read_bytes()[:-2000])
