"""A rope and how its motion answers changes of its parameters, side by side.

A direction is a mapping of model keys to amounts, `{"rope.bending_stiffness": 1.0}`; its sensitivity is the
derivative of the motion by a common factor of these amounts. The rope's own motion is that of
`CompensationRope`, bit for bit.
"""

from collections.abc import Mapping
from math import pi
from typing import Any

import numpy as np

from ..declare import quantities
from ..errors import InputError, SimulationError
from .bound import without_friction
from .compose import compiled
from .effects.base import REGISTRY
from .ends import PATH, PATHS
from .lanes import LANES
from .model import SIDES, CompensationRope
from .parameters import Base
from .slots import DECLARED, ELEMENT, HEIGHT, PIT, RHO, R, slot
from .standing import CAR, CAR_OUT, COUNTERWEIGHT, COUNTERWEIGHT_OUT
from .state import Array
from .tangent import BY_HAND, CHANGED, DIFFERENCED, ENDS_STEP, OWN
from .words import require_fine

Direction = Mapping[str, float]
SHARE = 1e-4  # of a parameter or of its nominal value: the most by which forces are differenced
SAG = 1e-5  # m, the move by which shapes at rest are differenced


class SensitiveRope:
    """A rope with its sensitivities along some directions.

    `at` gives, for a direction, values of parameters that change nothing until the direction's amplitude is
    there: the phase or the frequency of an effect that the model is without.
    """

    def __init__(self, model: Base, directions: Mapping[str, Direction], at: Mapping[str, Direction] | None = None) -> None:
        self.rope = CompensationRope(model)
        self.names = tuple(directions)
        p, count = self.rope.p, len(directions)
        self._dp = np.array([parameter_change(self.rope, one) for one in directions.values()]).reshape(count, p.size)
        self._at = np.array([_replaced(p, (at or {}).get(name, {})) for name in self.names]).reshape(count, p.size)
        self._limit = np.array([_limit(p, one) for one in self._dp])
        self._way = np.array([_way(p, one) for one in self._dp], float)
        self._arrays = self._memory_of_kernels()
        shapes = dict.fromkeys(("dq", "dv", "da", "df"), 2 * (self.rope.n + 1)) | {"dh": self.rope._do.scalars["state_size"]}
        self.dq, self.dv, self.da, self.df, self.dh = (self._arrays[name].reshape(count, size) for name, size in shapes.items())
        names = ("advance_tangent", "hang_again", "differentiate", "look")
        self._advance, self._hang, self._differentiate, self._look = (self._bind(name) for name in names)

    def _memory_of_kernels(self) -> dict[str, Array]:
        """The rope's own arrays, and those of all directions and of what is differenced."""
        do, count, m = self.rope._do, len(self.names), self.rope.n + 1
        moving, padded, states = do.moving, -(-count // LANES) * LANES, do.moving["h0"].size
        motions = {name: np.zeros(count * 2 * m) for name in ("dq", "dv", "da", "df")}
        scratch = {"D": np.zeros(padded * 2 * m), "rows": np.zeros(padded * 2 * m), "dh": np.zeros(count * do.scalars["state_size"])}
        scratch |= {name: np.zeros(states) for name in ("hp", "hi", "hb", "hd")} | {"moves": np.zeros(2 * m), "f1": np.zeros(2 * m), "fc": np.zeros(2 * m)}
        scratch |= {"w1": np.zeros(do.w.size), "e0": np.zeros(2 * m), "lift": np.zeros(count), "path1": np.zeros(PATHS * PATH)}
        scratch |= {"p1": self.rope.p.copy(), "smooth1": self.rope.p.copy(), "dpath": self._end_paths()}
        sensors = self.rope.model.sensors
        scratch |= {"glances": np.zeros(len(sensors) * count), "depths": np.array([-one.height for one in sensors])}
        scratch |= {"sides": np.array([SIDES[one.side] for one in sensors], float)}
        own = {"dp": self._dp.ravel(), "at": self._at.ravel(), "limit": self._limit, "way": self._way}
        return moving | motions | scratch | own

    def _end_paths(self) -> Array:
        """How the ends' paths move with the directions: with the radius, as they hang over the sheave's sides."""
        paths = np.zeros((len(self.names), PATHS, PATH))
        paths[:, 3, 0] = paths[:, 3, 3] = self._dp[:, R]
        paths[:, 1] = -paths[:, 3]
        return paths.ravel()

    def _bind(self, name: str) -> Any:
        entry = compiled()[name]
        own = self.rope._do.scalars | {"directions": len(self.names), "parameters": self.rope.p.size}
        own |= {"sensors": len(self.rope.model.sensors)}
        call = entry.bind(**{key: array for key, array in self._arrays.items() if key in entry.names})
        fixed = {key: value for key, value in own.items() if key in entry.names}
        return lambda **scalars: call(**fixed, **scalars)

    # -- at rest ---------------------------------------------------------------------------------

    def settle(self, car: float, counterweight: float, outward: tuple[float, float] = (0.0, 0.0), time: float = 0.0) -> None:
        """Hang the rope at rest, as `CompensationRope.settle`, and find how that shape answers each direction."""
        self.rope.settle(car, counterweight, outward, time)
        for array in (self.dq, self.dv, self.da, self.df, self.dh):
            array[:] = 0.0
        for k in range(len(self.names)):
            self.dq[k], self.dh[k] = self._sag(k)
        if self.names:
            self._differentiate(t=time)
            self.df[:] = self._arrays["D"][: self.df.size].reshape(self.df.shape)

    def _sag(self, k: int) -> tuple[Array, Array]:
        """Change of the shape at rest and of its history along direction k, by central differences.

        Shapes at rest cost little beside a run. A first small step tells which one moves the rope by SAG.
        """
        step = ENDS_STEP * self._limit[k]
        moved = np.abs(self._rest(k, step)[0] - self.rope.state.q).max()
        if moved > 0.0:
            step = min(self._limit[k], step * SAG / moved)
        (q, h), (q1, h1) = self._rest(k, -step), self._rest(k, step)
        return (q1 - q) / (2.0 * step), 0.5 * (h + h1) if self._way[k] == OWN else (h1 - h) / (2.0 * step)

    def _rest(self, k: int, step: float) -> tuple[Array, Array]:
        """Shape and history of the rope at rest a step along direction k."""
        a, state = self._arrays, self.rope.state
        a["p1"][:] = self._at[k] + step * self._dp[k]
        a["smooth1"][:] = without_friction(a["p1"])
        a["path1"][:] = still(self.rope._do.u, self.rope.p[R]) + step * a["dpath"].reshape(-1, PATHS * PATH)[k]
        a["q"][:] = state.q
        if self._hang(t=float(state.time[0])) < 0.0:
            raise SimulationError(f"direction {self.names[k]}: no shape at rest was found beside the rope's own")
        kept = a["hi"][: self.dh.shape[1]].copy() if self._way[k] >= CHANGED else np.zeros(self.dh.shape[1])
        return a["q"].copy(), kept

    # -- in motion -------------------------------------------------------------------------------

    def step(self, dt: float, path: Array, path_changes: Array | None = None) -> None:
        """Advance by dt [s] while the ends follow `path`, as `CompensationRope.step`.

        `path_changes` (directions, PATHS * PATH) are the derivatives of the path along the directions; without it the
        ends hang over the sheave's sides and know nothing else of the parameters.
        """
        self.rope._do.path[:] = path
        if path_changes is not None:
            self._arrays["dpath"][:] = np.asarray(path_changes, float).ravel()
        require_fine(self._advance(dt=dt), self.rope._do.told)

    # -- what it shows ---------------------------------------------------------------------------

    def lateral_displacement(self) -> Array:
        """Derivatives of what the sensors of the model see [m per direction]: (sensors, directions)."""
        self._look()
        return self._arrays["glances"].reshape(len(self.rope.model.sensors), len(self.names)) - self._dp[:, R]

    def sheave(self) -> dict[str, Array]:
        """Derivatives of the sheave's motion, by the names of `CompensationRope.sheave`: (directions,)."""
        n = self.rope.n
        return {
            "sheave_displacement": self._dp[:, PIT] - self.dq[:, n],
            "sheave_velocity": -self.dv[:, n],
            "sheave_angle": self.dq[:, 2 * n + 1].copy(),
            "sheave_angular_velocity": self.dv[:, 2 * n + 1].copy(),
        }

    def forces(self) -> dict[str, Array]:
        """Derivatives of the forces on sheave and ends, by the names of `CompensationRope.outputs`: (directions,)."""
        n, p = self.rope.n, self.rope.p
        self._differentiate(t=float(self.rope.state.time[0]))
        f = self._arrays["D"][: self.df.size].reshape(self.df.shape)
        half, dhalf = 0.5 * p[RHO] * p[ELEMENT], 0.5 * (self._dp[:, RHO] * p[ELEMENT] + p[RHO] * self._dp[:, ELEMENT])
        ends = {name: f[:, i] - half * self.da[:, i] - dhalf * self.rope.state.a[i] for name, i in (("car", 0), ("counterweight", n - 1))}
        return {"sheave_force": -self._arrays["lift"], **{f"{name}_end_tension": value for name, value in ends.items()}}

    # -- state -----------------------------------------------------------------------------------

    def to_bytes(self) -> bytes:
        """The rope's state and all sensitivities."""
        return self.rope.state.to_bytes() + b"".join(one.tobytes() for one in (self.dq, self.dv, self.da, self.df, self.dh))

    def from_bytes(self, data: bytes) -> None:
        """Restore what `to_bytes` gave for the same model and directions."""
        at = len(self.rope.state.to_bytes())
        self.rope.state.from_bytes(data[:at])
        for one in (self.dq, self.dv, self.da, self.df, self.dh):
            one[:] = np.frombuffer(data, np.float64, one.size, at).reshape(one.shape)
            at += one.nbytes


def still(u: Array, radius: float) -> Array:
    """A path on which ends with the inputs u stay where they are."""
    path = np.zeros((PATHS, PATH))
    path[:, 0] = path[:, 3] = (-u[CAR], -radius - u[CAR_OUT], -u[COUNTERWEIGHT], radius + u[COUNTERWEIGHT_OUT])
    return path.ravel()


def parameter_change(rope: CompensationRope, direction: Direction) -> Array:
    """The change of the parameter vector along a direction; elements keep their number and change their length.

    Raises InputError for what is not a physical parameter of the model.
    """
    dp = np.zeros(rope.p.size)
    for key, amount in direction.items():
        if key not in DECLARED or key.startswith(("solver.", "derived.")) or key == "rope.element_length":
            raise InputError(f"{key}: no sensitivity; a physical parameter such as rope.bending_stiffness is accepted")
        dp[slot(key)] = amount
    dp[ELEMENT] = (2.0 * dp[PIT] + dp[HEIGHT] + pi * dp[R]) / (rope.n - 1)
    return dp


def _replaced(p: Array, values: Direction) -> Array:
    other = p.copy()
    for key, value in values.items():
        other[slot(key)] = value
    return other


def _limit(p: Array, dp: Array) -> float:
    """The largest step along dp: SHARE of each parameter that it changes."""
    sizes = np.maximum(np.abs(p), [one.nominal for one in DECLARED.values()])
    steps = [SHARE * size / abs(change) for size, change in zip(sizes, dp, strict=True) if change != 0.0]
    return float(min(steps, default=1.0))


def _way(p: Array, dp: Array) -> int:
    """How forces are differentiated along dp (see `tangent`): what acts decides.

    An effect with history is in the model when its first quantity is.
    """
    ways = [BY_HAND]
    for name, effect in REGISTRY.items():
        slots = [slot(f"effects.{name}.{one.name}") for one in quantities(effect)]
        acts = any(p[at] != DECLARED[f"effects.{name}.{one.name}"].neutral for at, one in zip(slots, quantities(effect), strict=True))
        touched = bool(dp[slots].any())
        if {"forces", "moments"} & set(effect.hooks) and (acts or touched):
            ways.append(DIFFERENCED)
        first = next(quantities(effect))
        if effect.states and p[slots[0]] != DECLARED[f"effects.{name}.{first.name}"].neutral:
            return CHANGED
        if effect.states and dp[slots[0]]:
            ways.append(OWN)
    return max(ways)
