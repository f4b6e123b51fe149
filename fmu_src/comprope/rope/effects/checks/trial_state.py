"""A random state of a rope for tests of an effect's kernels, with ends at about 20 m and 30 m."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...mechanics import internal_forces
from ...parameters.parameter_vector import DECLARED, ELEMENT, HEIGHT, PIT, R
from ...runtime.array_layout import BAND, SECTIONS
from ...runtime.kernel_arguments import Weights
from ..base import HOOKS, Effect, sections

Floats = NDArray[np.float64]
NODES, TIME, CAR = 120, 0.3, 20.7
STEP = 1e-6  # of positions [m], velocities [m/s], curvatures [1/m], angles [rad] and times [s], to take differences


AT_REST = ("derived.base_", "derived.car_wall_", "derived.counterweight_wall_")  # of the building


class TrialState:
    """A rope at random with an effect's quantities at their nominal or neutral values; `call` runs one of its hooks."""

    def __init__(self, effect: type[Effect], *, nominal: bool) -> None:
        self.effect, n, random = effect, NODES, np.random.default_rng(0)
        self.p = np.array([self._value(name, nominal) for name in DECLARED])
        at = _hanging_shape(self.p)
        m = n + 1
        self.arguments: dict[str, Any] = {"n": n, "t": TIME, "p": self.p, "weights": Weights(0.0, 0.0)}
        self.arguments |= {"angle": 0.3, "depth": 1.7}
        self.arguments["q"] = np.concatenate([at[0], [self.p[PIT]], at[1], [0.3]]) + 1e-3 * random.normal(size=2 * m)
        self.arguments |= {"v": 0.2 * random.normal(size=2 * m), "a": random.normal(size=2 * m), "f": np.zeros(2 * m)}
        history = 0.05 * random.normal(size=sections([effect.name]) * m + 1)
        self.arguments |= {"h0": history, "h1": history.copy(), "A": np.zeros(BAND * m), "w": np.zeros(SECTIONS * m)}
        self.refresh()

    def _value(self, name: str, nominal: bool) -> float:
        quantity, own = DECLARED[name], name.startswith(f"effects.{self.effect.name}.")
        if nominal and name in self.effect.brings:
            return self.effect.brings[name]
        if name.startswith(AT_REST):
            return quantity.neutral
        base = not name.startswith("effects.")
        return quantity.nominal if base or (own and nominal) else quantity.neutral

    def refresh(self) -> None:
        """Bring the workspace up to date with positions and velocities, as a step does."""
        n, p, q, v, w = (self.arguments[name] for name in ("n", "p", "q", "v", "w"))
        internal_forces.stretch(n, p, q, v, w)
        internal_forces.bend(n, p, w)

    def call(self, hook: str) -> Any:
        """Return value of a hook; it works on `arguments`."""
        return self.effect.hooks[hook](*(self.arguments[name] for name in HOOKS[hook].split(", ")))

    def forces(self) -> Floats:
        """Forces at the present positions and velocities."""
        self.refresh()
        self.arguments["f"] = np.zeros_like(self.arguments["v"])
        self.call("forces")
        return self.arguments["f"].copy()

    def slope(self, move: Callable[[float], None], evaluate: Callable[[], Floats]) -> Floats:
        """Central difference of a result by the STEP of a move, which is taken back."""
        sides = []
        for step in (STEP, -STEP):
            move(step)
            sides.append(evaluate())
            move(-step)
        return (sides[0] - sides[1]) / (2.0 * STEP)


def _hanging_shape(p: Floats) -> Floats:
    """Positions (2, NODES) round the sheave, in equal elements; sets the element in p."""
    legs = np.array([CAR, p[HEIGHT] - CAR]) + p[PIT]
    s = np.linspace(0.0, legs.sum() + np.pi * p[R], NODES)
    p[ELEMENT] = s[1]
    turn = np.clip((s - legs[0]) / p[R], 0.0, np.pi)
    past = np.maximum(s - legs[0] - np.pi * p[R], 0.0)
    return np.array([np.minimum(s, legs[0]) - CAR + p[R] * np.sin(turn) - past, -p[R] * np.cos(turn)])
