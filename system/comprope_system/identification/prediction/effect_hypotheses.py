"""Hypotheses: effects that may be missing from a model and instruments that may be at fault, as directions of a fit.

The directions of an effect come from its declaration: each parameter whose neutral value is zero is an amplitude; an amplitude
with a phase is fitted as a cosine and a sine.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import product
from math import atan2, hypot, pi

from comprope.quantities import Quantity, quantities
from comprope.rope.effects import INSTRUMENT, REGISTRY, Effect, RopeModel, names_of
from comprope.rope.parameters import Base

from ..data.runs import Channel
from ..settings import HYPOTHESES
from .plant_parameters import Direction

SENSOR_HEIGHT = "sensor_height"


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """One variant of an effect, or a combination of several effects.

    `directions` are what is fitted and `fixed` the parameters that have given values. `polar` are the keys of amplitude and phase
    if the first two directions are a cosine and a sine. `base` is the value of a parameter without the effect. `parts` are
    the hypotheses of a combination, whose directions follow one another. `phase_runs` are the runs with a phase of their own:
    each has one more direction, the difference of its phase.
    """

    effect: str
    directions: tuple[Direction, ...]
    fixed: Mapping[str, float] = field(default_factory=dict)
    polar: tuple[str, str] | None = None
    base: float = 0.0
    parts: tuple["Hypothesis", ...] = ()
    phase_runs: tuple[str, ...] = ()

    def split_coefficients(self, coefficients: list[float]) -> list[tuple["Hypothesis", list[float]]]:
        """Each part of a combination with its own coefficients."""
        found, at = [], 0
        for part in self.parts or (self,):
            found.append((part, coefficients[at : at + len(part.directions)]))
            at += len(part.directions)
        return found

    @property
    def is_instrument(self) -> bool:
        """Whether this is a fault of an instrument."""
        return self.effect in INSTRUMENT

    @property
    def instrument_directions(self) -> list[bool]:
        """Which directions belong to faults of instruments whose derivatives follow from the predictions."""
        return [part.follows_from_predictions for part in self.parts or (self,) for _ in part.directions]

    @property
    def follows_from_predictions(self) -> bool:
        """Whether predictions without it tell how channels answer: so do all faults but that of a sensor's height."""
        return self.is_instrument and self.effect != SENSOR_HEIGHT

    def shifts(self, coefficients: list[float]) -> dict[str, dict[str, float]]:
        """What is added to parameters in single runs: by the run's file and the model key."""
        found: dict[str, dict[str, float]] = {}
        for part, own in self.split_coefficients(coefficients):
            for file, shift in zip(part.phase_runs, own[2:], strict=False):
                assert part.polar is not None
                found.setdefault(file, {})[part.polar[1]] = shift
        return found

    def parameters(self, coefficients: list[float]) -> dict[str, float]:
        """Parameters by model key for coefficients of the directions."""
        if self.parts:
            return {
                key: value for part, own in self.split_coefficients(coefficients) for key, value in part.parameters(own).items()
            }
        values: dict[str, float] = {}
        for direction, coefficient in zip(self.directions, coefficients, strict=True):
            for key, amount in direction.changes.items():
                values[key] = values.get(key, self.base) + coefficient * amount
        if self.polar:
            size = self.directions[0].changes[self.polar[0]]
            values = {self.polar[0]: size * hypot(*coefficients[:2]), self.polar[1]: atan2(coefficients[1], coefficients[0])}
        return dict(self.fixed) | values


def effect_hypotheses(model: RopeModel, frequencies: tuple[float, ...] = ()) -> list[Hypothesis]:
    """All variants of all effects that the model may have; `frequencies` [Hz] are those of oscillating effects."""
    asked = [REGISTRY[name] for name in names_of(model) if REGISTRY[name].hypothesis]
    return [one for effect in asked for one in hypotheses_of_effect(effect, frequencies, heights_tried(model))]


def heights_tried(model: Base) -> tuple[float, ...]:
    """Heights [m] at which effects are tried that act at one height, above the bottom landing."""
    return tuple(share * model.shaft.height for share in HYPOTHESES.heights)


