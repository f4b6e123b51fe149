"""Units, missing values and faults of instruments."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pandas as pd

from .variant import Variant, csv, text


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
