"""All causes in one table: kind, what is drawn and from where, and what it does.

Sizes go from barely visible to large. A cause acts by fields of `Tower`, on the `Excitation` (`ends.py`), on one channel
(`instruments.py`), or on the files (`faults.py`). `effect` is the library's name of it where that differs; `near` names
effects of the library that come close to one outside it.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from . import ends, instruments
from .ends import Act
from .instruments import Fault

TURN = 2.0 * np.pi


@dataclass(frozen=True)
class Draw:
    """A quantity to draw: log-uniform (or even) between two values, or with either sign."""

    low: float
    high: float
    even: bool = False
    signed: bool = False
    tall: bool = False  # a height in a shaft of 50 m, in others in proportion

    def value(self, rng: np.random.Generator, tall: float, level: float | None = None) -> float:
        """A drawn value, or the one at a level between 0 (barely visible) and 1 (large), in a shaft so `tall`."""
        level = float(rng.uniform()) if level is None else level
        size = self.low + level * (self.high - self.low) if self.even else self.low * (self.high / self.low) ** level
        return float(size * (tall if self.tall else 1.0) * (rng.choice((-1.0, 1.0)) if self.signed else 1.0))


@dataclass(frozen=True)
class Cause:
    """A cause: `size` is drawn from small to large, `beside` what else it needs."""

    kind: str
    size: Mapping[str, Draw] = field(default_factory=dict)
    beside: Mapping[str, Draw] = field(default_factory=dict)
    fields: Mapping[str, str] = field(default_factory=dict)  # the tower's name of a quantity, where it has one
    excitation: Act | None = None
    channel: Fault | None = None
    quantities: tuple[str, ...] = ()  # of the channels that it may hit
    near: tuple[str, ...] = ()
    effect: str = ""

    def values(self, rng: np.random.Generator, tall: float, level: float | None = None) -> dict[str, float]:
        """All that the cause needs, drawn; sizes at `level` where it is given."""
        return {name: one.value(rng, tall, level) for name, one in self.size.items()} | {
            name: one.value(rng, tall) for name, one in self.beside.items()
        }


def tower(kind: str, size: Mapping[str, Draw], beside: Mapping[str, Draw] | None = None, near: tuple[str, ...] = (),
          effect: str = "", **renamed: str) -> Cause:  # fmt: skip
    """A cause that is a matter of the tower's fields, `renamed` where the library has other names."""
    names = {**size, **(beside or {})}
    return Cause(kind, size, beside or {}, {name: renamed.get(name, name) for name in names}, near=near, effect=effect)


