"""Swing of the rope of a parked car while the building sways: modes of the linearised rope, in closed form.

The building sways by w(t) = A cos(W t) at the top landing, in proportion to the height above the axle, and the rope starts at
rest in the shape that belongs to w(0). With the static shape r per displacement of the top, y = r w + sum of shape_k q_k,

    q_k'' + 2 z w_k q_k' + w_k^2 q_k = g_k W^2 A cos(W t),   g_k = shape_k M r / (shape_k M shape_k),

whose solution from rest is a steady part and one that dies away. Displacements are relative to the building at the same height.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from comprope.rope.model_file import with_changes
from comprope.rope.parameters import Base
from comprope.rope.simulator.rope import CompensationRope

from ..modal.modes import modes

Floats = NDArray[np.float64]

COARSE = 0.1  # m, length of elements: natural periods of lateral modes are within 1e-3 of those at 5 cm
MODES = 24  # of both sides, the slowest
READ = 60  # heights of each side at which the swing is read
STEP = 0.1  # s between the times at which it is read
SHIFT = 1e-3  # m at the top landing, by which the static shape is differenced
LEAST_DAMPING = 1e-6  # ratio: a mode exactly at the building's period would have no steady part
SIDES = ("car", "counterweight")


@dataclass(frozen=True)
class Sway:
    """Sway of the building: amplitude at the top landing [m], duration [s], and damping ratio of the rope's modes."""

    amplitude: float
    duration: float
    damping: float


@dataclass(frozen=True)
class ParkedRope:
    """The linearised rope of a car parked at `car` [m].

    `rates` (k,) are its angular frequencies, `gains` (k,) how the sway drives them; at READ nodes of each side, at `heights`
    (side, READ) [m], `shapes` (side, READ, k) are those of the modes, and `static` (side, READ) is the static shape less the
    building's, per displacement of the top.
    """

    car: float
    rates: Floats
    gains: Floats
    shapes: Floats
    static: Floats
    heights: Floats

    def amplitudes(self, sway: Sway, period: float) -> Floats:
        """Largest displacement relative to the building [m] of car's and counterweight's side (2,) at a period [s] of it."""
        return np.asarray(self.profile(sway, period).max(axis=1))

    def at_heights(self, sway: Sway, period: float, wanted: Floats) -> Floats:
        """The same at some heights [m] (2, heights); zero where there is no rope."""
        order, found = np.argsort(self.heights, axis=1), self.profile(sway, period)
        sides = zip(order, self.heights, found, strict=True)
        return np.array([np.interp(wanted, at[k], one[k], left=0.0, right=0.0) for k, at, one in sides])

    def profile(self, sway: Sway, period: float) -> Floats:
        """The same at the heights of READ nodes of each side (2, READ)."""
        W, w, z = 2.0 * np.pi / period, self.rates, max(sway.damping, LEAST_DAMPING)
        t = np.arange(0.0, sway.duration, STEP)[:, None]
        steady = self.gains * W**2 / (w**2 - W**2 + 2j * z * w * W)
        damped, decay = w * np.sqrt(1.0 - z * z), np.exp(-z * w * t)
        cosine, sine = -steady.real, (-z * w * steady.real + W * steady.imag) / (w * np.sqrt(1.0 - z * z))
        q = (steady * np.exp(1j * W * t)).real + decay * (cosine * np.cos(damped * t) + sine * np.sin(damped * t))
        moved = self.static[:, None, :] * np.cos(W * t) + np.einsum("tk,srk->str", q, self.shapes, optimize=True)
        return sway.amplitude * np.asarray(np.abs(moved).max(axis=1))


def parked_rope(model: Base, car: float) -> ParkedRope:
    """The linearised rope of a car at a height [m]; raises `SimulationError` where no static equilibrium is found."""
    own = model.rope.element_length
    coarse = with_changes(model, {"rope.element_length": max(own, min(COARSE, 0.5 * model.sheave.radius))})  # type: ignore[arg-type]
    found = modes(coarse, car, MODES)
    rope, static = CompensationRope(coarse), _static_shape(coarse, car)
    n, node = rope.n, coarse.rope.mass_per_length * rope.element
    mass = np.full((n + 1, 2), node)
    mass[n] = coarse.sheave.mass_per_rope, coarse.sheave.inertia_per_rope / coarse.sheave.radius**2
    kept = [one for one in found.modes if np.isfinite(one.period)]
    shapes = np.array([one.shape for one in kept])
    gains = np.sum(shapes[:, :n] * (mass[:n] * static), axis=(1, 2)) / np.sum(shapes**2 * mass, axis=(1, 2))
    share = building_share(coarse, found.heights)
    places = [side_nodes(found.heights, side) for side in SIDES]
    return ParkedRope(
        car, 2.0 * np.pi / np.array([one.period for one in kept]), gains,
        np.array([shapes[:, at, 1].T for at in places]), np.array([static[at, 1] - share[at] for at in places]),
        np.array([found.heights[at] for at in places]),
    )  # fmt: skip


def building_share(model: Base, heights: Floats) -> Floats:
    """Displacement of the building at heights (n,) [m] over that at the top landing: linear from the axle up."""
    return np.asarray((heights + model.shaft.pit) / (model.shaft.height + model.shaft.pit))


def side_nodes(heights: Floats, side: str) -> NDArray[np.int64]:
    """READ nodes of a side above the axle, evenly spread."""
    lowest = int(np.argmin(heights))
    ends = (0, lowest - 1) if side == "car" else (lowest + 1, len(heights) - 1)
    return np.linspace(*ends, READ).round().astype(np.int64)


def _static_shape(model: Base, car: float) -> Floats:
    """How the nodes (n, 2) move per displacement of the top of a building that leans slowly; x is down."""
    other = model.shaft.height - car
    left, right = (SHIFT * float(building_share(model, np.array([end]))[0]) for end in (car, other))
    found = []
    for sign in (1.0, -1.0):
        rope = CompensationRope(model)
        rope.solve_equilibrium(car, other, (-sign * left, sign * right))
        n, q = rope.n, np.asarray(rope.state.q)
        found.append(np.column_stack([q[:n], q[n + 1 : 2 * n + 1]]))
    return np.asarray((found[0] - found[1]) / (2.0 * SHIFT))
