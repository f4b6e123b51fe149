"""Directions in the space of model parameters, and how forces and ends depend on them."""

from collections.abc import Mapping

import numpy as np

from ...errors import InputError
from ...quantities import quantities
from ..effects.base import REGISTRY
from ..integration.mesh import element_length
from ..integration.state import Array
from ..runtime.parameter_vector import DECLARED, ELEMENT, R, slot
from ..sensitivity.effects import BEGUN, BY_HAND, CHANGED, DIFFERENCED
from .rope import CompensationRope

Direction = Mapping[str, float]
SHARE = 1e-4  # of a parameter or of its nominal value: the most by which forces are differenced


def parameter_change(rope: CompensationRope, direction: Direction) -> Array:
    """The change of the parameter vector along a direction; elements keep their number and change their length.

    Raises InputError for what is not a physical parameter of the model.
    """
    dp = np.zeros(rope.p.size)
    for key, amount in direction.items():
        if key not in DECLARED or key.startswith(("solver.", "derived.")) or key == "rope.element_length":
            raise InputError(f"{key}: no sensitivity; a physical parameter such as rope.bending_stiffness is accepted")
        dp[slot(key)] = amount
    step, elements = _limit(rope.p, dp), rope.n - 1
    longer, shorter = (element_length(rope.p + way * step * dp, elements) for way in (1.0, -1.0))
    dp[ELEMENT] = (longer - shorter) / (2.0 * step)
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
    """How forces are differentiated along dp (see `acting`): what acts decides.

    An effect with history acts when its first quantity does.
    """
    acting = [name for name in REGISTRY if _acts(p, name)]
    pushing = [name for name, effect in REGISTRY.items() if {"forces", "moments"} & set(effect.hooks)]
    if any(REGISTRY[name].states for name in acting):
        return CHANGED
    if set(acting) & set(pushing):
        return DIFFERENCED
    return BEGUN if any(_touched(dp, name) for name in pushing) else BY_HAND


def _begins_history(p: Array, dp: Array) -> bool:
    """Whether an effect with history that the model is without begins along dp."""
    return any(_touched(dp, name) and not _acts(p, name) for name, effect in REGISTRY.items() if effect.states)


def _guides(p: Array, dp: Array) -> bool:
    """Whether the ends move along dp: with the radius, and where an effect moves them."""
    return bool(dp[R]) or any(_touched(dp, name) or _acts(p, name) for name, effect in REGISTRY.items() if "ends" in effect.hooks)


def _keys(effect: str) -> list[str]:
    names = [f"effects.{effect}.{one.name}" for one in quantities(REGISTRY[effect])]
    return names[:1] if REGISTRY[effect].states else names


def _acts(p: Array, effect: str) -> bool:
    return any(p[slot(key)] != DECLARED[key].neutral for key in _keys(effect))


def _touched(dp: Array, effect: str) -> bool:
    return any(dp[slot(key)] != 0.0 for key in _keys(effect))
