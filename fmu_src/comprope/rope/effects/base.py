"""What an effect is: quantities declared once, and kernels for the places where it acts.

An effect may act in these ways, each a kernel of fixed arguments (n nodes, m = n + 1 columns per
section, see `work`):

    moments(n, p, w, h0, h1) -> W       adds to w[MOMENT], and its derivative by curvature to w[STIFF]
    forces(n, t, p, q, v, w, f) -> W    adds forces to f, on nodes or on the sheave (column n)
    tangents(n, t, p, q, v, w, A, ck, cc)   subtracts ck df/dq + cc df/dv of its forces from A
    ends(n, t, p, q, v, a)              moves the rope's ends sideways
    groove(p, angle) -> x, y, x', y'    offset of the groove's centre from the axle, and by angle
    begin(n, p, w, h0)                  sets the history h0 of a rope at rest

An effect with history is taken out while the rope settles: it begins in the shape at rest.

W is the power [W] that the effect puts into rope and sheave. With every quantity at its neutral
value a kernel must change nothing.
"""

from collections.abc import Callable
from typing import Any, ClassVar

from ...declare import Component
from .. import slots

Kernel = Callable[..., Any]
HOOKS = ("moments", "forces", "tangents", "ends", "groove", "begin")


class Effect(Component):
    """Base of all effects; `hooks` holds its kernels, `states` its sections of history per node.

    For the diagnosis: `probes` are values to try for quantities in which the response is not linear,
    `polar` names an amplitude and a phase that stand for a cosine and a sine, and `brings` are other
    effects' values that this one cannot do without.
    """

    name: ClassVar[str]
    hooks: ClassVar[dict[str, Kernel]] = {}
    states: ClassVar[int] = 0
    first_state: ClassVar[int] = 0
    probes: ClassVar[dict[str, tuple[float, ...]]] = {}
    polar: ClassVar[tuple[str, str] | None] = None
    brings: ClassVar[dict[str, float]] = {}


REGISTRY: dict[str, type[Effect]] = {}


def register(effect: type[Effect]) -> type[Effect]:
    """Give the effect its slots in the parameter vector and its sections of history."""
    effect.first_state = sum(one.states for one in REGISTRY.values())
    REGISTRY[effect.name] = effect
    slots.declare(f"effects.{effect.name}", effect)
    return effect


def acts(effect: type[Effect], **hooks: Kernel) -> None:
    """Say where an effect acts: `acts(AirDrag, forces=..., tangents=...)`."""
    unknown = set(hooks) - set(HOOKS)
    if unknown:
        raise TypeError(f"{effect.name}: no such hook: {', '.join(sorted(unknown))}; there are {', '.join(HOOKS)}")
    effect.hooks = hooks
