"""Limits of parameter estimates in sentences."""

from collections.abc import Mapping

from ...estimation.gauss_newton import FitResult
from ...estimation.identifiability import identifiability
from ...estimation.parameter_estimates import Estimate
from .formatting import listed_words


def estimate_sentences(fitted: FitResult, estimates: Mapping[str, Estimate]) -> list[str]:
    """Which of the effects' parameters are at a bound, undetermined or correlated with another; none where all are settled."""
    found = identifiability(fitted, estimates)
    sentences = []
    if found.at_bound:
        verb = "is" if len(found.at_bound) == 1 else "are"
        sentences.append(f"{_names(found.at_bound)} {verb} at the limit of what is accepted, where the interval says little.")
    if found.undetermined:
        sentences.append(f"These data do not determine {_names(found.undetermined)}: the standard error exceeds the value.")
    for first in dict.fromkeys(one[0] for one in found.correlated):
        others = [f"{_name(second)} ({correlation:.2f})" for name, second, correlation in found.correlated if name == first]
        sentences.append(
            f"The estimate of {_name(first)} is strongly correlated with {listed_words(others)}: only together are they settled."
        )
    return sentences


def _names(keys: tuple[str, ...]) -> str:
    return listed_words([_name(key) for key in keys])


def _name(key: str) -> str:
    """The parameter by its key in the model file, without the table of effects."""
    return key.removeprefix("effects.")
