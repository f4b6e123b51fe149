"""Exports of loggers, oscilloscopes, controllers and statistics programs, with their lines above and their names and units."""

from collections.abc import Iterator
from datetime import timedelta

import numpy as np
import pandas as pd

from .variant import START, Variant, csv, text

UNITS = ("s", "m", "mm", "mm", "mm", "mm", "rad/s")
GRAPHTEC = (
    "Vendor,GRAPHTEC Corporation\nModel,GL840-M\nVersion,Ver1.10\nSampling interval,40ms\nTotal data points,826\n"
    "Start time,2026/11/02,09:12:01\nEnd time,2026/11/02,09:12:34\nTrigger time,2026/11/02,09:12:01\nAMP settings\n"
    "CH,Signal name,Input,Range,Filter,Span\nCH1,car,DC,10V,Off,50.000000,0.000000,m\nCH2,low,DC,10V,Off,50.0,-50.0,mm\n"
    "Logic/Pulse,Off\nData\n"
)
DEWESOFT = (
    "Data file;run.dxd\nStart time:;11/2/2026 9:12:01.123 AM\nNumber of channels:;7\nSample rate:;25 Hz\n"
    "Store type:;always fast\n\nEvents\nEvent Type;Event;Time;Comment\n1;Recording started;0;\n2;Recording stopped;33;\n\nData1\n"
)


def _united(table: pd.DataFrame, form: str = "{} [{}]") -> pd.DataFrame:
    """The table with a unit in each name."""
    return table.set_axis([form.format(name, unit) for name, unit in zip(table.columns, UNITS, strict=True)], axis=1)


def _cells(table: pd.DataFrame, decimal: str = ".") -> list[list[str]]:
    """Texts of all cells, empty where there is no value."""
    return [["" if np.isnan(one) else f"{one:g}".replace(".", decimal) for one in row] for row in table.to_numpy()]


def data_loggers(table: pd.DataFrame) -> Iterator[Variant]:
    """HBM, DEWESoft, DIAdem, Graphtec, FAMOS and Keyence."""
    names = [*table.columns]
    rows = ["\t".join(row) for row in _cells(table, ",")]
    head = ["HBM catman AP", "Datei:\trun.asc", "Datum:\t02.11.2026 09:12:01", "Kanäle:\t7", "Messwerte/Kanal:\t826", ""]
    units = [f"[{one}]" for one in UNITS]
    asc = [*head, "\t".join(["Zeit  1 - Standardmessrate", *names[1:]]), "\t".join(units)]
    asc += ["\t".join(["", *["SR=25 Hz"] * 6]), "\t".join(["", *[f"Kanal {k}" for k in range(1, 7)]]), *rows]
    yield text("catman ASCII", "\n".join(asc).encode("cp1252"), file="run.asc")
    yield text("DEWESoft", DEWESOFT + csv(_united(table, "{} ({})"), sep=";"))
    types = ["DT_DOUBLE"] * 7
    yield text(
        "DIAdem", "\n".join([";".join(names), ";".join(UNITS), ";".join(types), *[";".join(r) for r in _cells(table, ",")]])
    )
    stamps = [START + timedelta(microseconds=round(1e6 * one)) for one in table["time"]]
    body = [
        f"{k},{one:%Y/%m/%d %H:%M:%S},{one.microsecond // 1000},{','.join(_graphtec(cell) for cell in row[1:])},LLLLLLLLLL"
        for k, (one, row) in enumerate(zip(stamps, table.to_numpy(), strict=True), 1)
    ]
    named = ",".join(["Number", "Date&Time", "ms", *names[1:], "Alarm1-10"])
    yield text("Graphtec", GRAPHTEC + "\n".join([named, "NO.,Time,ms,m,mm,mm,mm,mm,rad/s,A1234567890", *body]))
    famos = "\n".join(["\t".join(names), "\t".join(UNITS), *["\t".join(row) for row in _cells(table, ",")]])
    yield text("FAMOS, tabs", famos)
    keyence = [f'"{one:%Y/%m/%d %H:%M:%S}.{one.microsecond // 1000:03d}",{",".join(row[1:])}'
               for one, row in zip(stamps, _cells(table), strict=True)]  # fmt: skip
    units_of = ",".join(["", *[f'"({one})"' for one in UNITS[1:]]])
    yield text(
        "Keyence",
        "\n".join(['"NR-500"', '"[Data]"', ",".join(f'"{one}"' for one in ["Date/Time", *names[1:]]), units_of, *keyence]),
    )


def _graphtec(value: float) -> str:
    return "BURNOUT" if np.isnan(value) else f"{'-' if value < 0 else '+'}{abs(value):10.4f}"


def oscilloscopes(table: pd.DataFrame) -> Iterator[Variant]:
    """Settings beside the first rows, times as start and increment."""
    cells = _cells(table)
    settings = [
        "Record Length,8.26e+02",
        "Sample Interval,4.0e-02",
        "Trigger Point,0",
        "Source,CH1",
        "Vertical Units,m",
        "Firmware,FV:1.0",
    ]
    beside = [f"{settings[k] if k < len(settings) else ','},,{','.join(row)}" for k, row in enumerate(cells)]
    yield text("settings beside the rows", "\n".join([",,," + ",".join(table.columns), *beside]))
    head = ["X," + ",".join(table.columns[1:]) + ",Start,Increment", "Sequence,m,mm,mm,mm,mm,rad/s,0.0,0.04"]
    yield text("start and increment", "\n".join([*head, *(f"{k},{','.join(row[1:])}," for k, row in enumerate(cells))]))
    waves = ["Model,DPO2024", "Label,a,b,c,d,e,f", "TIME," + ",".join(table.columns[1:])]
    yield text("labels above the names", "\n".join([*waves, *(",".join(row) for row in cells)]))
    before = table.assign(time=table["time"] - 2.0)
    yield text("times before the trigger", csv(_united(before)))


