"""Results of the identification as tables, for terminal and pages."""

from collections.abc import Mapping, Sequence
from typing import Any

from comprope.rope.parameters.parameter_vector import DECLARED

from ...identification.comparison.compare import Comparison
from ...identification.data.trip_phases import PHASES
from ...identification.diagnosis.diagnose import Diagnosis
from ...identification.diagnosis.held_out_validation import ValidatedDiagnosis, parameter_shifts, ranking
from ...identification.estimation.parameter_estimates import Estimate, unit_of
from ...identification.model_updating.backward_elimination import EffectRemoval
from ...identification.model_updating.stepwise_selection import StepwiseSelection
from ...identification.prediction.plant_parameters import CLOCK
from ...identification.residuals.input_estimation import InputEstimation
from ...report.page import Table
from .texts.formatting import ZERO, number, percent, probability

SHOWN = 6  # rows of a table on the terminal


def error_table(one: Comparison) -> Table:
    """NRMSE, RMS error and reduced chi-square by run and channel, and the normalised error by phase of the trip."""
    head = ("run", "channel", "NRMSE", "RMS error", "red. χ²", *(name.replace("_", " ") for name in PHASES))
    rows = []
    for run in one.runs:
        for channel in run.channels:
            rms_error = f"{number(channel.rmse / channel.channel.scale)} {channel.channel.unit}"
            phases = (percent(channel.by_phase.get(name)) for name in PHASES)
            chi_square = number(channel.reduced_chi_square)
            rows.append((f"{run.file} ({run.role})", channel.column, percent(channel.nrmse), rms_error, chi_square, *phases))
    return Table(head, rows)


def shape_table(one: Comparison) -> Table:
    """Magnitude and phase errors after Sprague and Geers, by run and channel."""
    head = ("run", "channel", "magnitude error", "phase error", "combined")
    rows = [
        (run.file, c.column, percent(c.sprague_geers.magnitude), percent(c.sprague_geers.phase), number(c.sprague_geers.combined))
        for run in one.runs
        for c in run.channels
    ]
    return Table(head, rows, "Sprague and Geers metrics; phase error as a share of half a period")


def ranking_table(validated: ValidatedDiagnosis, most: int = 100) -> Table:
    """The ranking of effects: probability, NRMSE with the effect, reduced chi-square, parameters."""
    head = ("effect", "probability", "NRMSE, fit", "NRMSE, validation", "red. χ²", "parameters")
    rows = [
        (
            effect_names(one), probability(one["probability"]), percent(one["error_after"]), percent(one["validate_error_after"]),
            number(one["reduced_chi_square"]), parameters(one) + (" (linearised)" if one["estimated"] else ""),
        )
        for one in ranking(validated)[:most]
    ]  # fmt: skip
    before = f"{percent(validated.before.fit_nrmse)} and {percent(validated.before.validate_nrmse)}"
    return Table(head, rows, f"NRMSE with the effect, plant parameters refitted with it; {before} for the model as given")


def effect_names(entry: Mapping[str, Any]) -> str:
    """The effects of an entry of the ranking."""
    return " + ".join((entry["effect"], *entry.get("together_with", {})))


def parameters(entry: Mapping[str, Any]) -> str:
    """Parameters of an entry of the ranking, with their units."""
    groups = {entry["effect"]: entry["parameters"]} | entry.get("together_with", {})
    return ", ".join(parameter(effect, name, value) for effect, group in groups.items() for name, value in group.items())


def parameter(effect: str, name: str, value: float) -> str:
    """One parameter of an effect with its unit."""
    return f"{name} {value if abs(value) > ZERO else 0.0:.3g}{unit_of(effect, name)}"


def detection_limit_table(validated: ValidatedDiagnosis) -> Table:
    """The size above which each effect would be detected, and the part of its response that plant parameters do not explain."""
    rows = []
    for one in validated.diagnosis.ranking:
        if not one.hypothesis.parts:
            effect = one.hypothesis.effect
            limits = {key.split(".", 2)[2]: value for key, value in one.detection_limits.items() if "phase" not in key}
            text = ", ".join(parameter(effect, name, value) for name, value in limits.items())
            rows.append((effect, text, percent(one.distinct_share)))
    return Table(("effect", "detection limit", "part not explained by plant parameters"), sorted(rows))


def force_table(force: InputEstimation, most: int = 100) -> Table:
    """Locations of an unknown force: the share of the residual that it explains, and its RMS value."""
    rows = [(one.location.name, percent(one.share), one.sized()) for one in force.estimates[:most]]
    head = ("location", "explained share of the residual", "RMS")
    return Table(head, rows, "Cross-validated on data not used for each estimate")


def plant_table(found: Diagnosis) -> Table:
    """Plant parameters in the model file and as fitted, and their deviations from the prior in prior standard deviations."""
    rows = [
        (key, number(one.before), one.formatted(), unit_of_key(key), f"{shift:+.1f}")
        for key, one, shift in parameter_shifts(found)
    ]
    return Table(("parameter", "model file", "fitted", "unit", "deviation from prior, in prior standard deviations"), rows)


def estimate_table(values: Mapping[str, Estimate]) -> Table:
    """Estimates with their 95 % confidence intervals."""
    rows = [
        (key, one.formatted(), f"{one.low:.4g}", f"{one.high:.4g}", unit_of_key(key))
        for key, one in values.items()
        if one.standard_error > 0.0
    ]
    return Table(("parameter", "estimate ± standard error", "95 %: from", "to", "unit"), rows)


def unit_of_key(key: str) -> str:
    """The SI unit of a model parameter, empty for a pure number."""
    unit = "s" if key == CLOCK else DECLARED[key].unit if key in DECLARED else ""
    return "" if unit == "1" else unit.replace(".", "·")


def stage_table(stages: Mapping[str, Comparison]) -> Table:
    """NRMSE of each run at each stage."""
    first = next(iter(stages.values()))
    rows = [
        (f"{run.file} ({run.role})", *(percent(one.runs[k].nrmse) for one in stages.values())) for k, run in enumerate(first.runs)
    ]
    rows += [
        ("all fit runs", *(percent(one.fit_nrmse) for one in stages.values())),
        ("all validation runs", *(percent(one.validate_nrmse) for one in stages.values())),
    ]
    return Table(("NRMSE", *stages), rows)


def step_table(found: StepwiseSelection) -> Table:
    """NRMSE after each step of a stepwise selection, and the share of the step in the whole reduction."""
    head = ("step", "NRMSE, fit", "NRMSE, validation", "share of reduction, fit", "validation")
    shares = [("", ""), *((percent(fit), percent(held)) for _, fit, held in found.error_reductions())]
    rows = [
        (one.name, percent(one.fit_nrmse), percent(one.validate_nrmse), *share)
        for one, share in zip(found.steps, shares, strict=True)
    ]
    return Table(head, rows)


def removal_table(removals: Sequence[EffectRemoval]) -> Table:
    """Reduced chi-square of the final model refitted without each of its effects."""
    rows = [(one.effect, number(one.reduced_chi_square), "no" if one.removable else "yes") for one in removals]
    return Table(("without", "red. χ²", "needed"), rows, "Backward elimination: the final model refitted without each effect")
