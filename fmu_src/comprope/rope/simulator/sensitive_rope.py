"""A rope and how its motion answers changes of its parameters, side by side.

A direction is a mapping of model keys to amounts, `{"rope.bending_stiffness": 1.0}`; its sensitivity is the
derivative of the motion by a common factor of these amounts. The rope's own motion is that of
`CompensationRope`, bit for bit.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...errors import SimulationError
from ..compiler.entry_points import compiled
from ..compiler.workspace import without_friction
from ..integration.inputs import CAR, CAR_OUT, COUNTERWEIGHT, COUNTERWEIGHT_OUT
from ..integration.state import Array
from ..mechanics.end_conditions import PATH, PATHS
from ..parameters import Base
from ..runtime.parameter_vector import ALPHA, ELEMENT, PIT, RHO, R
from ..runtime.simd import LANES
from ..sensitivity.effects import CHANGED
from ..sensitivity.newmark import ENDS_STEP
from .parameter_directions import Direction, _begins_history, _guides, _limit, _replaced, _way, parameter_change
from .rope import SIDES, CompensationRope

# The sheave's motions: in which array, which component, and with which sign.
SHEAVE = {
    "sheave_displacement": ("dq", 0, -1.0), "sheave_velocity": ("dv", 0, -1.0), "sheave_angle": ("dq", 1, 1.0),
    "sheave_angular_velocity": ("dv", 1, 1.0),
}  # fmt: skip
SAG = 1e-5  # m, the move by which shapes at rest are differenced
UNMOVED = 1e-12  # m, what rounding leaves of a shape at rest


class SensitiveRope:
    """A rope with its sensitivities along some directions.

    `at` gives, for a direction, values of parameters that change nothing until the direction's amplitude is
    there: the phase or the frequency of an effect that the model is without. `exact` factors the tangent once more in
    each step, for about a third of a plain step: without it derivatives of displacements err by some tenths of a per
    cent, and by up to 3 % where a direction moves nodes along the sheave (radius, pit).
    """

    def __init__(
        self, model: Base, directions: Mapping[str, Direction], at: Mapping[str, Direction] | None = None, *, exact: bool = False
    ) -> None:
        self.exact = exact
        self.rope = CompensationRope(model)
        self.names = tuple(directions)
        p, count = self.rope.p, len(directions)
        self._toward = np.array([parameter_change(self.rope, one) for one in directions.values()]).reshape(count, p.size)
        self._at = np.array([_replaced(p, (at or {}).get(name, {})) for name in self.names]).reshape(count, p.size)
        self._limit = np.array([_limit(p, one) for one in self._toward])
        self._way = np.array([_way(p, one) for one in self._toward], float)
        self._own = np.array([_begins_history(p, one) for one in self._toward], float)
        self._blocks = -(-count // LANES)
        self._motion = {name: np.zeros((self._blocks, self.rope.n + 1, 2, LANES)) for name in ("dq", "dv", "da", "dc")}
        self._history = np.zeros((count, self.rope._do.scalars["state_size"]))
        self._arrays = self._memory_of_kernels()
        names = ("advance_tangent", "hang_again", "differentiate", "look")
        self._advance, self._hang, self._differentiate, self._look = (self._bind(name) for name in names)

    def _memory_of_kernels(self) -> dict[str, Array]:
        """The rope's own arrays, and those of all directions and of what is differenced."""
        do, count, m, p = self.rope._do, len(self.names), self.rope.n + 1, self.rope.p
        sizes = dict.fromkeys(("hp", "hi", "hb", "hd"), do.moving["h0"].size) | dict.fromkeys(("moves", "e0", "f1"), 2 * m)
        sizes |= {"w1": do.w.size, "path1": PATHS * PATH, "p1": p.size, "smooth1": p.size}
        sizes |= {"lift": self._blocks * LANES, "centre": 4 * LANES}
        sizes |= {"D": self._blocks * 2 * m * LANES, "glances": len(self.rope.model.sensors) * (2 + count)}
        own: dict[str, Array] = {name: np.zeros(size) for name, size in sizes.items()}
        own |= {"at": self._at, "toward": self._toward, "dh": self._history, "limit": self._limit}
        own |= {"way": self._way, "own": self._own, "dp": in_lanes(self._toward), "dpath": self._end_paths()}
        own |= {"guided": np.array([_guides(p, one) for one in self._toward], float)}
        sensors = self.rope.model.sensors
        own |= {"depths": np.array([-one.height for one in sensors])}
        own |= {"sides": np.array([SIDES[one.side] for one in sensors], float)}
        return do.moving | {name: array.reshape(-1) for name, array in (own | self._motion).items()}

    def _end_paths(self) -> Array:
        """How the ends' paths move with the directions: with the radius, as they hang over the sheave's sides."""
        paths = np.zeros((len(self.names), PATHS, PATH))
        paths[:, 3, 0] = paths[:, 3, 3] = self._toward[:, R]
        paths[:, 1] = -paths[:, 3]
        return paths

    def _bind(self, name: str) -> Any:
        entry = compiled(self.rope._do.effects)[name]
        own = self.rope._do.scalars | {"directions": len(self.names), "blocks": self._blocks, "parameters": self.rope.p.size}
        own |= {"sensors": len(self.rope.model.sensors)}
        call = entry.bind(**{key: array for key, array in self._arrays.items() if key in entry.names})
        fixed = {key: value for key, value in own.items() if key in entry.names}
        return lambda **scalars: call(**fixed, **scalars)

    def _of_node(self, name: str, i: int, component: int) -> Array:
        """One number of all directions: that of a node, or of the sheave where i is the number of nodes."""
        array = self._arrays["D"].reshape(self._motion["dq"].shape) if name == "D" else self._motion[name]
        return array[:, i, component].reshape(-1)[: len(self.names)].copy()

    # -- at rest ---------------------------------------------------------------------------------

    def settle(self, car: float, counterweight: float, outward: tuple[float, float] = (0.0, 0.0), time: float = 0.0) -> None:
        """Hang the rope at rest, as `CompensationRope.settle`, and find how that shape answers each direction."""
        self.rope.settle(car, counterweight, outward, time)
        for array in (*self._motion.values(), self._history):
            array[:] = 0.0
        for k in range(len(self.names)):
            change, self._history[k] = self._sag(k)
            self._motion["dq"][k // LANES, :, :, k % LANES] = change.reshape(2, -1).T
        self._differentiate(t=time)
        self._motion["dc"][:] = self.rope.p[ALPHA] * self._arrays["D"].reshape(self._motion["dc"].shape)

    def _sag(self, k: int) -> tuple[Array, Array]:
        """Change of the shape at rest and of its history along direction k, by central differences.

        A first small step tells which one moves the rope by SAG, if any does.
        """
        step = ENDS_STEP * self._limit[k]
        moved = np.abs(self._rest(k, step)[0] - self.rope.state.q).max()
        step = min(self._limit[k], step * SAG / moved) if moved > UNMOVED else self._limit[k]
        if moved <= UNMOVED and self._way[k] != CHANGED and not self._own[k]:
            return np.zeros_like(self.rope.state.q), np.zeros(self._history.shape[1])
        (q, h), (q1, h1) = self._rest(k, -step), self._rest(k, step)
        return (q1 - q) / (2.0 * step), 0.5 * (h + h1) if self._own[k] else (h1 - h) / (2.0 * step)

    def _rest(self, k: int, step: float) -> tuple[Array, Array]:
        """Shape and history of the rope at rest a step along direction k."""
        a, state = self._arrays, self.rope.state
        a["p1"][:] = self._at[k] + step * self._toward[k]
        a["smooth1"][:] = without_friction(a["p1"])
        a["path1"][:] = still(self.rope._do.u, self.rope.p[R]) + step * a["dpath"].reshape(-1, PATHS * PATH)[k]
        a["q"][:] = state.q
        if self._hang(t=float(state.time[0])) < 0.0:
            raise SimulationError(f"direction {self.names[k]}: no shape at rest was found beside the rope's own")
        return a["q"].copy(), a["hi"][: self._history.shape[1]].copy()

    # -- in motion -------------------------------------------------------------------------------

    def step(self, dt: float, path: Array, path_changes: Array | None = None) -> None:
        """Advance by dt [s] while the ends follow `path`, as `CompensationRope.step`.

        `path_changes` (directions, PATHS * PATH) are the derivatives of the path along the directions; without it the
        ends hang over the sheave's sides and know nothing else of the parameters.
        """
        self.rope._do.path[:] = path
        if path_changes is not None:
            self._arrays["dpath"][:] = np.asarray(path_changes, float).ravel()
            self._arrays["guided"][:] = 1.0
        self.rope.require(self._advance(dt=dt, exact=self.exact))

    # -- what it shows ---------------------------------------------------------------------------

    def sights(self) -> Array:
        """What each sensor of the model sees: outward displacement [m], 1 if the rope is there, derivatives along all directions.

        Returns (sensors, 2 + directions); the next call overwrites it.
        """
        self._look()
        return self._arrays["glances"].reshape(len(self.rope.model.sensors), 2 + len(self.names))

    def lateral_displacement(self) -> Array:
        """Derivatives of what the sensors of the model see [m per direction]: (sensors, directions)."""
        return self.sights()[:, 2:].copy()

    def sheave(self) -> dict[str, Array]:
        """Derivatives of the sheave's motion, by the names of `CompensationRope.sheave`: (directions,)."""
        return {name: self.of_sheave(name) for name in SHEAVE}

    def of_sheave(self, name: str) -> Array:
        """Derivatives of one of these: (directions,)."""
        array, component, sign = SHEAVE[name]
        change = sign * self._motion[array][:, self.rope.n, component].reshape(-1)[: len(self.names)]
        return change + self._toward[:, PIT] if name == "sheave_displacement" else change

    def forces(self) -> dict[str, Array]:
        """Derivatives of the forces on sheave and ends, by the names of `CompensationRope.outputs`: (directions,)."""
        n, p, dp, a = self.rope.n, self.rope.p, self._toward, self.rope.state.a
        self._differentiate(t=float(self.rope.state.time[0]))
        half, dhalf = 0.5 * p[RHO] * p[ELEMENT], 0.5 * (dp[:, RHO] * p[ELEMENT] + p[RHO] * dp[:, ELEMENT])
        tensions = {
            f"{name}_end_tension": self._of_node("D", i, 0) - half * self._of_node("da", i, 0) - dhalf * a[i]
            for name, i in (("car", 0), ("counterweight", n - 1))
        }
        return {"sheave_force": -self._arrays["lift"][: len(self.names)], **tensions}

    # -- state -----------------------------------------------------------------------------------

    def to_bytes(self) -> bytes:
        """The rope's state and all sensitivities."""
        return self.rope.state.to_bytes() + b"".join(one.tobytes() for one in (*self._motion.values(), self._history))

    def from_bytes(self, data: bytes) -> None:
        """Restore what `to_bytes` gave for the same model and directions."""
        at = len(self.rope.state.to_bytes())
        self.rope.state.from_bytes(data[:at])
        for one in (*self._motion.values(), self._history):
            one[:] = np.frombuffer(data, np.float64, one.size, at).reshape(one.shape)
            at += one.nbytes


def in_lanes(rows: Array) -> Array:
    """Rows of numbers as blocks of LANES rows, number by number (see `lanes`); rows of zeros fill the last block."""
    padded = np.zeros((-(-len(rows) // LANES) * LANES, rows.shape[1]))
    padded[: len(rows)] = rows
    return padded.reshape(-1, LANES, rows.shape[1]).swapaxes(1, 2).ravel()


def still(u: Array, radius: float) -> Array:
    """A path on which ends with the inputs u stay where they are."""
    path = np.zeros((PATHS, PATH))
    path[:, 0] = path[:, 3] = (-u[CAR], -radius - u[CAR_OUT], -u[COUNTERWEIGHT], radius + u[COUNTERWEIGHT_OUT])
    return path.ravel()
