"""The memory of one rope, taken once, and the entry points that work on it."""

from typing import Any

import numpy as np

from ...kernels.status import MESSAGE_VALUES
from ..effects.base import REGISTRY, sections
from ..integration.input_interpolation import INPUT_MEMORY
from ..integration.inputs import INPUTS
from ..integration.outputs import OUTPUTS
from ..integration.state import empty_state
from ..linalg import block_band, bordered_band
from ..mechanics.end_conditions import PATH, PATHS
from ..parameters.parameter_vector import DECLARED, MU, slot
from ..runtime import array_layout
from ..runtime.kernel_arguments import Array, Ends, Motion, Outputs, RopeData, State, Workspace
from .entry_points import compiled


class RopeWorkspace:
    """Memory and entry points of one rope of n nodes with parameters p and some sensors (see `Outputs.sensors`).

    `effects` are those whose kernels it has, by default all that are registered. Each entry point is an attribute, to be
    called with its numbers by name.
    """

    def __init__(self, n: int, p: Array, sensors: Array | None = None, effects: tuple[str, ...] | None = None) -> None:
        self.effects = tuple(REGISTRY) if effects is None else effects
        count, states, m = len(self.effects), sections(self.effects), n + 1
        self.rope = RopeData(n, count, states * m, p, without_friction(p))
        self.state = empty_state(n, states, count)
        self.ends = empty_ends()
        self.motion = Motion(*(np.zeros(2 * m) for _ in range(3)))
        self.work = empty_workspace(m, count, self.state)
        places = np.zeros(1) if sensors is None else sensors
        self.outputs = Outputs(places, np.zeros(2), np.zeros(places.size + len(OUTPUTS)))
        self.check_reach, self.check_start, self.start_at_rest, self.advance = (
            self.bind(name) for name in ("check_reach", "check_start", "start_at_rest", "advance")
        )
        self.evaluate_outputs, self.energy_residual = (self.bind(name) for name in ("evaluate_outputs", "energy_residual"))
        self.forces, self.place_ends, self.read_displacement, self.read_side_maximum = (
            self.bind(name) for name in ("forces", "place_ends", "read_displacement", "read_side_maximum")
        )

    @property
    def groups(self) -> tuple[Any, ...]:
        """All its memory, as kernels take it."""
        return self.state, self.ends, self.rope, self.motion, self.work, self.outputs

    def bind(self, name: str, *others: Any) -> Any:
        """An entry point bound to this memory, and to other groups that it takes."""
        return compiled(self.effects)[name].bind(*self.groups, *others)

    def clear_state(self, time: float) -> State:
        """Set the state to zero in place, at a time [s]; returns it."""
        for array in self.state:
            array[:] = 0.0
        self.state.time[0] = time
        return self.state


def empty_ends() -> Ends:
    """Inputs, their samples, options and path of the ends: zeros."""
    samples, path, u = np.zeros(INPUT_MEMORY), np.zeros(PATHS * PATH), np.zeros(INPUTS)
    return Ends(samples, path, u, options=np.zeros(2), base=np.zeros(2))


def empty_workspace(m: int, effects: int, state: State) -> Workspace:
    """Workspace of zeros for m columns, a number of effects, and a state."""
    return Workspace(
        w=np.zeros(array_layout.SECTIONS * m),
        f=np.zeros(2 * m),
        history=np.zeros(state.history.size),
        powers=np.zeros(state.powers.size),
        contact=np.zeros(array_layout.CONTACT_RESULTS),
        power=np.zeros(effects + 1),
        A=np.zeros(array_layout.BAND * m),
        L=np.zeros(block_band.FACTOR * m),
        B=np.zeros((bordered_band.ROW + 2) * 2 * m + 4),
        Z=np.zeros(array_layout.CONTACT * m + 4),
        r=np.zeros(2 * m),
        message=np.zeros(MESSAGE_VALUES),
    )


def without_friction(p: Array) -> Array:
    """Parameters for static equilibrium: no friction on the groove, no effect that has a history."""
    frictionless = p.copy()
    frictionless[MU] = 0.0
    for effect in REGISTRY.values():
        for name in effect.model_fields if effect.states else ():
            key = f"effects.{effect.name}.{name}"
            frictionless[slot(key)] = DECLARED[key].neutral
    return frictionless
