"""The compiled kernels with their arrays filled in: one rope's memory, taken once."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ..effects.base import REGISTRY, sections
from ..integration.inputs import INPUTS
from ..integration.outputs import SHOWN
from ..integration.state import Array, State, empty
from ..linalg import block_band, bordered_band
from ..mechanics.end_conditions import PATH, PATHS
from ..runtime import array_layout
from ..runtime.parameter_vector import DECLARED, MU, slot
from ..runtime.status import TOLD
from .entry_points import compiled

Call = Callable[..., Any]


class Bound:
    """Memory and kernels of one rope of n nodes with parameters p and sensors at `spots` (see `display`).

    `effects` are those whose kernels it has, by default all that are registered. `state` is the accepted state; `u`,
    `path`, `f`, `w`, `touch`, `seen`, `told` and `y` are what calls read or leave. Each kernel is an attribute, to be
    called with its scalars by name.
    """

    def __init__(self, n: int, p: Array, spots: Array | None = None, effects: tuple[str, ...] | None = None) -> None:
        self.effects = tuple(REGISTRY) if effects is None else effects
        count, states = len(self.effects), sections(self.effects)
        self.state, trial = empty(n, states, count), empty(n, states, count)
        m, s = n + 1, self.state
        sizes = {"w": array_layout.SECTIONS * m, "A": array_layout.BAND * m, "L": block_band.FACTOR * m}
        sizes |= {"B": (bordered_band.ROW + 2) * 2 * m + 4}
        sizes |= {
            "Z": array_layout.CONTACT * m + 4,
            "r": 2 * m,
            "touch": array_layout.TOUCH,
            "power": count + 1,
            "path": PATHS * PATH,
            "seen": 2,
            "u": INPUTS,
            "told": TOLD,
        }
        arrays = {name: np.zeros(size) for name, size in sizes.items()} | {
            "p": p,
            "f": trial.f,
            "h1": trial.history,
            "P": trial.powers,
        }
        arrays |= {"smooth": without_friction(p), "spots": np.zeros(1) if spots is None else spots}
        arrays |= {"y": np.zeros(arrays["spots"].size + len(SHOWN))}
        kept = {"h0": s.history, "P0": s.powers, "E": s.energy, "start": s.start, "count": s.count, "time": s.time}
        before = {"q0": s.q, "v0": s.v, "a0": s.a, "f0": s.f}
        self.moving = arrays | kept | before | {"q": trial.q, "v": trial.v, "a": trial.a}
        self.standing = arrays | kept | {"q": s.q, "v": s.v, "a": s.a}
        self.path, self.f, self.w, self.touch = (arrays[name] for name in ("path", "f", "w", "touch"))
        self.u, self.seen, self.told, self.y = (arrays[name] for name in ("u", "seen", "told", "y"))
        self.scalars = {"n": n, "effects": count, "state_size": states * m}
        self.reach, self.settle, self.travel, self.show, self.residual = (
            self._bind(name, self.moving) for name in ("reach", "settle", "travel", "show", "residual")
        )
        self.evaluate, self.place, self.sight, self.side_maximum = (
            self._bind(name, self.standing) for name in ("evaluate", "place", "sight", "side_maximum")
        )

    def _bind(self, name: str, arrays: dict[str, Array]) -> Call:
        entry = compiled(self.effects)[name]
        own = {key: value for key, value in self.scalars.items() if key in entry.names}
        call = entry.bind(**{key: array for key, array in arrays.items() if key in entry.names})
        return lambda **scalars: call(**own, **scalars)

    def renew(self, time: float) -> State:
        """Empty the state in place, at a time [s]; returns it."""
        for array in vars(self.state).values():
            array[:] = 0.0
        self.state.time[0] = time
        return self.state


def without_friction(p: Array) -> Array:
    """Parameters of a rope that settles: no friction on the groove, no effect that has a history."""
    smooth = p.copy()
    smooth[MU] = 0.0
    for effect in REGISTRY.values():
        for name in effect.model_fields if effect.states else ():
            key = f"effects.{effect.name}.{name}"
            smooth[slot(key)] = DECLARED[key].neutral
    return smooth
