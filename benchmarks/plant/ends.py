"""Causes that act on the rope's ends, its temperature, its mass, or the encoder: each gives another `Excitation`."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from scipy.signal import lsim

from .simulate import Excitation
from .tower import Floats, Tower

Values = Mapping[str, float]
Act = Callable[[Tower, Excitation, Values, np.random.Generator], Excitation]
CAR_X, CAR_Y, CW_X, CW_Y = range(4)


def building_sway(p: Tower, excitation: Excitation, by: Values, rng: np.random.Generator) -> Excitation:
    """Both ends move sideways with the building, linearly over height from the axle as built to the top landing."""
    rate = 2.0 * np.pi * by["frequency"]
    angle = rate * excitation.time + by["phase"]
    wave = by["amplitude"] * np.stack([np.sin(angle), rate * np.cos(angle), -(rate**2) * np.sin(angle)], axis=-1)
    return _swayed(p, excitation, wave)


def gusts(p: Tower, excitation: Excitation, by: Values, rng: np.random.Generator) -> Excitation:
    """Irregular sway: many rates between 0.08 and 1.2 Hz, others in each run; it sets in within two seconds."""
    rates, phases = 2.0 * np.pi * rng.uniform(0.08, 1.2, 24), rng.uniform(0.0, 2.0 * np.pi, 24)
    angles = np.outer(excitation.time - excitation.time[0], rates) + phases
    size = by["size"] * np.sqrt(2.0 / 24)
    wave = size * np.stack([np.sin(angles).sum(1), (rates * np.cos(angles)).sum(1), -(rates**2 * np.sin(angles)).sum(1)], axis=-1)
    return _swayed(p, excitation, _faded(excitation.time - excitation.time[0], wave))


def attachment_offset(p: Tower, excitation: Excitation, by: Values, rng: np.random.Generator) -> Excitation:
    """The ends hang outside the sheave's sides."""
    ends = excitation.ends.copy()
    ends[:, CAR_Y, 0] -= by["car"]
    ends[:, CW_Y, 0] += by["counterweight"]
    return replace(excitation, ends=ends)


def rail_waves(p: Tower, excitation: Excitation, by: Values, rng: np.random.Generator) -> Excitation:
    """Guide rails with joints of 5 m push the car sideways: locked to its position."""
    ends, k = excitation.ends.copy(), 2.0 * np.pi / 5.0
    height, speed, acceleration = -ends[:, CAR_X].T
    angle = k * (height + by["shift"])
    ends[:, CAR_Y, 0] += by["size"] * np.sin(angle)
    ends[:, CAR_Y, 1] += by["size"] * k * np.cos(angle) * speed
    ends[:, CAR_Y, 2] += by["size"] * (k * np.cos(angle) * acceleration - k * k * np.sin(angle) * speed**2)
    return replace(excitation, ends=ends)


def counterweight_bounce(p: Tower, excitation: Excitation, by: Values, rng: np.random.Generator) -> Excitation:
    """The counterweight bounces on its hoist rope, which the encoder does not see."""
    ends = excitation.ends.copy()
    ends[:, CW_X] += _oscillation(excitation.time, -ends[:, CW_X, 2], by["frequency"], by["damping_ratio"])
    return replace(excitation, ends=ends)


def car_bounce(p: Tower, excitation: Excitation, by: Values, rng: np.random.Generator) -> Excitation:
    """The car bounces on its hoist ropes, which an encoder at the machine does not see."""
    ends = excitation.ends.copy()
    ends[:, CAR_X] += _oscillation(excitation.time, -ends[:, CAR_X, 2], by["frequency"], by["damping_ratio"])
    return replace(excitation, ends=ends)


def leaning_car(p: Tower, excitation: Excitation, by: Values, rng: np.random.Generator) -> Excitation:
    """The car is pulled off its middle and leans in its guide shoes while it speeds up: `size` metres outward per m/s2."""
    ends, rate = excitation.ends.copy(), 2.0 * np.pi * by["frequency"]
    ends[:, CAR_Y] += _oscillation(excitation.time, rate**2 * by["size"] * ends[:, CAR_X, 2], by["frequency"], 0.5)
    return replace(excitation, ends=ends)


