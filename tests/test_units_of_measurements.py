"""Units of measured channels, each against its definition."""

import math
from dataclasses import replace

import numpy as np
import pytest

from comprope_system.identification.data.runs import Channel
from comprope_system.measurements.motion.anchoring import Landings
from comprope_system.measurements.runs.end_motions import EndSignals, recover_ends
from comprope_system.measurements.runs.motion_column import MotionSignal
from comprope_system.measurements.units import UNITS

# What one unit is in SI units: a turn is 2 pi rad, a degree the 360th part of it, a minute 60 s.
SIZES = {
    "m": 1.0, "cm": 0.01, "mm": 0.001, "um": 0.000001, "in": 0.0254,
    "rad/s": 1.0, "deg/s": 2.0 * math.pi / 360.0, "rpm": 2.0 * math.pi / 60.0, "1/min": 2.0 * math.pi / 60.0,
    "N": 1.0, "kN": 1000.0, "kgf": 9.80665, "lbf": 0.45359237 * 9.80665,
}  # fmt: skip


@pytest.mark.parametrize(("quantity", "unit"), [(quantity, unit) for quantity, units in UNITS.items() for unit in units])
def test_a_unit_is_as_large_as_it_is_defined(quantity: str, unit: str) -> None:
    channel = Channel(column="x", quantity=quantity, unit=unit)
    assert channel.scale == pytest.approx(SIZES[unit], rel=1e-15)


def test_every_quantity_has_units_of_its_own_kind() -> None:
    alike = (("m", "cm", "mm", "um", "in"), ("rad/s", "deg/s", "rpm", "1/min"), ("N", "kN", "kgf", "lbf"))
    kinds = {unit: kind for kind, units in enumerate(alike) for unit in units}
    expected = {"displacement": 0, "velocity": 1, "force": 2, "tension": 2}
    for quantity, units in UNITS.items():
        assert {kinds[unit] for unit in units} == {expected[quantity.rsplit("_", 1)[-1]]}, quantity


def test_the_counterweight_mirrors_the_car_in_the_shaft_or_follows_its_own_column() -> None:
    time = [0.02 * k for k in range(100)]
    signal = MotionSignal(np.array(time), np.full(100, 3.0), "position", "car_position")
    ends = recover_ends(EndSignals(signal, None, {}), 14.0, "auto", Landings(), "run.csv")
    assert (float(ends.car.position(1.0)), float(ends.counterweight.position(1.0))) == pytest.approx((3.0, 11.0), abs=1e-9)
    assert not ends.counterweight.velocity(1.0)
    other = replace(signal, value=np.full(100, 10.5), column="counterweight_position")
    own = recover_ends(EndSignals(signal, other, {}), 14.0, "auto", Landings(), "run.csv")
    assert float(own.counterweight.position(1.0)) == pytest.approx(10.5, abs=1e-9)
    (remark,) = own.remarks
    assert remark.startswith("counterweight_position: with the car's height it adds up to 13.5 m")
