"""Results of the identification in sentences."""

import numpy as np

from ..comparison.compare import Comparison
from ..diagnosis.diagnose import Diagnosis
from ..diagnosis.held_out_validation import ValidatedDiagnosis, full_name, implausible_parameters, ranking, reduced_chi_square
from ..model_updating.add_effect import Added
from ..model_updating.stepwise_selection import Journey
from ..settings import COMPARISON
from .formatting import chance, number, percent


def compared(one: Comparison) -> str:
    """One sentence: how far off, and whether that is more than noise."""
    held = f", {percent(one.validate_nrmse)} on the runs held out" if np.isfinite(one.validate_nrmse) else ""
    ratio = one.chi_square
    rest = "noise explains all of it" if ratio < COMPARISON.adequate else "more than noise is left to explain"
    return (
        f"The model misses by {percent(one.fit_nrmse)} of what the channels vary on the fit runs{held}; noise alone would leave "
        f"{percent(one.floor('fit'))}. What is left is {number(ratio)} times the noise's mean square: {rest}."
    )


def verdict(validated: ValidatedDiagnosis) -> list[str]:
    """What is missing, in sentences a newcomer understands."""
    found = validated.diagnosis
    surely = found.probabilities
    ruled_out = [f"Ruled out beforehand: {', '.join(sorted(out))}."] if (out := found.problem.ruled_out) else []
    bent = _bent(found)
    if found.verdict:
        return [_missing(validated), *_twins(found), *bent, *ruled_out]
    if found.kind == "adequate":
        told = "Nothing is missing: with its plant parameters refitted the model is as near as noise allows"
        return [f"{told} (probability {chance(surely['adequate'])}).", *bent, *ruled_out]
    return [
        f"Something is missing, and none of the known effects explains it (probability {chance(surely['unknown'])}).",
        *bent,
        "See what the rest is locked to: that is the clue.",
        *ruled_out,
    ]


def _missing(validated: ValidatedDiagnosis) -> str:
    found, top = validated.diagnosis, ranking(validated)[0]
    name = full_name(found.ranking[0].hypothesis)
    others = top.get("together_with", {})
    more = f", and {', '.join(others)}," if others else ""
    what = "An instrument is at fault" if found.kind == "instrument" else "Missing"
    left = reduced_chi_square(validated, found.ranking[0])
    rest = "" if left < 1.5 else f" It leaves {number(left)} times what noise would: perhaps something more is missing."
    return (
        f"{what}: {name}{more} with probability {chance(top['probability'])}. With it the error falls from "
        f"{percent(top['error_before'])} to {percent(top['error_after'])} on the fit runs and from "
        f"{percent(top['validate_error_before'])} to {percent(top['validate_error_after'])} on runs held out; noise alone would "
        f"leave {percent(validated.before.floor('fit'))} and {percent(validated.before.floor('validate'))}.{rest}"
    )


def _bent(found: Diagnosis) -> list[str]:
    """What a fit asks of the plant that no data sheet allows."""
    told = [
        f"{key} by {change:+.0%}, {abs(off):.0f} times what it usually errs by"
        for key, change, off in implausible_parameters(found)
    ]
    return [f"The fit needs a plant far off what is stated: {'; '.join(told)}."] if told else []


def _twins(found: Diagnosis) -> list[str]:
    twins = sorted({a if b == found.verdict else b for a, b in found.indistinguishable if found.verdict in (a, b)})
    likely = [name for name in twins if found.probabilities.get(name, 0.0) > 0.02]
    return [f"These data hardly tell it from {', '.join(likely)}."] if likely else []


def added(one: Added) -> str:
    """One sentence: what an effect did to the errors."""
    return (
        f"With {one.effect} the error goes from {percent(one.before.fit_nrmse)} to {percent(one.after.fit_nrmse)} on the "
        f"fit runs and from {percent(one.before.validate_nrmse)} to {percent(one.after.validate_nrmse)} on runs held out; "
        f"refitting the plant alone gives {percent(one.refitted.fit_nrmse)} and {percent(one.refitted.validate_nrmse)}."
    )


def travelled(found: Journey) -> str:
    """One sentence: where a journey ended."""
    first, last = found.steps[0], found.steps[-1]
    names = [one.name for one in found.steps[2:]]
    end = {"adequate": "nothing is missing beyond noise", "unknown_effect": "something is left that no known effect explains"}
    added_ones = f"Added {', '.join(names)}" if names else "No effect was added"
    return (
        f"{added_ones}: the error went from {percent(first.fit)} to {percent(last.fit)} on the fit runs and from "
        f"{percent(first.validate)} to {percent(last.validate)} on runs held out; "
        f"{end.get(found.last.kind, 'more may be missing')}."
    )
