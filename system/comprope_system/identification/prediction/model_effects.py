"""Effects that a model file contains, as hypotheses that can be fitted again; shape parameters and names of effects."""

from collections.abc import Mapping, Sequence
from math import cos, isfinite, log, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comprope.errors import InputError
from comprope.quantities import Quantity, quantities
from comprope.rope.effects import INSTRUMENT, REGISTRY, RopeModel
from comprope.rope.simulator.rope import values_of
from comprope.validation_messages import suggestion

from ..data.campaign import Campaign
from ..data.runs import Channel
from ..settings import HYPOTHESES
from .effect_hypotheses import Hypothesis, combine, heights_tried, hypotheses_of_effect, instrument_hypotheses
from .plant_parameters import Direction

Floats = NDArray[np.float64]
SIDE = "side"  # of the shaft, where an effect acts on one: of its values only the sign counts, so it is tried and not fitted


def effect_values(model: RopeModel) -> dict[str, float]:
    """Parameters of the model's effects and of faults of instruments, by model key."""
    found = {key: value for key, value in values_of(model).items() if key.startswith("effects.")}
    for name in INSTRUMENT:
        table: Mapping[str, float] = getattr(model.effects, name) or {}
        found |= {f"effects.{name}.{column}": value for column, value in table.items()}
    return found


def effects_in_model(campaign: Campaign) -> tuple[Hypothesis | None, Floats]:
    """All effects of the campaign's model as one hypothesis, None if it has none, and their coefficients (k,)."""
    values = effect_values(campaign.model)
    names = sorted(
        {key.split(".")[1] for key in values},
        key=lambda name: (name in INSTRUMENT, list(REGISTRY).index(name) if name in REGISTRY else 0),
    )
    found = [one for name in names for one in _as_hypotheses(name, values, campaign.channels)]
    return combined_or_none([one for one, _ in found]), np.array([c for _, own in found for c in own], float)


def combined_or_none(parts: Sequence[Hypothesis]) -> Hypothesis | None:
    """Combination of several effects in this order, None for none; of two that set a parameter the later one applies."""
    return combine(*parts) if parts else None


def _as_hypotheses(
    name: str, values: Mapping[str, float], channels: Mapping[str, Channel]
) -> list[tuple[Hypothesis, list[float]]]:
    if name in INSTRUMENT:
        return [
            (one, coefficients_of(one, values))
            for one in instrument_hypotheses(channels)
            if one.effect == name and one.directions[0].name in values
        ]
    own = {key: value for key, value in values.items() if key.startswith(f"effects.{name}.")}
    tried = [_at(one, own) for one in hypotheses_of_effect(REGISTRY[name], (own.get(f"effects.{name}.frequency", 1.0),))]
    return [min(((one, coefficients_of(one, own)) for one in tried), key=_distance_from_typical)]


def _at(one: Hypothesis, own: Mapping[str, float]) -> Hypothesis:
    """The hypothesis with all parameters but its amplitudes as in the model."""
    moved = {key for direction in one.directions for key in direction.changes}
    fixed = {key: value for key, value in own.items() if key not in moved}
    return Hypothesis(one.effect, one.directions, fixed, one.polar, one.base)


def stated_effect(effect: str, campaign: Campaign, stated: RopeModel) -> tuple[Hypothesis, list[float]]:
    """A named effect with the parameters that it has in the model `stated`, and its coefficients there."""
    values = {key: one for key, one in effect_values(stated).items() if key.startswith(f"effects.{effect.partition('.')[0]}.")}
    found = _as_hypotheses(effect.partition(".")[0], values, campaign.channels)
    return next((one, own) for one, own in found if effect_name(one) == effect)


def coefficients_of(one: Hypothesis, values: Mapping[str, float]) -> list[float]:
    """Coefficients at which an effect has these parameters."""
    if one.polar:
        size, phase = (values[key] for key in one.polar)
        share = size / one.directions[0].changes[one.polar[0]]
        return [share * cos(phase), share * sin(phase)]
    return [(values[direction.name] - one.base) / direction.changes[direction.name] for direction in one.directions]


