"""Further units and faults: wrong statements about units, counters that overflow, blind lasers, spikes, unsigned speeds."""

from collections.abc import Iterator

import numpy as np
import pandas as pd

from .variant import Variant, csv, other, text


def stated_wrongly(table: pd.DataFrame) -> Iterator[Variant]:
    """Units that a file states and does not use, other origins, and counters of encoders."""
    car = table["car_position"]
    yield text("car in m, called mm", csv(table.rename(columns={"car_position": "car_position [mm]"})))
    counts = np.round(1e4 * car).astype(int)
    yield text("car in counts of 16 bits", csv(table.assign(car_position=counts % 65536)), '[car]\nunit = "m"\nscale = 0.0001\n')
    yield text("car in per cent", csv(table.assign(car_position=2.0 * car)))
    yield text("car above the sea", csv(table.assign(car_position=car + 412.3)))
    yield text("car as a landing", csv(table.assign(car_position=np.round(car / 3.0))))
    yield text("car to a decimetre", csv(table.assign(car_position=car.round(1))))
    yield text("car to a centimetre", csv(table.assign(car_position=car.round(2))))
    yield text("car zero when lost", csv(table.assign(car_position=np.where(table.index % 97 == 50, 0.0, car))))
    second = (table.index > 400) & (table.index < 425)
    yield text("car lost for a second", csv(table.assign(car_position=np.where(second, 0.0, car))))
    yield text("car held for a second", csv(table.assign(car_position=np.where(second, car[400], car))))
    yield text("car with a slip of a metre", csv(table.assign(car_position=car - 1.0 * (table.index > 420))))
    yield text("car with a slip of 5 cm", csv(table.assign(car_position=car - 0.05 * (table.index > 420))))
    yield text("car late by half a second", csv(table.assign(car_position=np.interp(table["time"] - 0.5, table["time"], car))))
    yield text("counterweight called car", csv(table.assign(car_position=50.0 - car)))
    both = table.assign(counterweight_position=car)
    yield text("counterweight with the car's position", csv(both))
    yield text("counterweight counted from its start", csv(table.assign(counterweight_position=car[0] - car)))
    yield text("a laser in cm", csv(table.assign(cw_low=0.1 * table["cw_low"])))
    yield text("a laser in um", csv(table.assign(cw_low=1e3 * table["cw_low"])))


def blind_and_broken(table: pd.DataFrame) -> Iterator[Variant]:
    """What lasers and gyros show when they see nothing, and how they break."""
    mid, low, w = table["cw_mid"], table["cw_low"], table["sheave_w"]
    seen = mid.notna()
    last = float(mid[seen].iloc[-1])
    shown = {"zero": 0.0, "its range": 50.0, "minus its range": -50.0, "its last value": last, "-3276.8": -3276.8}
    for name, value in shown.items():
        yield text(f"a blind laser shows {name}", csv(table.assign(cw_mid=np.where(seen, mid, value))))
    at = np.random.default_rng(7).choice(len(table), 12, replace=False)
    spiked = low.to_numpy(copy=True)
    spiked[at] += 60.0
    yield text("single spikes in a laser", csv(table.assign(cw_low=spiked)))
    pair = low.to_numpy(copy=True)
    pair[500:502] = -999.0
    yield text("a sentinel twice", csv(table.assign(cw_low=pair)))
    jumped = np.where(table["time"] > 15.0, low + 12.0, low)
    yield text("a laser is knocked", csv(table.assign(cw_low=jumped)))
    yield text("a laser clipped on both sides", csv(table.assign(cw_low=low.clip(-5.0, 5.0))))
    yield other("a laser of coarse resolution", table.assign(cw_low=(low / 2.0).round() * 2.0))
    yield text("a turning sheave in deg/s", csv(table.assign(sheave_w=w * 180.0 / np.pi)))
    yield text("a turning sheave in turns a second", csv(table.assign(sheave_w=w / (2.0 * np.pi))))
    yield other("a turning sheave of pulses", table.assign(sheave_w=(w / 0.5).round() * 0.5))
    yield text("a turning sheave with an offset", csv(table.assign(sheave_w=w + 0.5)))
    yield text("the sheave's displacement in m", csv(table.assign(sheave_dx=1e-3 * table["sheave_dx"])))
    empty = dict.fromkeys(table.columns[2:], np.nan)
    yield text("all channels empty", csv(table.assign(**empty)))
    yield text("all channels flat", csv(table.assign(**dict.fromkeys(empty, 1.0))))
    yield other("half a second of rest", table[table["time"] >= first_motion(table) - 0.5])
    yield other("no sample after the stop", table[: len(table) - 180])


def first_motion(table: pd.DataFrame) -> float:
    """Time [s] at which the car has moved by 2 cm."""
    moved = np.abs(table["car_position"] - table["car_position"].iloc[0]) > 0.02
    return float(table["time"][moved].iloc[0])
