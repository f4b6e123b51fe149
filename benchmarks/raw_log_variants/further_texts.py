"""Further dialects: notations of numbers, shapes of tables and lines that loggers and editors leave in text files."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pandas as pd

from .variant import Variant, csv, inserted, other, text


def number_notations(table: pd.DataFrame) -> Iterator[Variant]:
    """Decimal signs and thousands that can be mistaken for each other, signs and units within cells."""
    three = table.round(3)
    for name, separator in (("semicolons", ";"), ("tabs", "\t")):
        written = csv(three, sep=separator, decimal=",", float_format="%.3f")
        yield replace(text(f"three decimals after a comma, {name}", written), truth=three)
    thousands = table.map(lambda one: "" if pd.isna(one) else f"{one:,.4f}".translate(str.maketrans(",.", ".,")))
    yield text("thousands points and decimal commas", csv(thousands, sep=";"))
    swiss = table.assign(car_position=[f"{1e3 * x:,.1f}".replace(",", "’") for x in table["car_position"]])
    yield text("Swiss thousands", csv(swiss.rename(columns={"car_position": "car_position [mm]"})))
    whole = table.assign(car_position=[f"{1e3 * x:,.0f}" for x in table["car_position"]])
    whole = whole.rename(columns={"car_position": "car_position [mm]"})
    rounded = table.assign(car_position=table["car_position"].round(3))
    yield replace(text("whole millimetres with thousands commas", csv(whole, sep=";")), truth=rounded)
    mixed = csv(table, sep=";").splitlines()
    mixed = [one.replace(".", ",") if k > 400 else one for k, one in enumerate(mixed)]
    yield text("decimal commas from the middle on", "\n".join(mixed))
    part = table.assign(cw_low=[f"{one:.4f}".replace(".", ",") for one in table["cw_low"]])
    yield text("one column with decimal commas", csv(part, sep=";"))
    filled = table.fillna(0.0)
    yield replace(text("plus signs", csv(filled.map(lambda one: f"{one:+.4f}"))), truth=filled)
    behind = filled.map(lambda one: f"{abs(one):.4f}{'-' if one < 0 else ''}")
    yield replace(text("signs behind", csv(behind)), truth=filled)
    brackets = filled.map(lambda one: f"({-one})" if one < 0 else f"{one}")
    yield replace(text("negative numbers in brackets", csv(brackets)), truth=filled)
    yield text("units in the cells", csv(table.assign(cw_low=[f"{one:.4f} mm" for one in table["cw_low"]])))
    yield text("apostrophes before numbers", csv(table.assign(cw_low=[f"'{one:.4f}" for one in table["cw_low"]])))
    yield other("four significant digits", table.map(lambda one: float(f"{one:.4g}")))


def shapes(table: pd.DataFrame) -> Iterator[Variant]:
    """Long and sparse tables, several lines between names and numbers, blocks one below the other."""
    plain = csv(table)
    lines = plain.splitlines()
    long = table.melt("time", var_name="channel").dropna().sort_values("time", kind="stable")
    yield text("one value a row", csv(long))
    sparse = pd.concat([table[["time", name]] for name in table.columns[1:]]).sort_values("time", kind="stable")
    yield text("one channel a row", csv(sparse))
    odd = table.copy()
    odd.loc[1::2, "car_position"] = np.nan
    odd.loc[0::2, list(table.columns[2:])] = np.nan
    yield other("car and channels in turn", odd)
    yield text("a row of calibration factors below the names", "\n".join([lines[0], "1,1,1,1,1,1,1", *lines[1:]]))
    yield text("descriptions and units below the names", "\n".join(
        [lines[0], "clock,encoder,laser 1,laser 2,laser 3,wire,gyro", "s,m,mm,mm,mm,mm,rad/s", *lines[1:]]))  # fmt: skip
    yield text("two records one below the other", plain + "\n" + plain)
    second = table.assign(time=table["time"] + 60.0)
    yield text("a second record later, with a header", plain + "\n" + csv(second))
    yield text("newest row first", csv(table[::-1]))
    yield text("blocks for each channel", "\n".join(csv(table[["time", name]]) for name in table.columns[1:]))
    rows = [lines[0].replace(",", "\t"), *(one.replace(",", "\t") for one in lines[1:])]
    yield text("500 lines above", "\n".join([*(f"# setting {k} = {k}" for k in range(500)), *rows]))
    pages = ["\n".join(["\f" + lines[0], *lines[k : k + 50]]) for k in range(1, len(lines), 50)]
    yield text("page breaks", "\n".join(pages))
    yield text("CR CR LF", plain.replace("\n", "\r\r\n"))
    yield text("zeros after the table", plain.encode() + bytes(4096))
    yield text("zeros within the table", "\n".join(lines[:400]).encode() + bytes(64) + "\n".join(["", *lines[400:]]).encode())
    yield text("a BOM within", "\n".join(lines[:300]) + "\n\ufeff" + "\n".join(lines[300:]))
    quoted = plain.replace("sheave_dx", '"dx, sheave"', 1)
    yield text("names with commas, quoted", quoted, run_extra='columns = { sheave_dx = "dx, sheave" }')
    yield text("names with hard blanks", plain.replace("cw_low", "cw\u00a0low", 1))
    yield text("names that differ in case only", csv(inserted(table, 4, "CW_LOW", 7.0 + table["cw_mid"])))
    yield text("an HTML table", table.to_html(index=False))
    yield text("JSON lines", table.to_json(orient="records", lines=True))
    yield text("words for true and false", csv(table.assign(door=np.where(table.index % 2, "TRUE", "FALSE"))))