def _distance_from_typical(found: tuple[Hypothesis, list[float]]) -> float:
    """Sum of the logarithms by which coefficients differ from typical values; 1e300 if one is out of bounds."""
    total = 0.0
    for direction, c in zip(found[0].directions, found[1], strict=True):
        total += abs(log(max(abs(c), 1e-9))) if direction.lower <= c <= direction.upper else float("inf")
    return total if isfinite(total) else 1e300


def shapes_of(one: Hypothesis, longest: float) -> list[Hypothesis]:
    """Shape parameters of an effect as hypotheses, one for each: a frequency, a yield curvature, a height.

    `longest` is the duration [s] of the longest run, which determines the resolution of a frequency.
    """
    if one.effect not in REGISTRY:
        return []
    probed = {*REGISTRY[one.effect].probes, "frequency", "height"} - {SIDE}
    keys = {f"effects.{one.effect}.{each.name}": each for each in quantities(REGISTRY[one.effect]) if each.name in probed}
    return [_shape(one, key, quantity, longest) for key, quantity in keys.items() if key in one.fixed]


def _shape(one: Hypothesis, key: str, quantity: Quantity, longest: float) -> Hypothesis:
    value = one.fixed[key]
    size, lowest = {
        "frequency": (HYPOTHESES.frequency_unit / longest, -1.0 / HYPOTHESES.frequency_unit),
        "height": (HYPOTHESES.height_unit, -float("inf")),
    }.get(quantity.name, (HYPOTHESES.shape_unit * value, -HYPOTHESES.shape_lower / HYPOTHESES.shape_unit))
    bounds = sorted(((quantity.minimum - value) / size, (quantity.maximum - value) / size))
    direction = Direction(key, {key: size}, HYPOTHESES.shape_prior, max(bounds[0], lowest), bounds[1])
    return Hypothesis(one.effect, (direction,), base=value)


def shape_hypotheses(parts: Sequence[Hypothesis], longest: float) -> list[Hypothesis]:
    """Shape parameters of those effects whose shape is not fitted already, one hypothesis for each."""
    names = [part.effect for part in parts]
    return [shape for part in parts if names.count(part.effect) == 1 for shape in shapes_of(part, longest)]


def require_effects(names: Sequence[str]) -> None:
    """Raise `InputError`, for all names together, if some are not names of effects."""
    known = [*REGISTRY, *INSTRUMENT]
    problems = [f"{name}: not an effect; {suggestion(name, known)}" for name in names if name not in known]
    if problems:
        raise InputError("; ".join(problems))


def hypotheses_named(effect: str, campaign: Campaign, frequencies: tuple[float, ...]) -> list[Hypothesis]:
    """Variants of a named effect; of an instrument's fault for every channel or for one, as in `sensor_gain.cw_low`.

    Raises `InputError` for an unknown name.
    """
    name, _, column = effect.partition(".")
    known = [*REGISTRY, *INSTRUMENT]
    if name not in known or (column and name not in INSTRUMENT):
        raise InputError(f"{effect}: not an effect; {suggestion(name, known)}")
    if name in REGISTRY:
        return hypotheses_of_effect(REGISTRY[name], frequencies, heights_tried(campaign.model))
    faults = [one for one in instrument_hypotheses(campaign.channels) if one.effect == name]
    found = [one for one in faults if not column or one.directions[0].name == f"effects.{effect}"]
    if not found:
        columns = [one.directions[0].name.split(".", 2)[2] for one in faults]
        raise InputError(f"{effect}: no such channel for {name}; {suggestion(column, columns)}")
    return found


def effect_name(part: Hypothesis) -> str:
    """Name of an effect; of an instrument's fault with its channel."""
    return part.directions[0].name.removeprefix("effects.") if part.is_instrument else part.effect


def components_by_effect(
    hypothesis: Hypothesis | None, coefficients: Sequence[float]
) -> dict[str, list[tuple[Hypothesis, list[float]]]]:
    """Parts of a hypothesis with their coefficients, by the name of the effect."""
    found: dict[str, list[tuple[Hypothesis, list[float]]]] = {}
    for part, own in hypothesis.split_coefficients(list(coefficients)) if hypothesis else []:
        found.setdefault(effect_name(part), []).append((part, own))
    return found


def short_names(effect: str, values: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters of one effect by their names without the prefix `effects.NAME.`."""
    prefix = f"effects.{effect.split('.')[0]}."
    return {key.removeprefix(prefix): value for key, value in values.items() if key.startswith(prefix)}
