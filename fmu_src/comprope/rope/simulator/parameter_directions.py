"""Directions in the space of model parameters, and how forces and ends depend on them."""

from collections.abc import Mapping

import numpy as np

from ...errors import InputError
from ...quantities import quantities
from ..effects.base import REGISTRY
from ..integration.mesh import INERTIA, MASS, ROPES, element_length
from ..parameters.parameter_vector import DECLARED, ELEMENT, J, M, R, slot
from ..runtime.kernel_arguments import Array
from ..sensitivity.effects import CHANGED_EFFECTS, CHANGED_HISTORY, NEW_EFFECTS, NO_EFFECTS
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
    dp[M], dp[J] = ((dp[whole] - rope.p[share] * dp[ROPES]) / rope.p[ROPES] for whole, share in ((MASS, M), (INERTIA, J)))
    step, elements = largest_step(rope.p, dp), rope.n - 1
    longer, shorter = (element_length(rope.p + sign * step * dp, elements) for sign in (1.0, -1.0))
    dp[ELEMENT] = (longer - shorter) / (2.0 * step)
    return dp


def replaced(p: Array, values: Direction) -> Array:
    """The parameter vector with some values replaced."""
    other = p.copy()
    for key, value in values.items():
        other[slot(key)] = value
    other[M], other[J] = other[MASS] / other[ROPES], other[INERTIA] / other[ROPES]
    return other


def largest_step(p: Array, dp: Array) -> float:
    """The largest step along dp by which forces are differenced: SHARE of each parameter that it changes."""
    sizes = np.maximum(np.abs(p), [one.nominal for one in DECLARED.values()])
    steps = [SHARE * size / abs(change) for size, change in zip(sizes, dp, strict=True) if change != 0.0]
    return float(min(steps, default=1.0))


def effects_mode(p: Array, dp: Array) -> int:
    """How effects take part in the forces along dp (see `sensitivity.effects`): those that the model has decide.

    An effect with history is in the model when its first quantity is not neutral.
    """
    present = [name for name in REGISTRY if _is_present(p, name)]
    with_forces = [name for name, effect in REGISTRY.items() if {"forces", "moments"} & set(effect.hooks)]
    if any(REGISTRY[name].states for name in present):
        return CHANGED_HISTORY
    if set(present) & set(with_forces):
        return CHANGED_EFFECTS
    return NEW_EFFECTS if any(_is_changed(dp, name) for name in with_forces) else NO_EFFECTS


def begins_history(p: Array, dp: Array) -> bool:
    """Whether an effect with history that the model is without begins along dp."""
    return any(_is_changed(dp, name) and not _is_present(p, name) for name, effect in REGISTRY.items() if effect.states)


def moves_ends(p: Array, dp: Array) -> bool:
    """Whether the ends move along dp: with the radius, and where an effect moves them."""
    moving = [name for name, effect in REGISTRY.items() if "ends" in effect.hooks]
    return bool(dp[R]) or any(_is_changed(dp, name) or _is_present(p, name) for name in moving)


def _keys(effect: str) -> list[str]:
    names = [f"effects.{effect}.{one.name}" for one in quantities(REGISTRY[effect])]
    return names[:1] if REGISTRY[effect].states else names


def _is_present(p: Array, effect: str) -> bool:
    return any(p[slot(key)] != DECLARED[key].neutral for key in _keys(effect))


def _is_changed(dp: Array, effect: str) -> bool:
    return any(dp[slot(key)] != 0.0 for key in _keys(effect))