def hypotheses_of_effect(
    effect: type[Effect], frequencies: tuple[float, ...], heights: tuple[float, ...] = ()
) -> list[Hypothesis]:
    """Variants of an effect: one for each combination of the values of its shape parameters that are tried."""
    tried = dict(effect.probes)
    declared = {one.name: one for one in quantities(effect)}
    if "frequency" in declared:
        tried["frequency"] = frequencies or (declared["frequency"].nominal,)
    amplitudes = [one for one in declared.values() if _is_amplitude(one, effect)]
    if "height" in declared and declared["height"] not in amplitudes:
        tried["height"] = heights or (declared["height"].nominal,)
    found = []
    for values in product(*tried.values()):
        chosen = dict(zip(tried, values, strict=True))
        others = {f"effects.{effect.name}.{k}": v for k, v in chosen.items() if k not in {a.name for a in amplitudes}}
        directions = tuple(_direction(effect, one, chosen.get(one.name)) for one in amplitudes)
        found.append(_assembled(effect, directions, others | dict(effect.brings)))
    return found


def combine(*effects: Hypothesis) -> Hypothesis:
    """Combination of several effects."""
    parts = tuple(part for one in effects for part in one.parts or (one,))
    if len(parts) == 1:
        return parts[0]
    directions = tuple(direction for part in parts for direction in part.directions)
    return Hypothesis(" + ".join(dict.fromkeys(part.effect for part in parts)), directions, parts=parts)


def instrument_hypotheses(channels: Mapping[str, Channel]) -> list[Hypothesis]:
    """One hypothesis for each fault of each channel; an offset shows in absolute channels only, a height in lateral ones."""
    found = []
    for column, channel in channels.items():
        noise = channel.scale * (channel.noise or HYPOTHESES.assumed_noise)
        # A wrong sign or unit is a gain error too.
        found.append(_fault("sensor_gain", column, HYPOTHESES.gain_unit, HYPOTHESES.gain_prior, 1.0))
        found.append(_fault("sensor_delay", column, HYPOTHESES.delay_unit, HYPOTHESES.delay_prior, 0.0))
        found.append(_fault("sensor_drift", column, noise / HYPOTHESES.drift_time, HYPOTHESES.drift_prior, 0.0))
        if channel.quantity == "lateral_displacement":
            size, bound = HYPOTHESES.sensor_height_unit, HYPOTHESES.sensor_height_bound
            found.append(_fault(SENSOR_HEIGHT, column, size, HYPOTHESES.sensor_height_prior, 0.0, bound))
        if channel.reference == "absolute":
            found.append(_fault("sensor_offset", column, noise, HYPOTHESES.offset_prior, 0.0))
    return found


def _fault(effect: str, column: str, size: float, prior: float, base: float, bound: float = float("inf")) -> Hypothesis:
    """Fault of the instrument of one channel: `size` per unit of the coefficient, `base` without the fault."""
    key = f"effects.{effect}.{column}"
    return Hypothesis(effect, (Direction(key, {key: size}, prior, -bound, bound),), base=base)


def _is_amplitude(one: Quantity, effect: type[Effect]) -> bool:
    """Whether a parameter is zero without the effect, and no phase."""
    phase = effect.polar is not None and one.name == effect.polar[1]
    return one.neutral == 0.0 and not phase


def _direction(effect: type[Effect], one: Quantity, probe: float | None) -> Direction:
    """Direction of an amplitude in units of its typical value, or of the value that is tried, whose sign it then keeps."""
    key, size = f"effects.{effect.name}.{one.name}", probe if probe is not None else one.nominal
    lower, upper = sorted((one.minimum / size, one.maximum / size))
    return Direction(key, {key: size}, HYPOTHESES.amplitude_prior, max(lower, 0.0) if probe is not None else lower, upper)


def _assembled(effect: type[Effect], directions: tuple[Direction, ...], fixed: dict[str, float]) -> Hypothesis:
    """Hypothesis of an effect; an amplitude with a phase becomes a cosine and a sine."""
    if effect.polar is None:
        return Hypothesis(effect.name, directions, fixed)
    amplitude, phase = (f"effects.{effect.name}.{name}" for name in effect.polar)
    size = directions[0].changes[amplitude]
    pair = tuple(
        Direction(f"{amplitude}.{word}", {amplitude: size, phase: angle}, HYPOTHESES.amplitude_prior, -float("inf"), float("inf"))
        for word, angle in (("cosine", 0.0), ("sine", 0.5 * pi))
    )
    return Hypothesis(effect.name, pair, fixed, (amplitude, phase))
