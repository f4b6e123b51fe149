"""Simulation of one run of the tower: its true channels."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from .arguments import Record, Rope, State, empty_state, work
from .generalised_alpha import integrate
from .static_equilibrium import static_equilibrium
from .tower import Floats, Tower

STEP = 0.004  # s


@dataclass(frozen=True)
class Excitation:
    """Excitation of the tower: time [k], the ends [k, 4, 3] (x and y of car and counterweight, two derivatives), and more."""

    time: Floats
    ends: Floats
    thermal: Floats  # [k] strain of the rope by temperature
    density: Mapping[float, float] = field(default_factory=dict)  # factor of mass per length from each share of the rope on
    encoder: float = 1.0  # what the encoder reads over the true height


def excitation_of_trip(p: Tower, time: Floats, motion: Floats) -> Excitation:
    """The ends on the vertical through the sheave's sides, the counterweight against the car."""
    ends = np.zeros((len(time), 4, 3))
    ends[:, 0], ends[:, 2] = -motion, motion
    ends[:, 2, 0] -= p.height
    ends[:, 1, 0], ends[:, 3, 0] = -p.radius, p.radius
    return Excitation(time, ends, np.zeros(len(time)))


def simulate(p: Tower, excitation: Excitation, sensors: Mapping[str, tuple[float, float]], every: int) -> dict[str, Floats]:
    """Channels at one of `every` steps, in SI units: `time`, `axle` (up), `turned`, `omega`, tensions, `force`, and the sensors.

    Sensors are a side, -1 car and +1 counterweight, and a height each.
    """
    p, n = p.discretised()
    W = work(n)
    mass = np.full(n, p.mass_per_length * p.element)
    for share, factor in sorted(excitation.density.items()):
        mass[round(share * n) :] = factor * p.mass_per_length * p.element
    begin = excitation.ends[0]
    q = static_equilibrium(p, n, W, mass, -begin[0, 0], (-begin[1, 0] - p.radius, begin[3, 0] - p.radius))
    places = np.array(list(sensors.values())).reshape(-1, 2)
    out = np.zeros(((len(excitation.time) - 1) // every + 1, 6 + len(places)))
    states = (State(q, np.zeros_like(q), np.zeros_like(q)), empty_state(n), empty_state(n))
    motion, record = (excitation.ends, excitation.thermal), Record(places, every, out)
    done = integrate(p, n, STEP, W, Rope(mass, curvature(p, n, q), np.zeros(n)), motion, states, record)
    if done < 0.0:
        raise RuntimeError(f"the plant failed {-done * STEP:.3f} s into the run")
    names = ("axle", "turned", "omega", "car_tension", "counterweight_tension", "force", *sensors)
    channels = dict(zip(names, out.T.copy(), strict=True))
    channels["axle"] = -channels["axle"]
    return {"time": excitation.time[::every]} | channels


def curvature(p: Tower, n: int, q: Floats) -> Floats:
    """Curvature [n] of a state's shape."""
    points = q[: 2 * n].reshape(n, 2)
    ways = np.diff(points, axis=0)
    (ax, ay), (bx, by) = ways[:-1].T, ways[1:].T
    kappa = np.zeros(n)
    kappa[1:-1] = 2.0 * (ax * by - ay * bx) / (np.hypot(ax, ay) * np.hypot(bx, by) + ax * bx + ay * by) / p.element
    return kappa
