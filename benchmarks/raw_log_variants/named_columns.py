"""Names, units and times as operators and spreadsheets write them; workbooks of several tables."""

from collections.abc import Iterator
from dataclasses import replace
from datetime import timedelta
from functools import partial
from pathlib import Path

import numpy as np
import openpyxl
import pandas as pd

from .variant import START, Variant, csv, text, write_bytes


def decorated_names(table: pd.DataFrame) -> Iterator[Variant]:
    """Units before, behind and below names; numbers of channels; marks."""
    forms = {
        "unit after a comma": "{}, {}", "unit after a slash": "{} / {}", "unit after an underscore": "{}_{}",
        "unit in braces": "{} {{{}}}",
        "unit in angle brackets": "{} <{}>", "unit after in": "{} in {}",
    }  # fmt: skip
    units = ("s", "m", "mm", "mm", "mm", "mm", "rad/s")
    for name, form in forms.items():
        named = [form.format(one, unit) for one, unit in zip(table.columns, units, strict=True)]
        yield text(name, csv(table.set_axis(named, axis=1), sep=";"))
    others = {"cw_low": "µm", "cw_mid": "cm", "car_low": "m"}
    mixed = table.assign(cw_low=1e3 * table["cw_low"], cw_mid=0.1 * table["cw_mid"], car_low=1e-3 * table["car_low"])
    mixed = mixed.rename(columns={name: f"{name} [{unit}]" for name, unit in others.items()})
    told = 'readings = { cw_low = { unit = "um" }, cw_mid = { unit = "cm" }, car_low = { unit = "m" } }'
    yield text("lasers in three units", csv(mixed))
    yield text("lasers in three units, stated in both", csv(mixed), run_extra=told)
    yield text(
        "a unit of broken encoding",
        csv(table.rename(columns={"cw_low": "cw_low [Âµm]"}).assign(**{"cw_low [Âµm]": 1e3 * table["cw_low"]})),
    )
    yield text("footnotes at names", csv(table.rename(columns={"cw_low": "cw_low *", "sheave_w": "sheave_w 1)"})))
    numbered = [f"{k}: {name}" for k, name in enumerate(table.columns, 1)]
    stated = "".join(f', {name} = "{k}: {name}"' for k, name in enumerate(table.columns, 1) if k > 2)
    yield text("numbers before names", csv(table.set_axis(numbered, axis=1)))
    yield text("numbers before names, stated", csv(table.set_axis(numbered, axis=1)), '[file]\ntime = "1: time"\n',
               f'columns = {{ car = "2: car_position"{stated} }}')  # fmt: skip


