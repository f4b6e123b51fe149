"""Validation of a diagnosis on the runs held out, and its result as JSON."""

from concurrent.futures import Executor
from dataclasses import dataclass
from math import expm1
from typing import Any

from ...report.json_output import plain
from ..comparison.compare import Comparison, compare
from ..comparison.data_quality import remarks
from ..comparison.nrmse import nrmse
from ..estimation.gauss_newton import FitResult
from ..estimation.parameter_estimates import Estimate, keys_set_by_runs, plant_estimates, standard_error_scale
from ..prediction.effect_hypotheses import Hypothesis
from ..prediction.model_effects import effect_name, short_names
from ..prediction.parameter_point import ParameterPoint
from ..settings import VERDICT
from .diagnose import Candidate, Diagnosis

SENSOR_GAIN = "sensor_gain"


@dataclass(frozen=True)
class ValidatedDiagnosis:
    """Diagnosis with comparisons on all runs: of the model file, of the fitted plant alone, of each candidate fit by number."""

    diagnosis: Diagnosis
    before: Comparison
    refitted: Comparison
    candidates: dict[int, Comparison]
    remarks: tuple[str, ...]

    @property
    def best(self) -> Comparison:
        """Comparison of the verdict's fit, or of the fitted plant alone without a verdict."""
        return self.candidates.get(0, self.refitted) if self.diagnosis.verdict else self.refitted


def validate(diagnosis: Diagnosis, executor: Executor, base: ParameterPoint | None = None) -> ValidatedDiagnosis:
    """Comparisons of a diagnosis's fits on all runs, those held out included."""
    campaign = diagnosis.campaign
    before = compare(campaign, executor, base, diagnosis.nominal)
    fits = {k: one.fitted for k, one in enumerate(diagnosis.ranking) if one.refined}
    refitted = compare(campaign, executor, diagnosis.baseline.point, diagnosis.baseline.predictions)
    candidates = {k: compare(campaign, executor, one.point, one.predictions) for k, one in fits.items()}
    found = ValidatedDiagnosis(diagnosis, before, refitted, candidates, ())
    told = remarks(campaign, found.best.predictions, before.predictions, fitted_gains(diagnosis))
    return ValidatedDiagnosis(diagnosis, before, refitted, candidates, tuple(told))


def fitted_gains(diagnosis: Diagnosis) -> dict[str, float]:
    """Gains of channels, by column, that the verdict has fitted."""
    if diagnosis.verdict != SENSOR_GAIN:
        return {}
    best = diagnosis.ranking[0]
    parts = ((key.split(".", 2), gain) for key, gain in best.hypothesis.parameters(best.fitted.effect_coefficients).items())
    return {column: gain for (_, effect, column), gain in parts if effect == SENSOR_GAIN}


def to_json(validated: ValidatedDiagnosis) -> dict[str, Any]:
    """Verdict, ranking and what qualifies them; `misfit_per_datum` is an older name of `reduced_chi_square`."""
    diagnosis, count = validated.diagnosis, max(len(validated.diagnosis.problem.data), 1)
    nominal = diagnosis.problem.residual(diagnosis.nominal)
    reduced = {"as_it_stands": float(nominal @ nominal) / count, "plant_refitted": diagnosis.baseline.chi_square / count}
    found = {
        "campaign": diagnosis.campaign.name,
        "verdict": diagnosis.verdict,
        "verdict_kind": diagnosis.kind,
        "ranking": ranking(validated),
        "indistinguishable": [list(pair) for pair in diagnosis.indistinguishable],
        "probabilities": diagnosis.probabilities,
        "reduced_chi_square": reduced,
        "misfit_per_datum": reduced,
        "errors": {
            name: {"fit": one.fit_nrmse, "validate": one.validate_nrmse}
            for name, one in (("as_it_stands", validated.before), ("plant_refitted", validated.refitted))
        },
        "plant": {key: one.to_json() for key, one in plant(diagnosis).items()},
        "plant_priors": plant_priors(diagnosis),
        "ruled_out": sorted(diagnosis.problem.ruled_out),
        "data": count,
        "remarks": list(validated.remarks),
    }  # fmt: skip
    return plain(found)


def ranking(validated: ValidatedDiagnosis) -> list[dict[str, Any]]:
    """One entry for each effect, most probable first; a combination of effects has the name of its first."""
    found: dict[str, dict[str, Any]] = {}
    for k, one in enumerate(validated.diagnosis.ranking):
        entry = _entry(validated, k, one)
        if entry["effect"] in found:
            found[entry["effect"]]["probability"] += entry["probability"]
        else:
            found[entry["effect"]] = entry
    return sorted(found.values(), key=lambda entry: -entry["probability"])


