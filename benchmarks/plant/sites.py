"""The places where campaigns are made: a tower, its trips, what is measured there, and how well.

Every sensor sees rope while the car waits for its trip: what counts from rest has a rest to count from.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .tower import Tower
from .trip import Limits

HEIGHT = 50.0  # m, of the shaft for which heights of causes are drawn


@dataclass(frozen=True)
class Run:
    """From where to where the car goes [m], with what share of the sheave's mass, and what the run is for."""

    start: float
    stop: float
    share: float
    role: str = "fit"


@dataclass(frozen=True)
class Channel:
    """A column: its quantity as campaigns call it, what the plant calls it, and how it is written; noise in its unit."""

    quantity: str
    source: str
    unit: str
    scale: float  # the column's units per SI unit
    noise: float
    reference: str = "rest"  # or "absolute"


@dataclass(frozen=True)
class Site:
    """A place: its tower as built to plan, trips, runs, sensors (side -1 car, +1 counterweight, and height) and channels."""

    name: str
    title: str
    tower: Tower
    limits: Limits
    runs: Mapping[str, Run]
    sensors: Mapping[str, tuple[float, float]]
    channels: Mapping[str, Channel]
    every: int = 2  # the plant's steps from one row to the next
    encoder: float = 5e-4  # m, noise of the car's position

    @property
    def noise(self) -> dict[str, float]:
        """The noise of each channel, in the units of the files."""
        return {column: channel.noise for column, channel in self.channels.items()}

    @property
    def tall(self) -> float:
        """The shaft's height over the one for which heights of causes are drawn."""
        return self.tower.height / HEIGHT

    def columns(self, quantities: tuple[str, ...]) -> list[str]:
        """The columns that hold one of some quantities."""
        return [column for column, channel in self.channels.items() if channel.quantity in quantities]


def laser(source: str, noise: float) -> Channel:
    """A column of millimetres by a sensor in the shaft."""
    return Channel("lateral_displacement", source, "mm", 1e3, noise)


