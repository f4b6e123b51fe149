"""Exports of automation systems and databases: TwinCAT, Siemens, Rockwell, Influx, Campbell, ticks of their clocks."""

from collections.abc import Iterator
from datetime import timedelta

import numpy as np
import pandas as pd

from .loggers import UNITS
from .variant import START, Variant, csv, text

FILETIME = 116_444_736_000_000_000  # ticks of 100 ns from 1601 to 1970
DOTNET = 621_355_968_000_000_000  # the same from the year 1
SCOPE = (
    "Name;Scope YT Project\nFile;C:\\Scope\\run.tcscopex\nStarttime of export;134060911211230000\n"
    "Endtime of export;134060911541630000\n\n"
)


def stamps_of(table: pd.DataFrame) -> list[pd.Timestamp]:
    """Date and time of each row."""
    return [START + timedelta(microseconds=round(1e6 * one)) for one in table["time"]]


def cells_of(table: pd.DataFrame, decimal: str = ".") -> list[list[str]]:
    """Texts of all cells, empty where there is no value."""
    return [["" if np.isnan(one) else f"{one:.10g}".replace(".", decimal) for one in row] for row in table.to_numpy()]


def automation(table: pd.DataFrame) -> Iterator[Variant]:
    """Controllers and their tools."""
    names = [*table.columns]
    cells, stamps = cells_of(table), stamps_of(table)
    for title, factor in (("ms", 1e3), ("ticks of 100 ns", 1e7)):
        rows = ["\t".join(f"{round(factor * float(row[0]))}\t{cell}" for cell in row[1:]) for row in cells]
        head = [
            "\t".join(f"{key}\t{value(k)}" for k in range(1, 7))
            for key, value in (
                ("Name", lambda k: names[k]),
                ("SymbolName", lambda k: f"MAIN.{names[k]}"),
                ("Port", lambda k: "851"),
                ("Data-Type", lambda k: "LREAL"),
                ("SampleTime[ms]", lambda k: "40"),
                ("Offset", lambda k: "0"),
                ("ScaleFactor", lambda k: "1"),
                ("Unit", lambda k: UNITS[k]),
            )
        ]
        yield text(f"TwinCAT Scope, times in {title} beside each channel", SCOPE + "\n".join([*head, *rows]))
    log = [
        f"{k},{one:%m/%d/%Y},{one:%H:%M:%S},{one.microsecond // 1000},{','.join(row[1:])}"
        for k, (one, row) in enumerate(zip(stamps, cells, strict=True), 1)
    ]
    yield text("Siemens data log", "\n".join([",".join(["Record", "Date", "UTC Time", "Milliseconds", *names[1:]]), *log]))
    rockwell = [
        f"{one:%m/%d/%Y},{one:%H:%M:%S},{one.microsecond // 1000},{','.join(row[1:])}"
        for one, row in zip(stamps, cells, strict=True)
    ]
    yield text("Rockwell, Millitm", "\n".join([",".join(["Date", "Time", "Millitm", *names[1:]]), *rockwell]))
    iec = [f"T#{round(1e3 * float(row[0]))}ms;{';'.join(row[1:])}" for row in cells]
    yield text("times as literals of IEC 61131", "\n".join([";".join(names), *iec]))
    for title, zero in (("Windows", FILETIME), (".NET", DOTNET)):
        ticks = [zero + 17_936_107_211_230_000 + round(1e7 * one) for one in table["time"]]
        yield text(f"times in ticks of {title}", csv(table.assign(time=ticks)))
    yield text("times in ticks of 0.1 ms", csv(table.assign(time=(1e4 * table["time"]).round().astype(int))))
    yield text("times in hundredths", csv(table.assign(time=(1e2 * table["time"]).round().astype(int))))
    yield text(
        "times in ticks of 0.1 ms, without the sheave",
        csv(table.assign(time=(1e4 * table["time"]).round().astype(int)).drop(columns="sheave_w")),
    )


def campbell(table: pd.DataFrame) -> Iterator[Variant]:
    """Table-oriented ASCII with quoted headers and stamps."""
    names, cells, stamps = [*table.columns], cells_of(table), stamps_of(table)
    toa5 = [
        '"TOA5","CR1000X","CR1000X","1234","CR1000X.Std.05","CPU:run.CR1X","55555","Fast"',
        ",".join(f'"{one}"' for one in ["TIMESTAMP", "RECORD", *names[1:]]),
        ",".join(f'"{one}"' for one in ["TS", "RN", *UNITS[1:]]),
        ",".join(f'"{one}"' for one in ["", "", *["Smp"] * 6]),
    ]
    quoted = [[cell or '"NAN"' for cell in row] for row in cells]
    toa5 += [
        f'"{str(one)[:-3] if one.microsecond else str(one)}",{k},{",".join(row[1:])}'
        for k, (one, row) in enumerate(zip(stamps, quoted, strict=True))
    ]
    yield text("Campbell TOA5", "\n".join(toa5))


def databases(table: pd.DataFrame) -> Iterator[Variant]:
    """Long tables with one row for each value, as databases export them."""
    names, stamps = [*table.columns[1:]], stamps_of(table)
    values = [
        [(name, value) for name, value in zip(names, row[1:], strict=True) if not np.isnan(value)] for row in table.to_numpy()
    ]
    flux = [
        f",,{names.index(name)},{one.isoformat(timespec='milliseconds')}Z,{value},value,{name}"
        for one, row in zip(stamps, values, strict=True)
        for name, value in row
    ]
    yield text(
        "InfluxDB",
        "\n".join(
            [
                "#group,false,false,false,false,true,true",
                "#datatype,string,long,dateTime:RFC3339,double,string,string",
                "#default,_result,,,,,",
                ",result,table,_time,_value,_field,_measurement",
                *flux,
            ]
        ),
    )
    series = [
        f'"{name}";"{one.isoformat(sep=" ", timespec="milliseconds")}";{value}'
        for k, name in enumerate(names)
        for one, row in zip(stamps, table.to_numpy(), strict=True)
        if not np.isnan(value := row[k + 1])
    ]
    yield text("Grafana, a series after the other", "\n".join(['"Series";"Time";"Value"', *series]))
    tags = [
        f"{one:%d.%m.%Y %H:%M:%S.%f};{name};{str(value).replace('.', ',')};Good"
        for one, row in zip(stamps, values, strict=True)
        for name, value in row
    ]
    yield text("historian with tags and qualities", "\n".join(["Timestamp;TagName;Value;Quality", *tags]))
    units = dict(zip(names, UNITS[1:], strict=True))
    united = [
        f"{time},{name},{value},{units[name]}" for time, row in zip(table["time"], values, strict=True) for name, value in row
    ]
    yield text("long table with units", "\n".join(["time,variable,value,unit", *united]))
    yield text("pandas melt", csv(table.melt("time").dropna()))
    numbered = [
        f"{time},{names.index(name) + 1},{value}" for time, row in zip(table["time"], values, strict=True) for name, value in row
    ]
    yield text("long table with numbers of channels", "\n".join(["time,channel,value", *numbered]))