PHASE = Draw(0.0, TURN, even=True)
LATERAL, TURNING = ("lateral_displacement",), ("sheave_angular_velocity",)
LENGTHS = (*LATERAL, "sheave_displacement")
EVERY = (*LENGTHS, *TURNING, "sheave_force", "car_end_tension", "counterweight_end_tension")
CAUSES: dict[str, Cause] = {
    "nothing": Cause("nothing"),
    # in the library
    "air_drag": tower("known", {"drag_coefficient": Draw(100.0, 3000.0)}, drag_coefficient="drag"),
    "shaft_airflow": tower(
        "known", {"crossflow_ratio": Draw(0.05, 1.0, signed=True)}, {"drag_coefficient": Draw(1.0, 1.2)},
        crossflow_ratio="crossflow", drag_coefficient="drag",
    ),
    "bending_hysteresis": tower(
        "known", {"friction_moment": Draw(0.2, 4.0)}, {"yield_curvature": Draw(0.05, 1.0)},
        friction_moment="dahl_moment", yield_curvature="dahl_curvature",
    ),
    "intrinsic_curvature": tower("known", {"curvature": Draw(0.02, 0.6)}, curvature="set_curvature"),
    "sheave_eccentricity": tower(
        "known", {"eccentricity": Draw(3e-5, 5e-3)}, {"phase": PHASE, "crept": Draw(0.0, 0.5, even=True)},
        phase="eccentric_phase",
    ),
    "bearing_friction": tower("known", {"coulomb_torque": Draw(1.0, 30.0)}, coulomb_torque="bearing_coulomb"),
    "guide_friction": tower("known", {"coulomb_force": Draw(0.5, 80.0)}, coulomb_force="guide_coulomb"),
    "sheave_damper": tower("known", {"damping": Draw(1e3, 3e5)}, damping="guide_damping"),
    "building_sway": Cause(
        "known", {"amplitude": Draw(1e-4, 3e-2)}, {"frequency": Draw(0.1, 0.9), "phase": PHASE}, excitation=ends.building_sway,
    ),
    "attachment_offset": Cause(
        "known", {"car": Draw(1e-3, 3e-2, signed=True), "counterweight": Draw(1e-3, 3e-2, signed=True)},
        excitation=ends.attachment_offset,
    ),
    "encoder_scale": Cause("known", {"excess": Draw(1e-4, 1e-2, signed=True)}, excitation=ends.encoder_scale),
    "unbalance": tower(
        "known", {"unbalance": Draw(0.02, 1.5)}, {"unbalance_phase": PHASE}, effect="sheave_unbalance",
    ),
    "brush": tower(
        "known", {"brush_stiffness": Draw(0.5, 1e3)},
        {"brush_height": Draw(1.0, 9.0, tall=True), "brush_side": Draw(1.0, 1.0, signed=True), "brush_damping": Draw(1.0, 20.0)},
        effect="rope_brush",
    ),
    "rubbing_wall": tower(
        "known", {"wall_distance": Draw(3e-3, 4e-2)},
        {"wall_height": Draw(3.0, 9.5, tall=True), "wall_side": Draw(1.0, 1.0, signed=True), "wall_stiffness": Draw(1e5, 4e5),
         "wall_friction": Draw(0.1, 0.4)},
        effect="rope_guide",
    ),
    "sticky_guide": tower(
        "known", {"guide_coulomb": Draw(0.3, 30.0), "breakaway": Draw(0.6, 60.0)}, {"stribeck_velocity": Draw(1e-3, 4e-3)},
    ),
    "jammed_seal": tower("known", {"seal_stiffness": Draw(5e-3, 0.3)}),
    "sloped_guide": tower("known", {"guide_slope": Draw(0.1, 1.5, signed=True)}),
    # the instrument; offset, drift and unit in SI
    "sensor_gain": Cause(
        "instrument", {"excess": Draw(0.02, 0.2, signed=True)}, channel=instruments.sensor_gain, quantities=EVERY
    ),
    "sensor_offset": Cause(
        "instrument", {"offset": Draw(5e-3, 0.2, signed=True)}, channel=instruments.sensor_offset, quantities=TURNING
    ),
    "sensor_delay": Cause("instrument", {"delay": Draw(0.01, 0.1)}, channel=instruments.sensor_delay, quantities=LATERAL),
    "sensor_height": Cause("instrument", {"error": Draw(0.05, 0.5, signed=True)}, quantities=LATERAL),
    # outside the library
    "rail_waves": Cause("outside", {"size": Draw(5e-4, 6e-3)}, {"shift": Draw(0.0, 5.0, even=True)}, excitation=ends.rail_waves),
    "gusts": Cause("outside", {"size": Draw(5e-5, 1e-2)}, excitation=ends.gusts, near=("building_sway",)),
    "counterweight_bounce": Cause(
        "outside", {"frequency": Draw(5.0, 1.0)}, {"damping_ratio": Draw(0.01, 0.1)}, excitation=ends.counterweight_bounce,
    ),
    "splice": Cause(
        "outside", {"excess": Draw(0.01, 0.2, signed=True)}, {"place": Draw(0.2, 0.8, even=True)}, excitation=ends.splice,
    ),
    "warming": Cause("outside", {"strain": Draw(4e-6, 2e-4, signed=True)}, excitation=ends.warming),
    "car_bounce": Cause(
        "outside", {"frequency": Draw(8.0, 1.5)}, {"damping_ratio": Draw(0.01, 0.1)}, excitation=ends.car_bounce,
        near=("encoder_scale",),
    ),
    "leaning_car": Cause(
        "outside", {"size": Draw(1e-3, 4e-2, signed=True)}, {"frequency": Draw(1.0, 3.0)}, excitation=ends.leaning_car,
        near=("attachment_offset",),
    ),
    "knock": Cause("outside", {"size": Draw(5e-4, 2e-2, signed=True)}, {"seconds": Draw(0.2, 0.8)}, excitation=ends.knock),
    # the data
    "sensor_drift": Cause(
        "data", {"per_minute": Draw(5e-4, 1e-2, signed=True)}, channel=instruments.sensor_drift, quantities=LATERAL
    ),
    "wrong_sign": Cause("data", channel=instruments.wrong_sign, quantities=EVERY),
    "wrong_unit": Cause("data", {"factor": Draw(0.1, 0.1)}, channel=instruments.wrong_unit, quantities=LENGTHS),
    "uneven_sampling": Cause("data", {"jitter": Draw(0.1, 0.45)}),
    "gaps": Cause("data", {"seconds": Draw(0.3, 3.0)}),
    "outliers": Cause("data", {"share": Draw(3e-4, 1e-2)}, {"times_noise": Draw(10.0, 200.0)}),
    "clock_offset": Cause("data", {"seconds": Draw(0.005, 0.1, signed=True)}),
    "wrong_noise": Cause("data", {"stated_over_true": Draw(0.5, 2.0)}),
}  # fmt: skip
