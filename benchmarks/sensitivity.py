"""What sensitivities along a run cost: replays with 0, 1, 5, 10 and 20 parameters against a plain replay.

    python benchmarks/sensitivity.py [--seconds 8] [--repeats 7]

All in one process, in turns, and the least of several repeats counts. The run is a trip of 20 m in the 50 m test tower,
seen by two displacement sensors and at the sheave; at last beside effects that act, each against a plain replay with it.
"""

import argparse
import time
from collections.abc import Callable

import numpy as np

from comprope.rope.model_file import validated, with_changes
from comprope_system.identification.data.runs import Channel, Run
from comprope_system.identification.prediction.replay import replay
from comprope_system.identification.prediction.replay_sensitivities import replay_with_sensitivities
from comprope_system.measurements import Trip
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited

MODEL = validated(
    {
        "shaft": {"height": 50.0, "pit": 1.5},
        "rope": {
            "mass_per_length": 1.2, "diameter": 0.018, "axial_stiffness": 8.0e6, "bending_stiffness": 20.0,
            "axial_damping": 2.0e3, "bending_damping": 0.1,
        },
        "sheave": {"mass": 120.0, "radius": 0.4, "inertia": 9.6},
        "contact": {"stiffness": 1.2e7, "damping": 8.0e3, "friction_coefficient": 0.3, "slip_velocity": 0.02},
        "sensors": [
            {"name": "low", "side": "counterweight", "height": 12.0},
            {"name": "high", "side": "counterweight", "height": 18.0},
        ],
    },
    "tower",
)  # fmt: skip
CHANNELS = {
    "low": Channel(column="low", quantity="lateral_displacement", sensor="low", unit="mm", reference="rest"),
    "high": Channel(column="high", quantity="lateral_displacement", sensor="high", unit="mm", reference="rest"),
    "axle": Channel(column="axle", quantity="sheave_displacement", unit="mm", reference="rest"),
}
KEYS = (
    "rope.bending_stiffness", "rope.bending_damping", "rope.mass_per_length", "sheave.mass", "contact.friction_coefficient",
    "shaft.pit", "effects.attachment_offset.car", "effects.sheave_eccentricity.eccentricity", "rope.axial_damping",
    "effects.air_drag.drag_coefficient", "effects.attachment_offset.counterweight", "sheave.inertia", "sheave.radius",
    "rope.axial_stiffness", "contact.stiffness", "contact.damping", "rope.external_damping", "effects.building_sway.amplitude",
    "effects.intrinsic_curvature.curvature", "effects.guide_friction.coulomb_force",
)  # fmt: skip
COUNTS = (0, 1, 5, 10, 20)
BESIDE = 10  # parameters beside an effect
ACTING = {
    "air drag": {"effects.air_drag.drag_coefficient": 1.0},
    "bearing friction": {"effects.bearing_friction.coulomb_torque": 10.0},
    "hysteresis": {"effects.bending_hysteresis.friction_moment": 1.0, "effects.bending_hysteresis.yield_curvature": 0.1},
}


def trip_of(seconds: float) -> Run:
    """The beginning of a trip from 5 m to 25 m at 2.5 m/s, as a measurement would have it."""
    when = np.arange(0.0, seconds, 0.02)
    trip = Trip((jerk_limited(5.0, 20.0, 0.5, np.array([0.7, 1.8, 0.7, 5.5, 0.7, 1.8, 0.7])),), 0.0, "profile")
    return Run("trip", "fit", {}, when, trip.position(when), trip, trip.mirrored(MODEL.shaft.height), {})


def cases(run: Run) -> dict[str, Callable[[], object]]:
    """What is timed, by name."""
    found: dict[str, Callable[[], object]] = {"plain": lambda: replay(MODEL, run, CHANNELS)}
    for exact in (False, True):
        for count in COUNTS:
            own = {key: {key: 1.0} for key in KEYS[:count]}
            found[f"{count:2} parameters{', exact' if exact else ''}"] = lambda own=own, exact=exact: replay_with_sensitivities(
                MODEL, run, CHANNELS, own, exact=exact
            )
    own = {key: {key: 1.0} for key in KEYS[:BESIDE]}
    for effect, values in ACTING.items():
        model = with_changes(MODEL, values)
        found[f"plain, {effect}"] = lambda model=model: replay(model, run, CHANNELS)
        found[f"{BESIDE} parameters, {effect}"] = lambda model=model: replay_with_sensitivities(model, run, CHANNELS, own)
    return found


def beside(name: str) -> str:
    """The plain replay that a case is held against."""
    effect = name.rpartition(", ")[2]
    return f"plain, {effect}" if effect in ACTING else "plain"


def main() -> None:
    """Time all cases in turns and print their least times."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=8.0, help="length of the run")
    parser.add_argument("--repeats", type=int, default=7)
    options = parser.parse_args()
    timed = cases(trip_of(options.seconds))
    for call in timed.values():
        call()
    least = dict.fromkeys(timed, np.inf)
    for _ in range(options.repeats):
        for name, call in timed.items():
            begin = time.perf_counter()
            call()
            least[name] = min(least[name], time.perf_counter() - begin)
    for name, seconds in least.items():
        print(f"{name:32} {seconds:7.3f} s {seconds / least[beside(name)]:6.2f} x plain")


if __name__ == "__main__":
    main()
