"""Error of recovered motions: ordinary trips, stops, and random motions; seconds and memory of long records.

`python benchmarks/recovered_motion.py STOPS`; STOPS is a folder with `both_stop_at_1g.csv` and `car_stops_harder_than_1g.csv`.
Errors are those of the position at the samples, against the motion before noise, rounding and holding.
"""

import argparse
import subprocess
import sys
import time as clock
import tracemalloc
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

import comprope_system
from comprope.errors import InputError
from comprope_system.measurements import Trip, recover_trip
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited
from comprope_system.simulation.trips.measured_run import read_run

Floats = NDArray[np.float64]

NOISE = 5e-4  # m, of the ordinary trips
FINE = 1e-3  # s between the points of a true motion
COUNT = 50
STOPS = {"both_stop_at_1g.csv": ("tower50", 50.0), "car_stops_harder_than_1g.csv": ("building200", 200.0)}
LONG = {"one trip in 3 min": (180.0, 1), "30 trips in 30 min": (1800.0, 30), "one trip in 30 min": (1800.0, 1)}


@dataclass(frozen=True)
class Motion:
    """A true motion: positions (n,) [m] every FINE seconds."""

    kind: str
    position: Floats


def profile(rng: np.random.Generator, distance: float, speed: float) -> Floats:
    """Positions [m] of a jerk-limited trip from 0, without rests."""
    acceleration, jerk = rng.uniform(0.5, 1.2), rng.uniform(0.5, 1.5)
    ramp = min(acceleration / jerk, (abs(distance) / (2.0 * jerk)) ** (1.0 / 3.0))
    plateau = min(speed / acceleration, (abs(distance) / acceleration) ** 0.5) - ramp
    plateau = max(plateau, 0.0)
    cruise = max(abs(distance) / speed - (2.0 * ramp + plateau), 0.0)
    piece = jerk_limited(0.0, distance, 0.0, np.array([ramp, plateau, ramp, cruise, ramp, plateau, ramp]).clip(1e-3))
    return piece.value(np.arange(0.0, piece.stop, FINE))


def rest(seconds: float) -> Floats:
    """Rest at 0."""
    return np.zeros(round(seconds / FINE))


def joined(*parts: Floats) -> Floats:
    """Motions one after the other, each from where the last one ended."""
    ends = np.cumsum([0.0, *(part[-1] if len(part) else 0.0 for part in parts)])
    return np.concatenate([part + end for part, end in zip(parts, ends, strict=False)])


def braked(rng: np.random.Generator) -> Floats:
    """A trip that is stopped hard on the way."""
    way = profile(rng, rng.choice([-1.0, 1.0]) * rng.uniform(20.0, 40.0), rng.uniform(1.0, 6.0))
    cut = round(rng.uniform(0.3, 0.7) * len(way))
    speed, deceleration = (way[cut] - way[cut - 1]) / FINE, rng.uniform(3.0, 15.0)
    t = np.arange(FINE, abs(speed) / deceleration, FINE)
    return joined(way[: cut + 1], np.sign(speed) * (abs(speed) * t - 0.5 * deceleration * t**2))


def smooth_trip(rng: np.random.Generator) -> Floats:
    """A jerk-limited trip up or down."""
    return profile(rng, rng.choice([-1.0, 1.0]) * rng.uniform(3.0, 45.0), rng.uniform(1.0, 6.0))


def up_and_back(rng: np.random.Generator) -> Floats:
    """A trip up and back, with or without a rest between."""
    way = rng.uniform(3.0, 20.0)
    return joined(profile(rng, way, 2.5), rest(rng.choice([0.0, 0.3, 5.0])), profile(rng, -way, 2.5))


def relevelling(rng: np.random.Generator) -> Floats:
    """A trip, a rest and a correction of centimetres."""
    size = rng.choice([-1.0, 1.0]) * rng.uniform(0.01, 0.05)
    return joined(smooth_trip(rng), rest(rng.uniform(0.5, 3.0)), profile(rng, size, 0.05))


def creeping(rng: np.random.Generator) -> Floats:
    """A trip whose last decimetres are crept."""
    return joined(smooth_trip(rng), profile(rng, rng.choice([-1.0, 1.0]) * rng.uniform(0.05, 0.3), rng.uniform(0.02, 0.1)))


def under_way(rng: np.random.Generator) -> Floats:
    """A part of a trip that begins and may end under way."""
    way = smooth_trip(rng)
    first, last = rng.uniform(0.2, 0.4), rng.choice([1.0, rng.uniform(0.6, 0.8)])
    return way[round(first * len(way)) : round(last * len(way))]


KINDS: dict[str, Callable[[np.random.Generator], Floats]] = {
    "smooth trip": smooth_trip, "hard stop": braked, "up and back": up_and_back, "re-levelling": relevelling,
    "creeping to the landing": creeping, "begins or ends under way": under_way,
}  # fmt: skip


def motions(count: int) -> list[tuple[Motion, np.random.Generator]]:
    """Random motions of all kinds in turn, each with the generator for its signal."""
    found = []
    for k in range(count):
        rng, kind = np.random.default_rng(1000 + k), list(KINDS)[k % len(KINDS)]
        moving = KINDS[kind](rng)
        if kind == "begins or ends under way":
            found.append((Motion(kind, moving), rng))
        else:
            found.append((Motion(kind, joined(rest(rng.uniform(1.0, 3.0)), moving, rest(rng.uniform(2.0, 5.0)))), rng))
    return found


@dataclass(frozen=True)
class Measured:
    """A signal (n,) [m], the motion behind it, and the size [m] and sort of what hides it."""

    time: Floats
    signal: Floats
    truth: Floats
    size: float
    sort: str


