"""Text files of oscilloscopes, recorders and LabVIEW, and other shapes of texts."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from .automation import cells_of, stamps_of
from .loggers import UNITS
from .variant import Variant, csv, text

LABVIEW = (
    "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\n"
    "Multi_Headings\tNo\nX_Columns\tOne\nTime_Pref\tAbsolute\nOperator\tmax\nDate\t2026/11/02\n"
    "Time\t09:12:01,123\n***End_of_Header***\t\n\t\nChannels\t6\t\t\t\t\t\t\n"
    "Samples\t826\t826\t826\t826\t826\t826\t\nY_Unit_Label\tm\tmm\tmm\tmm\tmm\trad/s\t\n"
    "X_Dimension\tTime\tTime\tTime\tTime\tTime\tTime\t\nX0\t0\t0\t0\t0\t0\t0\t\n"
    "Delta_X\t0,04\t0,04\t0,04\t0,04\t0,04\t0,04\t\n***End_of_Header***\t\t\t\t\t\t\t\n"
)


def scopes(table: pd.DataFrame) -> Iterator[Variant]:
    """Oscilloscopes and scanners."""
    names, cells, stamps = [*table.columns], cells_of(table), stamps_of(table)
    pico = [",".join([f"{1e3 * float(row[0]):.8f}", *[one or "∞" for one in row[1:]]]) for row in cells]
    yield text(
        "PicoScope", "\n".join([",".join(["Time", *names[1:]]), ",".join(f"({one})" for one in ["ms", *UNITS[1:]]), "", *pico])
    )
    keysight = [
        "\t".join([str(k), f"{one:%m/%d/%Y %H:%M:%S}:{one.microsecond // 1000:03d}", *row[1:]])
        for k, (one, row) in enumerate(zip(stamps, cells, strict=True), 1)
    ]
    named = ["Scan", "Time", *[f"{name} ({unit})" for name, unit in zip(names[1:], UNITS[1:], strict=True)]]
    yield text(
        "Keysight BenchLink, UTF-16",
        "\n".join(
            ["Name:\trun", "Owner:\tmax", "Acquisition Date:\t11/2/2026 9:12:01 AM", "", "\t".join(named), *keysight]
        ).encode("utf-16"),
    )
    scope = ["x-axis,1,2,3,4,5,6", "second,Volt,Volt,Volt,Volt,Volt,Volt"]
    yield text(
        "InfiniiVision", "\n".join([*scope, *(",".join(f"{float(one):+.8E}" if one else "" for one in row) for row in cells)])
    )


def recorders(table: pd.DataFrame) -> Iterator[Variant]:
    """Transient recorders."""
    names, cells = [*table.columns], cells_of(table)
    yoko = [
        '"Header Size",12',
        '"Model Name","DL850E"',
        '"BlockNumber",1',
        '"TraceName",' + ",".join(f'"{one}"' for one in names[1:]),
        '"BlockSize",' + ",".join(["826"] * 6),
        '"VUnit",' + ",".join(f'"{one}"' for one in UNITS[1:]),
        '"SampleRate",' + ",".join(["2.5000000E+01"] * 6),
        '"HResolution",' + ",".join(["4.0000000E-02"] * 6),
        '"HOffset",' + ",".join(["0.0"] * 6),
        '"HUnit",' + ",".join(['"s"'] * 6),
        '"Date",' + ",".join(['"2026/11/02"'] * 6),
        "",
    ]
    yield text("Yokogawa DL850", "\n".join([*yoko, *("," + ",".join(row[1:]) for row in cells)]))
    hioki = [
        '"HIOKI 8870 ASCII CSV","Ver 1.00"',
        '"Title","run"',
        '"Trigger Time","\'26-11-02 09:12:01"',
        ",".join(['"Time[s]"', *[f'"{n}[{u}]"' for n, u in zip(names[1:], UNITS[1:], strict=True)]]),
    ]
    yield text(
        "Hioki", "\n".join([*hioki, *(",".join(f"{float(one):+.5E}" if one else '"-----"' for one in row) for row in cells)])
    )


def programs_of_instruments(table: pd.DataFrame) -> Iterator[Variant]:
    """LabVIEW and its relatives, with times once or beside each channel."""
    names, cells, comma = [*table.columns], cells_of(table), cells_of(table, ",")
    pairs = ",".join(f"Time - {one} (Filtered),Amplitude - {one} (Filtered)" for one in names[1:])
    yield text(
        "SignalExpress, times beside each channel",
        "\n".join([pairs, *(",".join(f"{row[0]},{one}" for one in row[1:]) for row in cells)]),
    )
    pairs = ",".join(f"Time_{one},{one}" for one in names[1:])
    yield text(
        "times named by their channels", "\n".join([pairs, *(",".join(f"{row[0]},{one}" for one in row[1:]) for row in cells)])
    )
    yield text(
        "LabVIEW, decimal commas, units in the header",
        LABVIEW + "\n".join(["\t".join(["X_Value", *names[1:], "Comment"]), *("\t".join(row) for row in comma)]),
        file="run.lvm",
    )
    yield text(
        "LabVIEW, no X column",
        LABVIEW.replace("X_Columns\tOne", "X_Columns\tNo")
        + "\n".join(["\t".join(["X_Value", *names[1:], "Comment"]), *("\t".join(["", *row[1:]]) for row in comma)]),
        file="run.lvm",
    )


def unusual_rows(table: pd.DataFrame) -> Iterator[Variant]:
    """Rows that are no list of cells, or have others amid."""
    names, cells = [*table.columns], cells_of(table)
    yield text("no separator but colons", "\n".join(f"t:{row[0]} car:{row[1]} cw_low:{row[2]}" for row in cells))
    yield text(
        "keys and values in each row", "\n".join(", ".join(f"{n}={c}" for n, c in zip(names, row, strict=True)) for row in cells)
    )
    yield text(
        "rows of an Arduino, with a greeting amid",
        "\n".join(
            [",".join(names), *[",".join(row) for row in cells[:400]], "Logger ready", *[",".join(row) for row in cells[400:]]]
        ),
    )
    yield text(
        "Vector ASC",
        "date Mon Nov 2 09:12:01.123 am 2026\nbase hex  timestamps absolute\n"
        + "\n".join(f"   {row[0]} 1  1A0             Rx   d 8 00 11 22 33 44 55 66 77" for row in cells),
    )


def unusual_headers(table: pd.DataFrame) -> Iterator[Variant]:
    """More columns, units and lines than those of the plain file."""
    names, cells = [*table.columns], cells_of(table)
    yield text("statistics below each column", csv(table) + "\nMin,0,-0.3\nMax,45,12.1\nMean,20.1,0.2\n")
    yield text("statistics above the header", "Min;0;-0.3;0;0;0;0\nMax;33;45;1;2;3;4\n" + csv(table, sep=";"))
    yield text(
        "two headers, raw and scaled",
        csv(pd.concat([table, table.drop(columns="time").multiply(0.1).add_suffix("_raw")], axis=1)),
    )
    yield text(
        "a unit row in German",
        "Zeit;car_position;cw_low;cw_mid;car_low;sheave_dx;sheave_w\nSekunden;Meter;Millimeter;Millimeter;Millimeter;Millimeter;1/s\n"
        + csv(table, sep=";", decimal=",").split("\n", 1)[1],
    )
    indexed = table.copy()
    indexed.insert(0, "Index", np.arange(1, 827))
    yield text("an index and a time", csv(indexed))
    yield text("time last", csv(table[[*names[1:], "time"]]))
    yield text("a data row with two units", csv(table.rename(columns={"cw_low": "cw_low [mm] [V]"})))
    yield text(
        "percent signs as comments",
        "% run\n% time car_position cw_low cw_mid car_low sheave_dx sheave_w\n"
        + "\n".join(" ".join(one or "NaN" for one in row) for row in cells),
    )


def grouped_digits(table: pd.DataFrame) -> Iterator[Variant]:
    """Points between thousands."""
    cells = cells_of(table)
    yield text(
        "semicolons and decimal commas, thousands in time",
        csv(
            table.assign(time=[f"{1e3 * one:,.0f}".replace(",", ".") for one in table["time"]]).rename(
                columns={"time": "time [ms]"}
            ),
            sep=";",
            decimal=",",
        ),
    )
    yield text(
        "whole numbers with thousands points",
        csv(
            table.assign(car_position=[f"{1e3 * one:,.0f}".replace(",", ".") for one in table["car_position"]]),
            sep=";",
            decimal=",",
        ),
    )
    yield text(
        "whole numbers with thousands points, lasers without decimals",
        "time;car_position;cw_low\n"
        + "\n".join(
            f"{round(1e3 * float(r[0]))};{round(1e3 * float(r[1])):,};{round(float(r[2]))}".replace(",", ".") for r in cells
        ),
    )