TOWER50 = Site(
    "tower50", "50 m tower", Tower(), Limits(2.5, 0.8, 0.8),
    runs={
        "up_nominal": Run(0.0, 45.0, 1.0),
        "up_light": Run(0.0, 45.0, 0.5),
        "down_nominal": Run(38.0, 0.0, 1.0),
        "up_short": Run(2.0, 32.0, 0.75, "validate"),
    },
    sensors={"cw_low": (1.0, 0.5), "cw_mid": (1.0, 10.0), "car_low": (-1.0, -0.8)},
    channels={
        **{name: laser(name, 0.2) for name in ("cw_low", "cw_mid", "car_low")},
        "sheave_dx": Channel("sheave_displacement", "axle", "mm", 1e3, 0.02),
        "sheave_w": Channel("sheave_angular_velocity", "omega", "rad/s", 1.0, 0.01, "absolute"),
    },
)  # fmt: skip
OFFICE28 = Site(
    "office28", "28 m office building",
    Tower(
        height=28.0, pit=1.2, mass_per_length=0.62, diameter=0.013, EA=4.0e6, EI=8.0, axial_damping=1.0e3, bending_damping=0.04,
        sheave_mass=70.0, radius=0.3, inertia=3.15, contact_stiffness=8.0e6, contact_damping=5.0e3,
    ),
    Limits(1.6, 0.7, 0.9, rest=2.5, after=6.0),
    runs={"ascent": Run(1.0, 27.0, 1.0), "descent": Run(25.0, 0.0, 0.6), "part": Run(3.0, 15.0, 0.8, "validate")},
    sensors={"shaft_c": (1.0, 1.2), "shaft_k": (-1.0, 0.4)},
    channels={
        "laser_c": laser("shaft_c", 0.3),
        "laser_k": laser("shaft_k", 0.3),
        "load_cell": Channel("sheave_force", "force", "N", 1.0, 3.0, "absolute"),
        "tacho": Channel("sheave_angular_velocity", "omega", "rpm", 30.0 / np.pi, 0.15, "absolute"),
    },
    every=5,
)  # fmt: skip
HIGH120 = Site(
    "high120", "120 m high-rise",
    Tower(
        height=120.0, pit=2.5, mass_per_length=1.7, diameter=0.022, EA=1.2e7, EI=40.0, axial_damping=3.0e3, bending_damping=0.2,
        sheave_mass=260.0, radius=0.5, inertia=30.0, contact_stiffness=1.5e7, contact_damping=1.0e4,
    ),
    Limits(5.0, 1.0, 0.9, rest=4.0, after=10.0),
    runs={
        "a": Run(32.0, 116.0, 1.0),
        "b": Run(86.0, 2.0, 0.7),
        "c": Run(34.0, 76.0, 0.5),
        "d": Run(88.0, 46.0, 0.7, "validate"),
        "e": Run(32.0, 112.0, 0.5, "validate"),
    },
    sensors={"w1": (1.0, 1.0), "w12": (1.0, 12.0), "k4": (-1.0, 4.0), "k30": (-1.0, 30.0)},
    channels={
        **{name: laser(name, 0.25) for name in ("w1", "w12", "k4", "k30")},
        "hitch": Channel("car_end_tension", "car_tension", "N", 1.0, 20.0, "absolute"),
        "omega": Channel("sheave_angular_velocity", "omega", "rad/s", 1.0, 0.02, "absolute"),
    },
    every=3,
    encoder=1e-3,
)  # fmt: skip
CLINIC20 = Site(
    "clinic20", "20 m hospital wing",
    Tower(
        height=20.0, pit=1.0, mass_per_length=0.85, diameter=0.016, EA=6.0e6, EI=14.0, axial_damping=1.5e3, bending_damping=0.07,
        sheave_mass=90.0, radius=0.36, inertia=5.8, contact_stiffness=1.0e7, contact_damping=6.0e3,
    ),
    Limits(1.0, 0.6, 0.8, rest=2.0, after=8.0),
    runs={
        "r1": Run(0.5, 18.0, 1.0), "r2": Run(17.0, 1.5, 1.0), "r3": Run(2.0, 16.5, 0.6),
        "r4": Run(15.0, 3.0, 0.8, "validate"),
    },
    sensors={"bay_cw": (1.0, 0.9), "bay_car": (-1.0, 0.3)},
    channels={
        "bay_cw": laser("bay_cw", 0.15),
        "bay_car": laser("bay_car", 0.15),
        "axle": Channel("sheave_displacement", "axle", "mm", 1e3, 0.03),
        "omega": Channel("sheave_angular_velocity", "omega", "rad/s", 1.0, 0.015, "absolute"),
    },
    every=4,
)  # fmt: skip
HOTEL75 = Site(
    "hotel75", "75 m hotel",
    Tower(
        height=75.0, pit=1.8, mass_per_length=1.4, diameter=0.02, EA=1.0e7, EI=30.0, axial_damping=2.5e3, bending_damping=0.15,
        sheave_mass=180.0, radius=0.45, inertia=18.0, contact_stiffness=1.3e7, contact_damping=9.0e3,
    ),
    Limits(3.5, 0.9, 0.9, rest=3.0, after=8.0),
    runs={
        "north": Run(5.0, 70.0, 1.0), "south": Run(60.0, 1.0, 0.75), "light": Run(12.0, 68.0, 0.55),
        "held": Run(50.0, 8.0, 0.55, "validate"),
    },
    sensors={"p1": (1.0, 0.8), "p2": (1.0, 9.0), "p3": (-1.0, 2.5)},
    channels={
        **{name: laser(name, 0.25) for name in ("p1", "p2", "p3")},
        "axle": Channel("sheave_displacement", "axle", "mm", 1e3, 0.03),
        "rev": Channel("sheave_angular_velocity", "omega", "rpm", 30.0 / np.pi, 0.12, "absolute"),
    },
    every=4,
    encoder=8e-4,
)  # fmt: skip
SITES = {site.name: site for site in (TOWER50, OFFICE28, HIGH120, CLINIC20, HOTEL75)}