def measured(motion: Motion, rng: np.random.Generator) -> Measured:
    """The motion as an instrument shows it: noisy, rounded, or held by a slow controller."""
    stride = int(rng.choice([4, 8, 10, 20]))
    truth = motion.position[::stride]
    time = FINE * stride * np.arange(len(truth))
    sort = str(rng.choice(["noise", "rounding", "noise and rounding", "held"]))
    noise = float(rng.choice([1e-4, 5e-4, 2e-3])) if "noise" in sort or sort == "held" else 0.0
    step = float(rng.choice([1e-4, 1e-3])) if "rounding" in sort else 0.0
    signal = truth + noise * rng.standard_normal(len(truth))
    signal = step * np.round(signal / step) if step else signal
    if sort == "held":
        count = max(2, round(0.1 / (FINE * stride)))
        signal = signal[count * (np.arange(len(signal)) // count)]
    return Measured(time, signal, truth, float(np.hypot(noise, step / 12.0**0.5)), sort)


def random_motions() -> None:
    """Error over noise of each random motion, in root mean square and at most."""
    print(f"{'motion':26} {'signal':20} noise mm  rms/noise  max/noise  recovered as")
    rows = []
    for motion, rng in motions(COUNT):
        one = measured(motion, rng)
        try:
            trip = recover_trip(one.time, one.signal)
        except InputError as error:
            print(f"{motion.kind:26} {one.sort:20} refused: {error}")
            continue
        error = np.abs(trip.position(one.time) - one.truth)
        rows.append((motion.kind, float(np.sqrt(np.mean(error**2))) / one.size, float(error.max()) / one.size))
        print(f"{motion.kind:26} {one.sort:20} {1e3 * one.size:8.3f} {rows[-1][1]:10.2f} {rows[-1][2]:10.2f}  {trip.kind}")
    table = pd.DataFrame(rows, columns=["kind", "rms", "largest"])
    print(table.groupby("kind", sort=False).agg(["median", "max"]).round(2).to_string())
    within = f"rms/noise below 1: {(table['rms'] < 1.0).sum()}, max/noise below 5: {(table['largest'] < 5.0).sum()}"
    print(f"{len(table)} of {COUNT} recovered; {within}")


def ordinary_trips() -> None:
    """Error of ordinary trips with noise of 0.5 mm every 8 ms."""
    errors = []
    for seed in range(10):
        rng = np.random.default_rng(seed)
        truth = joined(rest(2.0), profile(rng, 45.0, 2.5), rest(5.0))[::8]
        time = 8.0 * FINE * np.arange(len(truth))
        trip = recover_trip(time, truth + NOISE * rng.standard_normal(len(truth)))
        errors.append(trip.position(time) - truth)
    rms = 1e3 * float(np.sqrt(np.mean(np.concatenate(errors) ** 2)))
    largest = 1e3 * max(np.abs(error).max() for error in errors)
    print(f"ordinary trips: rms {rms:.3f} mm, at most {largest:.3f} mm, of noise {1e3 * NOISE} mm")


def stops(folder: Path) -> None:
    """Position error of recorded stops, and what the simulated rope does."""
    for file, (model, height) in STOPS.items():
        table = pd.read_csv(folder / file)
        trips: dict[str, Trip] = read_run(folder / file, height, []).trips
        errors = [np.abs(trips[end].position(table["time"]) - table[f"{end}_position"]).max() for end in trips]
        result = comprope_system.simulate(model, comprope_system.CarMotion(measured=folder / file), step=4e-3).table
        rise = 1e3 * (result["sheave_displacement"].max() - result["sheave_displacement"].iloc[0])
        tension = result[["car_end_tension", "counterweight_end_tension"]].min().min()
        forces = f"{result['sheave_force'].min():.0f} to {result['sheave_force'].max():.0f} N"
        print(f"{file}: car {1e3 * errors[0]:.3f} mm, counterweight {1e3 * errors[1]:.3f} mm off the file at most;")
        print(f"    sheave force {forces}, rises {rise:.1f} mm, least end tension {tension:.0f} N")


def long_record(name: str) -> None:
    """Seconds and memory of one recovery; to be run in a process of its own."""
    duration, count = LONG[name]
    rng, way = np.random.default_rng(1), 45.0
    window = duration / count
    parts = []
    for k in range(count):
        moving = profile(rng, way if k % 2 == 0 else -way, 2.5)
        parts += [rest(5.0), moving, rest(window - 5.0 - FINE * len(moving))]
    truth = joined(*parts)
    time = FINE * np.arange(len(truth))
    signal = truth + NOISE * rng.standard_normal(len(truth))
    start = clock.process_time()
    trip = recover_trip(time, signal)
    seconds = clock.process_time() - start
    tracemalloc.start()
    recover_trip(time, signal)
    memory = tracemalloc.get_traced_memory()[1] / 2**20
    error = 1e3 * float(np.sqrt(np.mean((trip.position(time[::50]) - truth[::50]) ** 2)))
    print(f"{name} at 1 kHz: {seconds:.2f} CPU s, {memory:.0f} MB, rms {error:.3f} mm, {trip.kind}", flush=True)


def main() -> None:
    """Everything in turn."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("stops", type=Path, nargs="?", help="folder with recorded stops")
    parser.add_argument("--long", choices=[*LONG], help="one long record only")
    options = parser.parse_args()
    if options.long:
        long_record(options.long)
        return
    ordinary_trips()
    random_motions()
    if options.stops:
        stops(options.stops)
    for name in LONG:
        subprocess.run([sys.executable, __file__, "--long", name], check=True)


if __name__ == "__main__":
    main()
