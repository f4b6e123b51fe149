"""Results in words and tables, for the screen and for pages alike."""

from collections.abc import Mapping
from typing import Any

from ...report.page import Table
from ..comparison.compare import Comparison
from ..data.trip_phases import PHASES
from ..diagnosis.diagnose import Diagnosis
from ..diagnosis.held_out_validation import ValidatedDiagnosis, parameter_shifts, ranking
from ..estimation.parameter_estimates import Estimate, unit_of
from ..model_updating.stepwise_selection import Journey
from ..residuals.input_estimation import InputEstimation
from .formatting import NOTHING, chance, number, percent

SHOWN = 6  # effects in short tables


def error_table(one: Comparison) -> Table:
    """Errors by run, channel and phase of the trip."""
    head = ("run", "channel", "error", "rms", "χ² / sample", *(name.replace("_", " ") for name in PHASES))
    rows = []
    for run in one.runs:
        for channel in run.channels:
            size = f"{number(channel.rmse / channel.channel.scale)} {channel.channel.unit}"
            phases = (percent(channel.by_phase.get(name)) for name in PHASES)
            rows.append(
                (f"{run.file} ({run.role})", channel.column, percent(channel.nrmse), size, number(channel.chi_square), *phases)
            )
    return Table(head, rows)


def shape_table(one: Comparison) -> Table:
    """Sprague and Geers' errors of size and phase, by run and channel."""
    head = ("run", "channel", "too large by", "out of phase by", "combined")
    rows = [
        (run.file, c.column, percent(c.sprague_geers.magnitude), percent(c.sprague_geers.phase), number(c.sprague_geers.combined))
        for run in one.runs
        for c in run.channels
    ]
    return Table(head, rows, "Sprague and Geers; phase in half periods")


def ranking_table(validated: ValidatedDiagnosis, most: int = 100) -> Table:
    """The ranking: probability, errors and parameters."""
    head = ("effect", "probability", "fit runs", "held out", "left / noise", "parameters")
    rows = [
        (
            named(one), chance(one["probability"]), percent(one["error_after"]), percent(one["validate_error_after"]),
            number(one["misfit_per_datum"]), parameters(one) + (" (estimated)" if one["estimated"] else ""),
        )
        for one in ranking(validated)[:most]
    ]  # fmt: skip
    return Table(
        head,
        rows,
        f"Errors with the effect; now {percent(validated.before.fit_nrmse)} and {percent(validated.before.validate_nrmse)}",
    )


def named(entry: Mapping[str, Any]) -> str:
    """The effects of an entry of the ranking."""
    return " + ".join((entry["effect"], *entry.get("together_with", {})))


def parameters(entry: Mapping[str, Any]) -> str:
    """Parameters of an entry of the ranking, with their units."""
    groups = {entry["effect"]: entry["parameters"]} | entry.get("together_with", {})
    return ", ".join(sized(effect, name, value) for effect, group in groups.items() for name, value in group.items())


def sized(effect: str, name: str, value: float) -> str:
    """One parameter of an effect with its unit."""
    return f"{name} {value if abs(value) > NOTHING else 0.0:.3g}{unit_of(effect, name)}"


def least_table(validated: ValidatedDiagnosis) -> Table:
    """What the data cannot see: sizes below which an effect would go unnoticed."""
    rows = []
    for one in validated.diagnosis.ranking:
        if not one.hypothesis.parts:
            effect = one.hypothesis.effect
            sizes = {key.split(".", 2)[2]: value for key, value in one.detection_limits.items() if "phase" not in key}
            told = ", ".join(sized(effect, name, value) for name, value in sizes.items())
            rows.append((effect, told, percent(one.distinct_share)))
    return Table(("effect", "seen from about", "not mistaken for the plant"), sorted(rows))


def force_table(force: InputEstimation, most: int = 100) -> Table:
    """Places of an unknown force: what it explains of the rest there, and its size."""
    rows = [(one.location.name, percent(one.share), one.sized()) for one in force.estimates[:most]]
    return Table(("if it is", "explains of the rest", "rms"), rows, "Judged on data that were left out of each estimate")


def plant_table(found: Diagnosis) -> Table:
    """Plant parameters as the file has them and as fitted, and by how many of their usual deviations they moved."""
    rows = [(key, number(one.before), one.formatted(), f"{moved:+.1f}") for key, one, moved in parameter_shifts(found)]
    return Table(("parameter", "file", "fitted", "moved, in usual deviations"), rows)


def value_table(values: Mapping[str, Estimate]) -> Table:
    """Fitted values with 95 % intervals."""
    rows = [
        (key, one.formatted(), f"{one.low:.4g}", f"{one.high:.4g}") for key, one in values.items() if one.standard_error > 0.0
    ]
    return Table(("parameter", "fitted", "95 %: from", "to"), rows)


def fall_table(stages: Mapping[str, Comparison]) -> Table:
    """Errors of each run at each stage."""
    first = next(iter(stages.values()))
    rows = [
        (f"{run.file} ({run.role})", *(percent(one.runs[k].nrmse) for one in stages.values())) for k, run in enumerate(first.runs)
    ]
    rows += [
        ("all fit runs", *(percent(one.fit_nrmse) for one in stages.values())),
        ("all runs held out", *(percent(one.validate_nrmse) for one in stages.values())),
    ]
    return Table(("run", *stages), rows)


def bought_table(found: Journey) -> Table:
    """Errors after each step of a journey, and each step's share of the fall."""
    shares = [("", ""), *((percent(fit), percent(held)) for _, fit, held in found.bought())]
    rows = [(one.name, percent(one.fit), percent(one.validate), *share) for one, share in zip(found.steps, shares, strict=True)]
    return Table(("step", "fit runs", "held out", "share of the fall", "held out"), rows)