def written_times(table: pd.DataFrame) -> Iterator[Variant]:
    """Years of two digits, midnight, the change to winter time with zones, durations, repeated and unsorted rows."""
    t = table["time"].to_numpy()
    night = [START + timedelta(hours=14, minutes=47, seconds=45, microseconds=round(1e6 * one)) for one in t]
    parts = [(one, one.microsecond // 1000) for one in night]
    yield text(
        "years of two digits over midnight",
        csv(table.assign(time=[f"{one:%d.%m.%y %H:%M:%S},{ms:03d}" for one, ms in parts]), sep=";", decimal=","),
    )
    yield text(
        "American dates over midnight",
        csv(table.assign(time=[f"{one:%m/%d/%y %I:%M:%S}.{ms:03d} {one:%p}" for one, ms in parts])),
    )
    autumn = [
        START.replace(month=10, day=25, hour=0, minute=59, second=45) + timedelta(microseconds=round(1e6 * one)) for one in t
    ]
    local = [one + timedelta(hours=2 if one.hour < 1 else 1) for one in autumn]
    offsets = ["+02:00" if one.hour < 1 else "+01:00" for one in autumn]
    yield text(
        "the end of summer time, with zones",
        csv(
            table.assign(
                time=[f"{one.isoformat(timespec='milliseconds')}{zone}" for one, zone in zip(local, offsets, strict=True)]
            )
        ),
    )
    yield text(
        "the end of summer time, without zones", csv(table.assign(time=[one.isoformat(timespec="milliseconds") for one in local]))
    )
    spans = [f"0 days 00:{int(one // 60):02d}:{one % 60:06.3f}" for one in t]
    yield text("durations in days", csv(table.assign(time=spans)))
    yield text("durations of ISO 8601", csv(table.assign(time=[f"PT{one:.2f}S" for one in t])))
    yield text("every row twice", csv(table.loc[table.index.repeat(2)]))
    yield text("some rows twice", csv(table.loc[np.sort(np.r_[table.index, table.index[100:200:7]])]))
    yield text("rows out of order", csv(table.sample(frac=1.0, random_state=1)))
    late = table.copy()
    late.iloc[[300, 301]] = table.iloc[[301, 300]].to_numpy()
    yield text("two rows exchanged", csv(late))
    pairs = pd.concat([table[["time", name]].rename(columns={"time": f"t_{name}"}) for name in table.columns[1:]], axis=1)
    yield text("a time beside each channel", csv(pairs))
    renamed = pairs.set_axis([f"X{k // 2}" if k % 2 == 0 else name for k, name in enumerate(pairs.columns)], axis=1)
    yield text("a time beside each channel, named as nothing", csv(renamed))
    yield text("a second clock, named as nothing", csv(renamed.rename(columns={"X0": "time"})))
    slow = pairs.copy()
    slow.iloc[400:, 4:6] = np.nan
    slow.iloc[:400, 4:6] = pairs.iloc[::2, 4:6].to_numpy()[:400]
    short = table.copy()
    short.loc[1::2, "cw_mid"] = np.nan
    short.loc[800:, "cw_mid"] = np.nan
    yield replace(text("a slower clock beside one channel", csv(slow)), truth=short)


def workbooks(table: pd.DataFrame) -> Iterator[Variant]:
    """Several tables in a sheet, merged cells, dates beside times."""
    yield Variant("Excel with a table of limits beside", "run.xlsx", partial(_sheet, _beside(table)))
    yield Variant(
        "Excel with a table of limits below",
        "run.xlsx",
        partial(_sheet, [*_rows(table), [], ["limit", "low", "high"], ["laser", -50, 50]]),
    )
    grouped = [
        ["", "", "cw", None, "car", "sheave", None],
        ["time", "car_position", "low", "mid", "low", "dx", "w"],
        *_rows(table)[1:],
    ]
    yield Variant("Excel with merged groups above names", "run.xlsx", partial(_sheet, grouped, "C1:D1", "F1:G1"))
    titled = [["Measurement of 2 November"], [], [*table.columns], ["s", "m", "mm", "mm", "mm", "mm", "rad/s"], *_rows(table)[1:]]
    yield Variant("Excel with a merged title and units", "run.xlsx", partial(_sheet, titled, "A1:G1"))
    stamps = [START + timedelta(microseconds=round(1e6 * one)) for one in table["time"]]
    dated = [
        ["Datum", "Uhrzeit", *table.columns[1:]],
        *([one.date(), one.time(), *row[1:]] for one, row in zip(stamps, _rows(table)[1:], strict=True)),
    ]
    yield Variant("Excel with date and time of day", "run.xlsx", partial(_sheet, dated))
    yield Variant("Excel with two runs in two sheets", "run.xlsx", partial(_two, table))
    import gzip
    import io
    import zipfile

    yield Variant("gzip", "run.csv.gz", lambda path: write_bytes(path, gzip.compress(csv(table).encode())))
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("run.csv", csv(table))
    yield Variant("ZIP", "run.zip", lambda path: write_bytes(path, packed.getvalue()))


def _rows(table: pd.DataFrame) -> list[list[object]]:
    return [[*table.columns], *([None if np.isnan(one) else float(one) for one in row] for row in table.to_numpy())]


def _beside(table: pd.DataFrame) -> list[list[object]]:
    limits: list[list[object]] = [["limit", "value"], ["laser", 50.0], ["speed", 2.5], ["travel", 50.0]]
    return [[*row, None, *(limits[k] if k < len(limits) else [])] for k, row in enumerate(_rows(table))]


def _sheet(rows: list[list[object]], *merged_and_path: object) -> None:
    *merged, path = merged_and_path
    book = openpyxl.Workbook()
    for row in rows:
        book.active.append(row)
    for one in merged:
        book.active.merge_cells(one)
    book.save(str(path))


def _two(table: pd.DataFrame, path: Path) -> None:
    with pd.ExcelWriter(path) as writer:
        table.to_excel(writer, sheet_name="up", index=False)
        table.assign(car_position=50.0 - table["car_position"]).to_excel(writer, sheet_name="down", index=False)
