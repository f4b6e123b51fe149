"""A rope and the directional derivatives of its motion by its parameters, simulated together.

A direction is a mapping of model keys to amounts, `{"rope.bending_stiffness": 1.0}`; its sensitivity is the
derivative of the motion by a common factor of these amounts. The rope's own motion is that of
`CompensationRope`, bit for bit.
"""

from collections.abc import Mapping

import numpy as np

from ...errors import SimulationError
from ..compiler.workspace import without_friction
from ..integration.inputs import CAR, CAR_OUT, COUNTERWEIGHT, COUNTERWEIGHT_OUT
from ..mechanics.end_conditions import PATH, PATHS
from ..parameters import Base
from ..parameters.parameter_vector import ALPHA, ELEMENT, PIT, RHO, R
from ..runtime.kernel_arguments import Array
from ..runtime.simd import LANES
from ..sensitivity.effects import CHANGED_HISTORY
from ..sensitivity.end_conditions import ENDS_STEP
from .directions_memory import directions_of
from .parameter_directions import Direction
from .rope import CompensationRope

# The sheave's motions: in which array, which component, and with which sign.
SHEAVE = {
    "sheave_displacement": ("dq", 0, -1.0), "sheave_velocity": ("dv", 0, -1.0), "sheave_angle": ("dq", 1, 1.0),
    "sheave_angular_velocity": ("dv", 1, 1.0),
}  # fmt: skip
REST_MOVE = 1e-5  # m, the move by which shapes at rest are differenced
ROUNDING = 1e-12  # m, what rounding leaves of a shape at rest


