"""Base class of effects: declared quantities, and kernels for the hooks at which they act.

An effect may act in these ways, each a kernel of fixed arguments (n nodes, m = n + 1 columns per
section, see `runtime.array_layout`; HOOKS):

    moments(n, p, w, h0, h1) -> W       adds to w[MOMENT], and its derivative by curvature to w[STIFF]
    forces(n, t, p, q, v, w, f) -> W    adds forces to f, on nodes or on the sheave (column n)
    tangents(n, t, p, q, v, w, A, weights)   subtracts ck df/dq + cc df/dv of its forces from A; ck, cc = weights
    ends(n, t, p, q, v, a)              moves the rope's ends
    groove(p, angle) -> x, y, x', y'    offset of the groove's centre from the axle, and by angle
    rail(p, depth) -> y, y'             offset of the axle from the middle at a depth, and by depth
    begin(n, p, w, h0)                  sets the history h0 of a rope at rest

An effect with history is left out of the static equilibrium: its history begins there.

W is the power [W] that the effect puts into rope and sheave. With every quantity at its neutral
value a kernel must change nothing.
"""

import re
from collections.abc import Callable, Iterable
from typing import Any, ClassVar

from ...errors import InputError
from ...quantities import Component
from ..parameters import parameter_vector
from ..runtime.kernel_arguments import Weights

Kernel = Callable[..., Any]
# The arguments of each kernel; their types are HOOK_TYPES.
HOOKS = {
    "moments": "n, p, w, h0, h1",
    "forces": "n, t, p, q, v, w, f",
    "tangents": "n, t, p, q, v, w, A, weights",
    "ends": "n, t, p, q, v, a",
    "groove": "p, angle",
    "rail": "p, depth",
    "begin": "n, p, w, h0",
}
HOOK_TYPES: dict[str, Any] = {"n": int, "t": float, "angle": float, "depth": float, "weights": Weights}  # all others are arrays
# What instruments do to what they show: one value per channel. No part of the rope, so the kernels know nothing of it.
INSTRUMENT = {
    "sensor_gain": "measured / true value of a channel, by the channel's column",
    "sensor_offset": "measured value of a channel for a true value of zero, in SI units, by the channel's column",
    "sensor_delay": "delay of a channel [s], by the channel's column",
    "sensor_height": "height at which a sensor truly looks, as by a tilt, less that of the model [m], by the channel's column",
    "sensor_drift": "rate of a channel's offset from the start of a record, in SI units per second, by the channel's column",
}


class Effect(Component):
    """Base of all effects; `hooks` holds its kernels, `states` its sections of history per node.

    For the diagnosis: `probes` are values to try for quantities in which the response is not linear,
    `polar` names an amplitude and a phase that stand for a cosine and a sine, and `brings` are other
    effects' values that this one cannot do without. The response of a `proportional` effect grows in proportion to its
    quantities, so that one size of it tells of all; those of friction and hysteresis do not.

    `source` is the file of a user's own effect. With `hypothesis` False a diagnosis does not ask whether it is missing: trips
    do not show it.
    """

    name: ClassVar[str]
    source: ClassVar[str] = ""
    hooks: ClassVar[dict[str, Kernel]] = {}
    states: ClassVar[int] = 0
    first_state: ClassVar[int] = 0
    probes: ClassVar[dict[str, tuple[float, ...]]] = {}
    polar: ClassVar[tuple[str, str] | None] = None
    brings: ClassVar[dict[str, float]] = {}
    proportional: ClassVar[bool] = False
    hypothesis: ClassVar[bool] = True


REGISTRY: dict[str, type[Effect]] = {}


def register(effect: type[Effect]) -> type[Effect]:
    """Give the effect its slots in the parameter vector and its sections of history.

    Raises `InputError` for an invalid name or one in use.
    """
    name = getattr(effect, "name", "")
    if not re.fullmatch("[a-z][a-z0-9_]*", name):
        raise InputError(f'{effect.__name__}.name = "{name}": small letters, digits and underscores are accepted')
    if name in INSTRUMENT or name in REGISTRY:
        where = getattr(REGISTRY.get(name), "source", "") or "comprope itself"
        raise InputError(f'{effect.__name__}.name = "{name}": {where} has an effect of this name; another name is accepted')
    effect.first_state = sum(one.states for one in REGISTRY.values())
    REGISTRY[name] = effect
    parameter_vector.declare(f"effects.{name}", effect)
    return effect


def sections(names: Iterable[str]) -> int:
    """How many sections of history these effects need."""
    return max((REGISTRY[name].first_state + REGISTRY[name].states for name in names if REGISTRY[name].states), default=0)


def acts(effect: type[Effect], **hooks: Kernel) -> None:
    """Assign kernels to hooks: `acts(AirDrag, forces=..., tangents=...)`; raises `InputError` for unknown hooks."""
    unknown = set(hooks) - set(HOOKS)
    if unknown:
        raise InputError(f"{effect.name}: no such hook: {', '.join(sorted(unknown))}; there are {', '.join(HOOKS)}")
    effect.hooks = hooks
