"""Measurements of a small virtual elevator, as the tests of the identification use them.

The elevator is the rope model itself, but on a finer mesh, at another step and with a plant a few per cent off, so that the model
under test has something to be wrong about even when no effect is hidden.
"""

import json
from pathlib import Path

import numpy as np
import pandas as pd

from comprope.rope.model_file import dump, validated, with_changes
from comprope_system.identification.data.runs import Channel, Run
from comprope_system.identification.prediction.replay import replay
from comprope_system.measurements import Trip
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited

MODEL = validated(
    {
        "shaft": {"height": 14.0, "pit": 1.2},
        "rope": {
            "mass_per_length": 1.2, "diameter": 0.018, "axial_stiffness": 8.0e6, "bending_stiffness": 20.0,
            "axial_damping": 2.0e3, "bending_damping": 0.1, "element_length": 0.08,
        },
        "sheave": {"mass": 120.0, "radius": 0.4, "inertia": 9.6},
        "contact": {"stiffness": 1.2e7, "damping": 8.0e3, "friction_coefficient": 0.3, "slip_velocity": 0.02},
        "sensors": [
            {"name": "cw_low", "side": "counterweight", "height": 1.0},
            {"name": "car_low", "side": "car", "height": 0.5},
        ],
    },
    "small elevator",
)  # fmt: skip
FINER = {"rope.element_length": 0.06}
PLANT = {"rope.bending_stiffness": 21.2, "rope.mass_per_length": 1.18, "rope.bending_damping": 0.11}
LASER = {"quantity": "lateral_displacement", "unit": "mm", "reference": "rest", "noise": 0.3}
CHANNELS = {
    "cw_low": Channel(column="cw_low", sensor="cw_low", **LASER),
    "car_low": Channel(column="car_low", sensor="car_low", **LASER),
    "axle": Channel(column="axle", quantity="sheave_displacement", unit="mm", reference="rest", noise=0.05),
    "turning": Channel(column="turning", quantity="sheave_angular_velocity", unit="rad/s", noise=0.01),
}
PHASES = np.array([0.7, 0.3, 0.7, 1.3, 0.7, 0.3, 0.7])  # s, from rest to rest
RUNS = (
    ("up.csv", "fit", 2.0, 7.0, {"sheave.mass": 120.0}),
    ("down_light.csv", "fit", 10.0, -7.0, {"sheave.mass": 70.0}),
    ("up_short.csv", "validate", 4.0, 5.0, {"sheave.mass": 95.0}),
)
END, SAMPLING, STEP = 9.0, 0.02, 0.003  # s; the model under test takes other steps


def campaign(folder: Path, hidden: dict[str, float], seed: int = 1) -> Path:
    """Write a campaign of three runs into `folder`, with `hidden` effects in the elevator but not in its model."""
    random = np.random.default_rng(seed)
    folder.mkdir(parents=True, exist_ok=True)
    dump(MODEL, folder / "elevator.toml")
    for file, _, start, distance, changes in RUNS:
        measure(file, start, distance, changes, hidden, random).to_csv(folder / file, index=False, float_format="%.5f")
    (folder / "campaign.toml").write_text(description())
    return folder


def measure(file, start, distance, changes, hidden, random) -> pd.DataFrame:
    """The table of one run as instruments would have written it."""
    time = np.arange(0.0, END, SAMPLING)
    trip = Trip((jerk_limited(start, distance, 1.0, PHASES),), 0.0, "profile")
    elevator = with_changes(MODEL, FINER | PLANT | hidden)
    run = Run(file, "fit", changes, time, trip.position(time), trip, trip.mirrored(MODEL.shaft.height), {})
    seen = replay(elevator, run, CHANNELS, STEP).values
    table = {"time": time, "car_position": trip.position(time) + 5e-4 * random.standard_normal(len(time))}
    for name, channel in CHANNELS.items():
        table[name] = seen[name] / channel.scale + channel.noise * random.standard_normal(len(time))
    return pd.DataFrame(table)


def description() -> str:
    """campaign.toml of the virtual elevator."""
    lines = ['name = "small elevator"', 'model = "elevator.toml"']
    for one in CHANNELS.values():
        keys = one.model_dump(exclude_none=True).items()
        lines += ["[[channels]]", *(f"{key} = {json.dumps(value)}" for key, value in keys)]
    for file, role, _, _, changes in RUNS:
        changed = ", ".join(f'"{key}" = {value}' for key, value in changes.items())
        lines += ["[[runs]]", f'file = "{file}"', f'role = "{role}"', f"set = {{ {changed} }}"]
    return "\n".join(lines) + "\n"