class SensitiveRope:
    """A rope with its sensitivities along some directions.

    `base` gives, for a direction, values of parameters that change nothing until the direction's amplitude is
    there: the phase or the frequency of an effect that the model is without. `exact` factors the tangent once more in
    each step, for about a third of a plain step: without it derivatives of displacements err by some tenths of a per
    cent, and by up to 3 % where a direction moves nodes along the sheave (radius, pit).
    """

    def __init__(
        self,
        model: Base,
        directions: Mapping[str, Direction],
        base: Mapping[str, Direction] | None = None,
        *,
        exact: bool = False,
    ) -> None:
        self.rope = CompensationRope(model)
        self.names = tuple(directions)
        self._directions = directions_of(self.rope, directions, base or {}, exact=exact)
        d, number, workspace = self._directions, len(self.names), self.rope.workspace
        self._base, self._change = (one.reshape(number, d.parameters) for one in (d.base, d.change))
        shape = (d.blocks, self.rope.n + 1, 2, LANES)
        self._answers = {name: getattr(d, name).reshape(shape) for name in ("dq", "dv", "da", "dc")}
        self._forces, self._history = d.work.D.reshape(shape), d.dh.reshape(number, workspace.rope.history_size)
        self._advance, self._changed_equilibrium, self._differentiate, self._read_sensors = (
            workspace.bind(name, d)
            for name in ("advance_with_directions", "changed_equilibrium", "differentiate_forces", "read_sensors_along")
        )

    def _at_node(self, array: Array, i: int, component: int) -> Array:
        """One number of all directions: that of a node, or of the sheave where i is the number of nodes."""
        return array[:, i, component].reshape(-1)[: len(self.names)].copy()

    # -- at rest ---------------------------------------------------------------------------------

    def solve_equilibrium(
        self, car: float, counterweight: float, outward: tuple[float, float] = (0.0, 0.0), time: float = 0.0
    ) -> None:
        """Bring the rope to rest, as `CompensationRope.solve_equilibrium`, and find how that shape answers each direction."""
        self.rope.solve_equilibrium(car, counterweight, outward, time)
        for array in (*self._answers.values(), self._history):
            array[:] = 0.0
        for k in range(len(self.names)):
            change, self._history[k] = self._equilibrium_change(k)
            self._answers["dq"][k // LANES, :, :, k % LANES] = change.reshape(2, -1).T
        self._differentiate(t=time)
        self._answers["dc"][:] = self.rope.p[ALPHA] * self._forces

    def _equilibrium_change(self, k: int) -> tuple[Array, Array]:
        """Change of the shape at rest and of its history along direction k, by central differences.

        A first small step tells which one moves the rope by REST_MOVE, if any does.
        """
        d, limit = self._directions, self._directions.max_step[k]
        step = ENDS_STEP * limit
        moved = np.abs(self._equilibrium_beside(k, step)[0] - self.rope.state.q).max()
        step = min(limit, step * REST_MOVE / moved) if moved > ROUNDING else limit
        if moved <= ROUNDING and d.effects_mode[k] != CHANGED_HISTORY and not d.new_history[k]:
            return np.zeros_like(self.rope.state.q), np.zeros(self._history.shape[1])
        (q, h), (q1, h1) = self._equilibrium_beside(k, -step), self._equilibrium_beside(k, step)
        return (q1 - q) / (2.0 * step), 0.5 * (h + h1) if d.new_history[k] else (h1 - h) / (2.0 * step)

    def _equilibrium_beside(self, k: int, step: float) -> tuple[Array, Array]:
        """Shape and history of the rope at rest a step along direction k."""
        work, state, workspace = self._directions.work, self.rope.state, self.rope.workspace
        work.p1[:] = self._base[k] + step * self._change[k]
        work.frictionless1[:] = without_friction(work.p1)
        path_change = self._directions.dpath.reshape(-1, PATHS * PATH)[k]
        work.path1[:] = fixed_ends(workspace.ends.u, self.rope.p[R]) + step * path_change
        workspace.motion.q[:] = state.q
        if self._changed_equilibrium(t=float(state.time[0])) < 0.0:
            raise SimulationError(f"direction {self.names[k]}: no shape at rest was found beside the rope's own")
        return workspace.motion.q.copy(), work.history_in[: self._history.shape[1]].copy()

    # -- in motion -------------------------------------------------------------------------------

    def step(self, dt: float, path: Array, path_changes: Array | None = None) -> None:
        """Advance by dt [s] while the ends follow `path`, as `CompensationRope.step`.

        `path_changes` (directions, PATHS * PATH) are the derivatives of the path along the directions; without it the
        ends hang over the sheave's sides and know nothing else of the parameters.
        """
        self.rope.workspace.ends.path[:] = path
        if path_changes is not None:
            self._directions.dpath[:] = np.asarray(path_changes, float).ravel()
            self._directions.moves_ends[:] = 1.0
        self.rope.require_success(self._advance(dt=dt))

    # -- outputs ---------------------------------------------------------------------------------

    def read_sensors(self) -> Array:
        """Reading of each sensor: outward displacement [m], 1 if the rope is there, derivatives along all directions.

        Returns (sensors, 2 + directions); the next call overwrites it.
        """
        sensors = len(self.rope.model.sensors)
        self._read_sensors(sensors=sensors)
        return self._directions.work.readings.reshape(sensors, 2 + len(self.names))

    def lateral_displacement(self) -> Array:
        """Derivatives of what the sensors of the model read [m per direction]: (sensors, directions)."""
        return self.read_sensors()[:, 2:].copy()

    def sheave(self) -> dict[str, Array]:
        """Derivatives of the sheave's motion, by the names of `CompensationRope.sheave`: (directions,)."""
        return {name: self.of_sheave(name) for name in SHEAVE}

    def of_sheave(self, name: str) -> Array:
        """Derivatives of one of these: (directions,)."""
        array, component, sign = SHEAVE[name]
        change = sign * self._at_node(self._answers[array], self.rope.n, component)
        return change + self._change[:, PIT] if name == "sheave_displacement" else change

    def forces(self) -> dict[str, Array]:
        """Derivatives of the forces on sheave and ends, by the names of `CompensationRope.outputs`: (directions,)."""
        n, p, dp, a = self.rope.n, self.rope.p, self._change, self.rope.state.a
        self._differentiate(t=float(self.rope.state.time[0]))
        half, dhalf = 0.5 * p[RHO] * p[ELEMENT], 0.5 * (dp[:, RHO] * p[ELEMENT] + p[RHO] * dp[:, ELEMENT])
        tensions = {}
        for name, i in (("car", 0), ("counterweight", n - 1)):
            acceleration = self._at_node(self._answers["da"], i, 0)
            tensions[f"{name}_end_tension"] = self._at_node(self._forces, i, 0) - half * acceleration - dhalf * a[i]
        return {"sheave_force": -self._directions.work.lift[: len(self.names)], **tensions}

    # -- state -----------------------------------------------------------------------------------

    def to_bytes(self) -> bytes:
        """The rope's state and all sensitivities."""
        return self.rope.state.to_bytes() + b"".join(one.tobytes() for one in (*self._answers.values(), self._history))

    def from_bytes(self, data: bytes) -> None:
        """Restore what `to_bytes` gave for the same model and directions."""
        offset = len(self.rope.state.to_bytes())
        self.rope.state.from_bytes(data[:offset])
        for one in (*self._answers.values(), self._history):
            one[:] = np.frombuffer(data, np.float64, one.size, offset).reshape(one.shape)
            offset += one.nbytes


def fixed_ends(u: Array, radius: float) -> Array:
    """A path on which ends with the inputs u stay where they are."""
    path = np.zeros((PATHS, PATH))
    path[:, 0] = path[:, 3] = (-u[CAR], -radius - u[CAR_OUT], -u[COUNTERWEIGHT], radius + u[COUNTERWEIGHT_OUT])
    return path.ravel()