def knock(p: Tower, excitation: Excitation, by: Values, rng: np.random.Generator) -> Excitation:
    """Once in each run somebody moves in the car and pushes it aside, at any time."""
    ends, time = excitation.ends.copy(), excitation.time
    w = 2.0 * np.pi / by["seconds"]
    half = 0.5 * np.clip(w * (time - rng.uniform(max(time[0], 0.0), time[-1] - by["seconds"])), 0.0, 2.0 * np.pi)
    s, c = np.sin(half), np.cos(half)
    ends[:, CAR_Y] += by["size"] * np.stack([s**4, 2.0 * w * s**3 * c, w * w * s * s * (3.0 * c * c - s * s)], axis=-1)
    return replace(excitation, ends=ends)


def encoder_scale(p: Tower, excitation: Excitation, by: Values, rng: np.random.Generator) -> Excitation:
    """The encoder's wheel is worn: it reads more or less than the car's true height."""
    ends = excitation.ends.copy()
    ends[:, CAR_X] /= 1.0 + by["excess"]
    ends[:, CW_X] = -ends[:, CAR_X]
    ends[:, CW_X, 0] -= p.height
    return replace(excitation, ends=ends, encoder=1.0 + by["excess"])


def splice(p: Tower, excitation: Excitation, by: Values, rng: np.random.Generator) -> Excitation:
    """From some place on the rope is another one, with more or less mass per length."""
    return replace(excitation, density={by["place"]: 1.0 + by["excess"]})


def warming(p: Tower, excitation: Excitation, by: Values, rng: np.random.Generator) -> Excitation:
    """The rope lengthens or shortens with temperature, by the same strain every minute."""
    return replace(excitation, thermal=by["strain"] * (excitation.time - excitation.time[0]) / 60.0)


def _oscillation(time: Floats, driven: Floats, frequency: float, damping_ratio: float) -> Floats:
    """Motion [k, 3] of an oscillator by what drives it [k], an acceleration, from rest."""
    w = 2.0 * np.pi * frequency
    system = ([[0.0, 1.0], [-w * w, -2.0 * damping_ratio * w]], [[0.0], [1.0]], [[1.0, 0.0]], [[0.0]])
    _, _, states = lsim(system, driven, time)
    return np.column_stack([states, driven - 2.0 * damping_ratio * w * states[:, 1] - w * w * states[:, 0]])


def _swayed(p: Tower, excitation: Excitation, wave: Floats) -> Excitation:
    """Both ends moved sideways by wave [k, 3], linear in height (the ends' speed changes the share but slowly)."""
    ends = excitation.ends.copy()
    for x, y in ((CAR_X, CAR_Y), (CW_X, CW_Y)):
        share = (p.pit - ends[:, x, 0]) / (p.height + p.pit)
        rate, bend = -ends[:, x, 1] / (p.height + p.pit), -ends[:, x, 2] / (p.height + p.pit)
        ends[:, y, 0] += share * wave[:, 0]
        ends[:, y, 1] += share * wave[:, 1] + rate * wave[:, 0]
        ends[:, y, 2] += share * wave[:, 2] + 2.0 * rate * wave[:, 1] + bend * wave[:, 0]
    return replace(excitation, ends=ends)


def _faded(time: Floats, wave: Floats) -> Floats:
    """A wave with its derivatives, from nothing to full within two seconds."""
    s = np.clip(time / 2.0, 0.0, 1.0)
    fade, rate, bend = s**3 * (10 - 15 * s + 6 * s**2), 30 * s**2 * (1 - s) ** 2 / 2.0, 60 * s * (1 - s) * (1 - 2 * s) / 4.0
    y, v, a = wave.T
    return np.stack([fade * y, fade * v + rate * y, fade * a + 2.0 * rate * v + bend * y], axis=-1)
