"""Trials of the diagnosis on campaigns with planted effects.

Each trial draws a hidden cause (an effect of the library, an instrument's fault, two effects, an effect
outside the library, or nothing), its size, plant parameters off by several per cent, noise and seeds;
measures it with a finer mesh and a smaller step than the model under test; and lets the diagnosis say
what is missing. Scores: the right effect on top, false alarms, "none of the known" recalled, fall of
the error on the run that was held out, and how far stated probabilities are honest.

    python benchmarks/trials.py --count 40 --out results/trials.jsonl [--jobs 2] [--seed 1]
"""

import argparse
import json
import multiprocessing
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import outside

from comprope.drive.parameters import Profile
from comprope.drive.trajectory import plan
from comprope.rope.modelfile import load, with_changes
from comprope_system.identify.campaign import Campaign, Channel, Run
from comprope_system.identify.diagnose import Candidate, diagnose, errors
from comprope_system.identify.errors_of import nrmse
from comprope_system.identify.point import Point, gathered, submit
from comprope_system.identify.replay import replay
from comprope_system.presets import model_path
from comprope_system.trips import recover_trip

# Sizes from barely visible to large: each is drawn log-uniformly between its two values.
KNOWN = {
    "air_drag": {"effects.air_drag.drag_coefficient": (100.0, 400.0)},
    "shaft_airflow": {"effects.shaft_airflow.crossflow_ratio": (0.1, 0.6)},
    "bending_hysteresis": {"effects.bending_hysteresis.friction_moment": (0.3, 4.0)},
    "intrinsic_curvature": {"effects.intrinsic_curvature.curvature": (0.05, 0.6)},
    "sheave_eccentricity": {"effects.sheave_eccentricity.eccentricity": (1e-4, 3e-3)},
    "bearing_friction": {"effects.bearing_friction.coulomb_torque": (2.0, 25.0)},
    "guide_friction": {"effects.guide_friction.coulomb_force": (10.0, 80.0)},
    "sheave_damper": {"effects.sheave_damper.damping": (3e3, 3e5)},
    "building_sway": {"effects.building_sway.amplitude": (1e-3, 2e-2)},
    "attachment_offset": {"effects.attachment_offset.car": (3e-3, 3e-2), "effects.attachment_offset.counterweight": (3e-3, 3e-2)},
}
BESIDE = {
    "air_drag": {},
    "shaft_airflow": {"effects.air_drag.drag_coefficient": (1.0, 1.2)},
    "bending_hysteresis": {"effects.bending_hysteresis.yield_curvature": (0.05, 1.0)},
    "sheave_eccentricity": {"effects.sheave_eccentricity.phase": (0.1, 3.0)},
    "building_sway": {"effects.building_sway.frequency": (0.1, 0.9), "effects.building_sway.phase": (0.1, 3.0)},
}
PLANT = ("rope.bending_stiffness", "rope.bending_damping", "rope.mass_per_length", "contact.friction_coefficient")
NOISE = {"cw_low": 0.2, "cw_mid": 0.2, "car_low": 0.2, "sheave_dx": 0.02, "sheave_w": 0.01}
CHANNELS = {
    **{
        name: Channel(column=name, quantity="lateral_displacement", sensor=name, unit="mm", reference="rest", noise=0.2)
        for name in ("cw_low", "cw_mid", "car_low")
    },
    "sheave_dx": Channel(column="sheave_dx", quantity="sheave_displacement", unit="mm", reference="rest", noise=0.02),
    "sheave_w": Channel(column="sheave_w", quantity="sheave_angular_velocity", unit="rad/s", reference="absolute", noise=0.01),
}
RUNS = (
    ("up_nominal", "fit", 0.0, 45.0, 1.0),
    ("up_light", "fit", 0.0, 45.0, 0.5),
    ("down_nominal", "fit", 38.0, 2.0, 1.0),
    ("up_short", "validate", 2.0, 30.0, 0.75),
)
KINDS = ("known", "known", "known", "known", "nothing", "instrument", "outside", "pair")


def drawn(rng: np.random.Generator, ranges: dict[str, tuple[float, float]]) -> dict[str, float]:
    """Values drawn log-uniformly."""
    return {key: float(np.exp(rng.uniform(np.log(low), np.log(high)))) for key, (low, high) in ranges.items()}


def effect(rng: np.random.Generator, name: str) -> dict[str, float]:
    """One effect of the library with everything it needs."""
    return drawn(rng, KNOWN[name]) | drawn(rng, BESIDE.get(name, {}))


def measured(
    rng: np.random.Generator, spec: tuple, changes: dict[str, float], fault: dict[str, dict[str, float]], strange: str | None
) -> Run:
    """One run as an independent plant would show it, with an encoder's noise on the car's position."""
    name, role, start, stop, weight = spec
    trip = plan(Profile(speed=2.5, acceleration=0.8, jerk=0.8), start, stop, 2.0)
    time_ = np.arange(0.0, trip.end_time + 8.0, 0.008)
    car = np.array([trip.at(t).position for t in time_])
    smooth = recover_trip(time_, car)
    model = load(model_path("tower50"))
    given = {"sheave.mass": 120.0 * weight, "sheave.inertia": 9.6 * weight}
    plant = with_changes(model, changes | {"rope.element_length": 0.025})
    run = Run(f"{name}.csv", role, given, time_, car, smooth, smooth.mirrored(50.0), {})
    values = outside.replayed(strange, rng, plant, run, CHANNELS) if strange else replay(plant, run, CHANNELS, step=0.002).values
    for column, (gain, offset, delay) in (
        (c, (f.get("gain", 1.0), f.get("offset", 0.0), f.get("delay", 0.0))) for c, f in fault.items()
    ):
        values[column] = gain * np.interp(time_ - delay, time_, values[column]) + offset
    noisy = {
        column: value + rng.normal(0.0, NOISE[column] * CHANNELS[column].scale, len(value)) for column, value in values.items()
    }
    return replace(run, values=noisy, trip=recover_trip(time_, car + rng.normal(0.0, 5e-4, len(car))))