def _entry(validated: ValidatedDiagnosis, k: int, one: Candidate) -> dict[str, Any]:
    before = validated.before
    after, held = errors_after(validated, k, one)
    parts = effects_of(one.hypothesis)
    values = one.hypothesis.parameters(one.fitted.effect_coefficients)
    entry = {
        "effect": parts[0], "probability": one.probability, "error_before": before.fit_nrmse, "error_after": after,
        "validate_error_before": before.validate_nrmse, "validate_error_after": held,
        "parameters": short_names(parts[0], values), "estimated": not one.refined,
        "reduced_chi_square": reduced_chi_square(validated, one), "misfit_per_datum": reduced_chi_square(validated, one),
        "visible_share": one.distinct_share, "least_detectable": short_names(parts[0], one.detection_limits),
    }  # fmt: skip
    # Besides combined effects there are parameters that an effect requires: airflow exerts no force without drag.
    others = {name: short_names(name, values) for name in {key.split(".")[1] for key in values} - {parts[0]}}
    with_it = {name: own for name, own in others.items() if name in parts}
    brought = {name: own for name, own in others.items() if name not in parts}
    return entry | ({"together_with": with_it} if with_it else {}) | ({"brings": brought} if brought else {})


def reduced_chi_square(validated: ValidatedDiagnosis, one: Candidate) -> float:
    """Chi-square per datum with an effect: near 1, noise alone is left."""
    return one.fitted.chi_square / max(len(validated.diagnosis.problem.data), 1)


def effects_of(hypothesis: Hypothesis) -> list[str]:
    """Names of the effects in a hypothesis; of a combination the first explains most."""
    return [part.effect for part in (hypothesis.parts or (hypothesis,))]


def errors_after(validated: ValidatedDiagnosis, k: int, one: Candidate) -> tuple[float, float]:
    """Errors (NRMSE) with an effect on fit and validate runs; if it was only screened, estimated from its chi-square."""
    if k in validated.candidates:
        return nrmse_of_fit(validated, k), validated.candidates[k].validate_nrmse
    share = (one.fitted.chi_square / max(validated.diagnosis.baseline.chi_square, 1e-300)) ** 0.5
    return share * validated.refitted.fit_nrmse, share * validated.refitted.validate_nrmse


def nrmse_of_fit(validated: ValidatedDiagnosis, k: int) -> float:
    """Error (NRMSE) of a candidate fit on the fit runs."""
    campaign = validated.diagnosis.campaign
    return nrmse(campaign, campaign.of_role("fit"), validated.candidates[k].predictions)


def plant(diagnosis: Diagnosis) -> dict[str, Estimate]:
    """Estimates of the plant's parameters in the verdict's fit, or in that of the plant alone."""
    fitted = _best(diagnosis)
    return plant_estimates(diagnosis.campaign, fitted, standard_error_scale(fitted, len(diagnosis.problem.data)))


def implausible_parameters(diagnosis: Diagnosis) -> list[tuple[str, float, float]]:
    """Plant parameters too far from their prior: key, relative change, and deviation in prior standard deviations."""
    fitted = _best(diagnosis)
    moved = [(one, float(c), float(c) / one.prior) for one, c in zip(diagnosis.problem.plant, fitted.coefficients, strict=False)]
    return [(one.name, expm1(c), off) for one, c, off in moved if one.relative and abs(off) > VERDICT.implausible_deviation]


def _best(diagnosis: Diagnosis) -> FitResult:
    """Fit of the verdict's effect, or of the plant alone."""
    return diagnosis.ranking[0].fitted if diagnosis.verdict and diagnosis.ranking[0].refined else diagnosis.baseline


def plant_priors(diagnosis: Diagnosis) -> dict[str, dict[str, Any]]:
    """For each plant parameter the standard deviation of its prior, and how far the fit moved it in standard deviations."""
    fitted, problem = _best(diagnosis), diagnosis.problem
    return {
        one.name: {
            "standard_deviation": one.prior, "relative": one.relative, "fixed": one.name in problem.held, "origin": one.origin,
            "moved": 0.0 if one.name in problem.held else float(c) / one.prior,
        }
        for one, c in zip(problem.plant, fitted.coefficients, strict=False)
    }  # fmt: skip


def parameter_shifts(diagnosis: Diagnosis) -> list[tuple[str, Estimate, float]]:
    """Plant parameters: key, estimate, and deviation in prior standard deviations, largest deviation first."""
    fitted = _best(diagnosis)
    values = plant(diagnosis)
    moved = [
        (one.name, values[one.name], float(c) / one.prior)
        for one, c in zip(diagnosis.problem.plant, fitted.coefficients, strict=False)
    ]
    replaced = keys_set_by_runs(diagnosis.campaign)
    return sorted((one for one in moved if one[0] not in replaced), key=lambda one: -abs(one[2]))


def full_name(hypothesis: Hypothesis) -> str:
    """Name of an effect as `comprope add` takes it; of an instrument's fault with its channel."""
    return effect_name((hypothesis.parts or (hypothesis,))[0])
