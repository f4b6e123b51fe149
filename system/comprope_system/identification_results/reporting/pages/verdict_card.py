"""The card of a verdict: which effect, how large, what else it could be, and what to do next."""

from collections.abc import Sequence
from shlex import quote

from ....identification.diagnosis.diagnose import Diagnosis
from ....identification.diagnosis.experiment_design import ProposedRun
from ....identification.diagnosis.held_out_validation import (
    ValidatedDiagnosis,
    effects_of,
    full_name,
    ranking,
    reduced_chi_square,
)
from ....identification.estimation.parameter_estimates import Estimate, effect_estimates, standard_error_scale
from ....identification.settings import VERDICT
from ....report.card import Card
from ..texts.detection_limits import undetectable
from ..texts.effect_descriptions import drawing, meaning
from ..texts.estimate_sentences import estimate_in_words, estimate_sentences
from ..texts.formatting import listed_words, percent, probability
from .comparison import CURVES
from .evidence import evidence

KINDS = {
    "known_effect": "Missing effect", "instrument": "Faulty instrument", "adequate": "Adequate model",
    "unknown_effect": "Unknown effect",
}  # fmt: skip
NAMES = {"adequate": "nothing missing", "unknown": "an unknown effect"}


def verdict_card(validated: ValidatedDiagnosis, proposals: Sequence[ProposedRun]) -> Card:
    """The verdict at a glance."""
    found = validated.diagnosis
    names = effects_of(found.ranking[0].hypothesis) if found.verdict else [_winner(found)]
    names = list(dict.fromkeys(names))
    title = listed_words([_readable(one) for one in names]) if found.verdict else _titles(found)
    facts = [
        ("probability", probability(found.probabilities[_winner(found)])),
        ("error", _error(validated)),
        ("runner-up", _runner_up(validated)),
        ("looks the same", _indistinguishable(found)),
        ("could not have been seen", _unseen(found)),
        ("next run to measure", _next_run(found, proposals)),
    ]
    values = _values(found) if found.verdict else []
    if found.verdict and (limits := estimate_sentences(found.ranking[0].fitted, _estimates(found))):
        facts.insert(2, ("limits of the estimates", " ".join(limits)))
    drawings, texts = [drawing(one) for one in names], [meaning(one) for one in names]
    shows = evidence(validated.refitted, validated.best, CURVES) if found.verdict else []
    return Card(KINDS[found.kind], title[0].upper() + title[1:], texts, drawings, values, facts, next_command(validated), shows)


def next_command(validated: ValidatedDiagnosis) -> str:
    """The command to type after this diagnosis; empty if nothing is missing."""
    found = validated.diagnosis
    program = "comprope --allow-code" if found.campaign.model.own_effects else "comprope"
    folder = quote(str(found.campaign.folder))
    if found.kind == "adequate":
        return ""
    if found.kind == "unknown_effect":
        return f"{program} diagnose {folder} --report diagnosis.html"
    if incomplete(validated):
        return f"{program} improve {folder} --out MODEL.toml"
    return f"{program} add {folder} {quote(full_name(found.ranking[0].hypothesis))} --out MODEL.toml"


def _winner(found: Diagnosis) -> str:
    """The name of the verdict among the probabilities."""
    return found.ranking[0].hypothesis.effect if found.verdict else "adequate" if found.kind == "adequate" else "unknown"


def _titles(found: Diagnosis) -> str:
    return "nothing is missing" if found.kind == "adequate" else "none of the known effects explains the residual"


def _readable(name: str) -> str:
    return NAMES.get(name, name.replace("_", " "))


def _values(found: Diagnosis) -> list[tuple[str, str, str]]:
    """Parameters of the verdict's effects in handy units with their 95 % intervals; a phase says nothing by itself."""
    channels = found.campaign.channels
    return [estimate_in_words(channels, key, one) for key, one in _estimates(found).items() if key.split(".")[2] != "phase"]


def _estimates(found: Diagnosis) -> dict[str, Estimate]:
    """Estimates of the parameters of the verdict's effects, by model key."""
    fitted = found.ranking[0].fitted
    return effect_estimates(fitted, standard_error_scale(fitted, len(found.problem.data)))


def _error(validated: ValidatedDiagnosis) -> str:
    """NRMSE before and after on fit and validation runs, and what noise alone would give."""
    before, after = validated.before, validated.best
    which = "with it" if validated.diagnosis.verdict else "with refitted plant parameters"
    noise = percent(before.noise_nrmse("fit"))
    return (
        f"NRMSE {percent(before.fit_nrmse)} as given, {percent(after.fit_nrmse)} {which} on the fit runs; "
        f"{percent(before.validate_nrmse)} and {percent(after.validate_nrmse)} on the validation runs; noise alone {noise}"
    )


def _runner_up(validated: ValidatedDiagnosis) -> str:
    """The next in probability."""
    found = validated.diagnosis
    others = {name: value for name, value in found.probabilities.items() if name != _winner(found)}
    if not others:
        return "none"
    name = max(others, key=lambda one: others[one])
    entry = next((one for one in ranking(validated) if one["effect"] == name), None)
    error = f", NRMSE {percent(entry['error_after'])} on the fit runs" if entry else ""
    return f"{_readable(name)}: probability {probability(others[name])}{error}"


def _indistinguishable(found: Diagnosis) -> str:
    pairs = found.indistinguishable
    if not found.verdict:
        return "; ".join(f"{_readable(a)} and {_readable(b)}" for a, b in pairs) or "no two effects"
    others = sorted({a if b == found.verdict else b for a, b in pairs if found.verdict in (a, b)})
    return listed_words([_readable(one) for one in others]) or "no other effect, in these runs"


def _unseen(found: Diagnosis) -> str:
    return "; ".join(undetectable(found)) or "effects below their detection limits, all of which are under typical sizes"


def _next_run(found: Diagnosis, proposals: Sequence[ProposedRun]) -> str:
    if proposals:
        return f"{proposals[0].sentence()}; then diagnose again with it"
    return "none: nothing is missing" if found.kind == "adequate" else "none: another run would hardly change the verdict"


def incomplete(validated: ValidatedDiagnosis) -> bool:
    """Whether more than the verdict's effect may be missing."""
    return bool(
        validated.diagnosis.verdict
        and reduced_chi_square(validated, validated.diagnosis.ranking[0]) >= VERDICT.incomplete_chi_square
    )
