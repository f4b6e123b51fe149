"""Parameter estimates in words, and their limits in sentences."""

from collections.abc import Mapping

from comprope.rope.effects import REGISTRY

from ....identification.data.runs import Channel
from ....identification.estimation.gauss_newton import FitResult
from ....identification.estimation.identifiability import identifiability
from ....identification.estimation.parameter_estimates import Estimate
from .effect_descriptions import parameter_label, parameter_unit
from .formatting import in_handy_unit, listed_words


def estimate_sentences(fitted: FitResult, estimates: Mapping[str, Estimate]) -> list[str]:
    """Which of the effects' parameters are at a bound, undetermined or correlated with another; none where all are settled."""
    found = identifiability(fitted, estimates)
    sentences = []
    if found.at_bound:
        verb = "is" if len(found.at_bound) == 1 else "are"
        names = _capitalised(_names(found.at_bound))
        sentences.append(f"{names} {verb} at the limit of what is accepted, where the interval says little.")
    if found.undetermined:
        sentences.append(f"These data do not determine {_names(found.undetermined)}: the standard error exceeds the value.")
    for first in dict.fromkeys(one[0] for one in found.correlated):
        others = [f"{_name(second)} ({correlation:.2f})" for name, second, correlation in found.correlated if name == first]
        sentences.append(
            f"The estimate of {_name(first)} is strongly correlated with {listed_words(others)}: only together are they settled."
        )
    return sentences


def _capitalised(text: str) -> str:
    return text[:1].upper() + text[1:]


def _names(keys: tuple[str, ...]) -> str:
    return listed_words([_name(key) for key in keys])


def _name(key: str) -> str:
    """The parameter of a model key in words: "the Coulomb torque of bearing friction", "the bending stiffness of the rope"."""
    group, *names = key.split(".", 2)
    if group != "effects":
        return f"the {' '.join(names).replace('_', ' ')} of the {group}"
    effect, name = names
    label = f"the {parameter_label(effect, name)}"
    return f"{label} of {effect.replace('_', ' ')}" if effect in REGISTRY else label


def estimate_in_words(channels: Mapping[str, Channel], key: str, one: Estimate) -> tuple[str, str, str]:
    """Name of an effect's parameter by its model key, its value in a handy unit, and its 95 % interval."""
    _, effect, name = key.split(".", 2)
    value, low, high = in_handy_unit(parameter_unit(channels, effect, name), one.value, one.low, one.high)
    return parameter_label(effect, name), value, f"95 %: {low} to {high}" if one.standard_error > 0.0 else "not fitted"