def campaign(rng: np.random.Generator) -> tuple[Campaign, dict]:
    """A campaign and its hidden truth."""
    kind = str(rng.choice(KINDS))
    names: list[str] = []
    changes: dict[str, float] = {}
    fault: dict[str, dict[str, float]] = {}
    strange = None
    if kind in ("known", "pair"):
        names = [str(one) for one in rng.choice(list(KNOWN), 2 if kind == "pair" else 1, replace=False)]
        changes = {key: value for name in names for key, value in effect(rng, name).items()}
    elif kind == "instrument":
        column = str(rng.choice(["cw_low", "cw_mid", "car_low"]))
        what, amount = [("gain", float(rng.choice([0.9, 0.95, 1.05, 1.1]))), ("delay", float(rng.uniform(0.02, 0.1)))][
            rng.integers(2)
        ]
        names, fault = [f"sensor_{what}"], {column: {what: amount}}
    elif kind == "outside":
        strange = str(rng.choice(list(outside.STRANGE)))
        names = [strange]
    model = load(model_path("tower50"))
    base = {
        "rope.bending_stiffness": 20.0,
        "rope.bending_damping": 0.1,
        "rope.mass_per_length": 1.2,
        "contact.friction_coefficient": 0.3,
    }
    changes |= {key: base[key] * float(rng.normal(1.0, 0.02 if key == "rope.mass_per_length" else 0.08)) for key in PLANT}
    runs = tuple(measured(rng, spec, changes, fault, strange) for spec in RUNS)
    return Campaign("trial", Path(), model, model_path("tower50"), CHANNELS, runs), {
        "kind": kind,
        "names": names,
        "changes": changes,
        "fault": fault,
    }


def trial(seed: int, executor: ProcessPoolExecutor) -> dict:
    """Draw, diagnose and score one campaign."""
    subject, truth = campaign(np.random.default_rng(seed))
    began = time.perf_counter()
    found = diagnose(subject, executor)
    seconds = time.perf_counter() - began
    validate = subject.of_role("validate")
    before = nrmse(subject, validate, gathered(validate, submit(subject, validate, Point(), executor)))
    winner = found.ranking[0].fitted if found.kind in ("known_effect", "instrument") else found.none
    _, after = errors(subject, winner, executor)
    count = len(found.problem.data)
    return {
        "seed": seed, **truth, "verdict": found.verdict, "verdict_kind": found.kind,
        "right": right(truth, found.verdict, found.kind, found.alike), "probability": max(found.probabilities.values()),
        "visible": found.none.misfit / count, "left": winner.misfit / count,
        "validate_before": before, "validate_after": after, "seconds": seconds,
        "top": [summary(one, count) for one in found.ranking[:3]],
    }  # fmt: skip


def summary(one: Candidate, count: int) -> tuple[str, float, dict[str, float]]:
    """Effect, misfit per datum and fitted parameters."""
    return one.hypothesis.effect, round(one.fitted.misfit / count, 3), one.hypothesis.parameters(one.fitted.effect_coefficients)


def right(truth: dict, verdict: str | None, kind: str, alike: tuple) -> bool:
    """Whether the verdict names the hidden cause, or one that these data cannot tell from it."""
    if truth["kind"] == "nothing":
        return kind == "adequate"
    if truth["kind"] == "outside":
        return kind == "unknown_effect"
    same = {name for pair in alike if set(pair) & set(truth["names"]) for name in pair} | set(truth["names"])
    return verdict in same


def main() -> None:
    """Run trials and append each to the output as it ends."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--count", type=int, default=20)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--jobs", type=int, default=2)
    options.add_argument("--out", type=Path, default=Path("results/trials.jsonl"))
    chosen = options.parse_args()
    chosen.out.parent.mkdir(parents=True, exist_ok=True)
    with ProcessPoolExecutor(chosen.jobs, mp_context=multiprocessing.get_context("spawn")) as executor:
        for seed in range(chosen.seed, chosen.seed + chosen.count):
            result = trial(seed, executor)
            with chosen.out.open("a", encoding="utf-8") as file:
                file.write(json.dumps(result) + "\n")
            print(line(result), flush=True)


def line(result: dict) -> str:
    """One trial in one line."""
    said = result["verdict"] or result["verdict_kind"]
    errors_ = f"held out {result['validate_before']:.3f} -> {result['validate_after']:.3f}"
    misfit = f"visible {result['visible']:.2f}, left {result['left']:.2f}"
    mark = "right" if result["right"] else "WRONG"
    return (
        f"{result['seed']} {result['kind']} {result['names']} -> {said}: {mark}; {misfit}, {errors_}, {result['seconds']:.0f} s"
    )


if __name__ == "__main__":
    main()
