"""Results of the identification in sentences, for terminal and pages."""

import numpy as np

from ....identification.comparison.compare import Comparison
from ....identification.comparison.largest_error import largest_error
from ....identification.diagnosis.diagnose import Diagnosis
from ....identification.diagnosis.held_out_validation import (
    ValidatedDiagnosis,
    full_name,
    implausible_parameters,
    ranking,
    reduced_chi_square,
)
from ....identification.model_updating.stepwise_selection import StepwiseSelection
from ....identification.model_updating.updated_model import UpdatedModel
from ....identification.settings import COMPARISON, VERDICT
from .detection_limits import detection_sentence
from .formatting import number, percent, probability

WHEN = {
    "rest": "at rest", "acceleration": "during acceleration", "cruise": "during cruise", "deceleration": "during deceleration",
    "after_stop": "after the stop",
}  # fmt: skip


def largest_error_sentence(one: Comparison) -> str:
    """Where the model fails most: channel, run, phase of the trip, and the size of the error."""
    worst = largest_error(one)
    if worst is None:
        return "The model fails nowhere beyond the measurement noise."
    scale, unit = worst.channel.scale, worst.channel.unit
    return (
        f"It fails most at {worst.channel.column} in {worst.file} ({worst.role}) {WHEN[worst.phase]}: RMS error "
        f"{number(worst.rms / scale)} {unit} (NRMSE {percent(worst.share)}), largest residual "
        f"{number(worst.peak / scale)} {unit} at {worst.peak_time:.3g} s."
    )


def comparison_sentences(one: Comparison) -> list[str]:
    """NRMSE on fit and validation runs beside that of noise alone, and whether the residual exceeds the noise."""
    validation = f", {percent(one.validate_nrmse)} on the validation runs" if np.isfinite(one.validate_nrmse) else ""
    if one.reduced_chi_square < COMPARISON.adequate:
        residual = "the residual is explained by measurement noise"
    else:
        residual = "the residual exceeds the measurement noise"
    return [
        f"NRMSE {percent(one.fit_nrmse)} on the fit runs{validation} (RMS error / standard deviation of the measured channel); "
        f"noise alone would give {percent(one.noise_nrmse('fit'))}.",
        f"Reduced chi-square {number(one.reduced_chi_square)}: {residual}.",
    ]


def verdict_sentences(validated: ValidatedDiagnosis) -> list[str]:
    """The verdict with its probability, then what qualifies it."""
    found = validated.diagnosis
    excluded = [f"Excluded by the user: {', '.join(sorted(out))}."] if (out := found.problem.ruled_out) else []
    implausible = _implausible(found)
    if found.verdict:
        left = reduced_chi_square(validated, found.ranking[0])
        return [_missing_effect(validated), *_overestimated_noise(left), *implausible, *excluded]
    if found.kind == "adequate":
        text = "Nothing is missing: with refitted plant parameters the residual is explained by measurement noise"
        sure = f"{text} (probability {probability(found.probabilities['adequate'])})."
        left = found.baseline.chi_square / max(len(found.problem.data), 1)
        return [sure, *_overestimated_noise(left), detection_sentence(found), *implausible, *excluded]
    return [
        "An effect is missing, and none of the known effects explains the residual "
        f"(probability {probability(found.probabilities['unknown'])}).",
        *implausible,
        "The residual correlations and the estimated force indicate its kind.",
        *excluded,
    ]


def _missing_effect(validated: ValidatedDiagnosis) -> str:
    found, top = validated.diagnosis, ranking(validated)[0]
    others = top.get("together_with", {})
    names = " and ".join([full_name(found.ranking[0].hypothesis), *others])
    rivals = [f" or {name} ({probability(found.probabilities[name])})" for name in likely_rivals(found)]
    share = f"{names} ({probability(top['probability'])}){''.join(rivals)}, which these data hardly distinguish"
    verdict = share if rivals else f"{names}, probability {probability(top['probability'])}"
    kind = "Faulty instrument" if found.kind == "instrument" else "Missing effect"
    left = reduced_chi_square(validated, found.ranking[0])
    rest = (
        ""
        if left < VERDICT.incomplete_chi_square
        else f" Reduced chi-square with it {number(left)}: another effect may be missing."
    )
    return (
        f"{kind}: {verdict}. With {names if rivals else 'it'} the NRMSE decreases from "
        f"{percent(top['error_before'])} to {percent(top['error_after'])} on the fit runs and from "
        f"{percent(top['validate_error_before'])} to {percent(top['validate_error_after'])} on the validation runs; noise alone "
        f"would give {percent(validated.before.noise_nrmse('fit'))} and "
        f"{percent(validated.before.noise_nrmse('validate'))}.{rest}"
    )


def _overestimated_noise(left: float) -> list[str]:
    """A remark where a fit leaves far less than the noise: `left` is its reduced chi-square."""
    if left >= VERDICT.overestimated_chi_square:
        return []
    factor = number(max(left, 1e-300) ** -0.5)
    return [
        f"What is left is less than the noise by a factor of {factor}: it is overestimated, by what campaign.toml states "
        "or because strong vibration in motion counts as noise, and smaller effects go unnoticed."
    ]


def _implausible(found: Diagnosis) -> list[str]:
    """Plant parameters that the fit changes by more than a data sheet can be wrong."""
    changed = [
        f"{key} by {change:+.0%} ({abs(shift):.0f} prior standard deviations)"
        for key, change, shift in implausible_parameters(found)
    ]
    return [f"The fit changes plant parameters implausibly far from their priors: {'; '.join(changed)}."] if changed else []


def likely_rivals(found: Diagnosis) -> list[str]:
    """Effects with nearly the response of the verdict's and a probability that counts, the most probable first."""
    others = {a if b == found.verdict else b for a, b in found.indistinguishable if found.verdict in (a, b)}
    likely = [name for name in others if found.probabilities.get(name, 0.0) > VERDICT.likely_probability]
    return sorted(likely, key=lambda name: -found.probabilities[name])


def update_sentence(one: UpdatedModel) -> str:
    """NRMSE before and after an effect was added or refitted."""
    return (
        f"With {one.effect} the NRMSE changes from {percent(one.before.fit_nrmse)} to {percent(one.after.fit_nrmse)} on the "
        f"fit runs and from {percent(one.before.validate_nrmse)} to {percent(one.after.validate_nrmse)} on the validation runs; "
        f"refitted plant parameters alone give {percent(one.refitted.fit_nrmse)} and {percent(one.refitted.validate_nrmse)}."
    )


def selection_sentence(found: StepwiseSelection) -> str:
    """Effects added by a stepwise selection, and the NRMSE before and after."""
    first, last = found.steps[0], found.steps[-1]
    names = [one.name for one in found.steps[2:]]
    end = {
        "adequate": "the residual is explained by measurement noise",
        "unknown_effect": "a residual remains that no known effect explains",
    }
    added = f"Added {', '.join(names)}" if names else "No effect was added"
    return (
        f"{added}: the NRMSE changed from {percent(first.fit_nrmse)} to {percent(last.fit_nrmse)} on the fit runs and from "
        f"{percent(first.validate_nrmse)} to {percent(last.validate_nrmse)} on the validation runs; "
        f"{end.get(found.final_diagnosis.kind, 'further effects may be missing')}."
    )