def controllers(table: pd.DataFrame) -> Iterator[Variant]:
    """Rows written on a change, tags with validity, cells kept from the row before."""
    stamps = [START + timedelta(microseconds=round(1e6 * one)) for one in table["time"]]
    long = [
        f'"{name}";"{one:%d.%m.%Y %H:%M:%S}";{f"{value:g}".replace(".", ",")};1;{45998.38 + second / 86400.0:.9f}'.replace(
            "nan", ""
        )
        for one, second, row in zip(stamps, table["time"], table.to_numpy(), strict=True)
        for name, value in zip(table.columns[1:], row[1:], strict=True)
    ]
    yield text("tags of WinCC", "\n".join(['"VarName";"TimeString";"VarValue";"Validity";"Time_ms"', *long]))
    changed = table.copy()
    for name in table.columns[1:]:
        coarse = table[name].round(2)
        changed[name] = coarse.where(coarse.diff().fillna(1.0).abs() > 0.0)
    yield text("cells only where a value changes", csv(changed))
    rounded = table.round({"car_position": 2})
    moves = rounded[rounded["car_position"].diff().fillna(1.0).abs() > 0.0]
    yield text("rows only where the car moves", csv(moves))
    good = table.assign(**{f"{name}_quality": 192 for name in table.columns[1:]})
    yield text("a quality beside each tag", csv(good))
    pulses = np.round(2048 * table["car_position"] / 1.2566).astype(int)
    yield text("pulses of an encoder", csv(table.assign(car_position=pulses)))
    yield text(
        "pulses of an encoder, unit stated",
        csv(table.assign(car_position=pulses).rename(columns={"car_position": "car_position [pulses]"})),
    )
    downward = table.assign(car_position=table["car_position"] - 50.0)
    yield text("car below the top landing", csv(downward))
    yield text("car below the top landing, zero stated", csv(downward), '[car]\nunit = "m"\nzero = -50.0\n')
    feet = [f"{int(one // 0.3048)}' {one % 0.3048 / 0.0254:.2f}\"" for one in table["car_position"].abs()]
    yield text("car in feet and inches", csv(table.assign(car_position=feet)))
    inches = table.assign(cw_low=table["cw_low"] / 25.4).rename(columns={"cw_low": "cw_low [in]"})
    yield text("a laser in inches, stated in the file", csv(inches))
    readings = 'readings = { cw_low = { unit = "in" } }'
    yield text("a laser in inches, stated in both", csv(inches), run_extra=readings)
    only = table.assign(counterweight_position=50.0 - table["car_position"]).drop(columns="car_position")
    yield text("counterweight only", csv(only))
    tenths = table.assign(cw_low=(10.0 * table["cw_low"]).round()).rename(columns={"cw_low": "cw_low [1/10 mm]"})
    yield text("a laser in tenths of a millimetre", csv(tenths))


def programs(table: pd.DataFrame) -> Iterator[Variant]:
    """What statistics and office programs write."""
    indexed = table.to_csv()
    yield text("an unnamed index first", indexed)
    yield text("R", table.fillna(-1e9).to_csv(quoting=2).replace("-1000000000.0", "NA"))
    saved = "# " + " ".join(table.columns) + "\n" + "\n".join(" ".join(f"{one:.18e}" for one in row) for row in table.to_numpy())
    yield text("numpy.savetxt", saved)
    yield text(
        "Markdown",
        "\n".join(
            ["| " + " | ".join(table.columns) + " |", "|" + "---|" * 7, *("| " + " | ".join(row) + " |" for row in _cells(table))]
        ),
    )
    yield text("LaTeX", "\n".join([" & ".join(row) + r" \\" for row in [[*table.columns], *_cells(table)]]))
    yield text("XML", "<run>" + "".join(f"<row t='{row[0]}' car='{row[1]}'/>\n" for row in _cells(table)) + "</run>")
    yield text("SQL", "\n".join(f"INSERT INTO run VALUES ({','.join(one or 'NULL' for one in row)});" for row in _cells(table)))
    broken = csv(table, sep=";", decimal=",").replace("cw_low", '"cw_low\n[mm]"', 1).replace("cw_mid", '"cw_mid\n[mm]"', 1)
    yield text("line breaks in quoted names", broken)
    yield text("Unicode text of Excel", csv(_united(table), sep="\t", decimal=",").encode("utf-16"), file="run.txt")
    french = _united(table).copy()
    french["car_position [m]"] = [f"{1e3 * one:,.1f}".replace(",", "\u202f").replace(".", ",") for one in table["car_position"]]
    french = french.rename(columns={"car_position [m]": "car_position [mm]"})
    yield text("French thousands", csv(french, sep=";", decimal=","))
    widths = table.map(lambda one: " " * 13 if np.isnan(one) else f"{one:13.4f}")
    fixed = "".join(f"{name:>14}" for name in table.columns)
    lines = [" ".join(row) for row in widths.to_numpy()]
    yield text("fixed columns, blank where missing", "\n".join([fixed, *lines]))
    hole = [
        line if not 300 <= k < 330 else " ".join([*widths.iloc[k, :2], " " * 13, *widths.iloc[k, 3:]])
        for k, line in enumerate(lines)
    ]
    yield text("fixed columns, a hole amid", "\n".join([fixed, *hole]))
    torn = csv(table).splitlines()
    torn[400:410] = [one.rsplit(",", 2)[0] for one in torn[400:410]]
    yield text("rows that end early", "\n".join(torn))
