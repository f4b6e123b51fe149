"""Results in words and tables, for the screen and for pages alike."""

from collections.abc import Mapping, Sequence
from textwrap import wrap
from typing import Any

import numpy as np

from ..report.page import Table
from .add import Added
from .compare import ENOUGH, Comparison
from .diagnose import Diagnosis
from .journey import Journey
from .phases import PHASES
from .residual_force import ResidualForce
from .results import Judged, biases, far_off, full_name, misfit, ranking
from .values import Value, unit_of

SHOWN = 6  # effects in short tables
WIDTH = 100  # of lines on a terminal
NOTHING = 1e-9  # parameters below it are told as zero


def percent(share: float | None) -> str:
    """A share as a percentage of three digits; a dash where there is none."""
    return "–" if share is None or not np.isfinite(share) else f"{100.0 * share:.3g} %"


def number(value: float | None) -> str:
    """A number of three digits; a dash where there is none."""
    return "–" if value is None or not np.isfinite(value) else f"{value:.3g}"


def wrapped(*sentences: str) -> list[str]:
    """Sentences as lines for a terminal."""
    return [line for sentence in sentences for line in wrap(sentence, WIDTH)]


def chance(probability: float) -> str:
    """A probability; none is certain."""
    return "over 0.99" if probability > 0.99 else f"{probability:.2f}" if probability >= 0.01 else "under 0.01"


# -- comparison --------------------------------------------------------------------------------------


def compared(one: Comparison) -> str:
    """One sentence: how far off, and whether that is more than noise."""
    held = f", {percent(one.validate_nrmse)} on the runs held out" if np.isfinite(one.validate_nrmse) else ""
    ratio = one.chi_square
    rest = "noise explains all of it" if ratio < ENOUGH else "more than noise is left to explain"
    return (
        f"The model misses by {percent(one.fit_nrmse)} of what the channels vary on the fit runs{held}; noise alone would leave "
        f"{percent(one.floor('fit'))}. What is left is {number(ratio)} times the noise's mean square: {rest}."
    )


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


# -- diagnosis ---------------------------------------------------------------------------------------


def verdict(judged: Judged) -> list[str]:
    """What is missing, in sentences a newcomer understands."""
    found = judged.diagnosis
    surely = found.probabilities
    ruled_out = [f"Ruled out beforehand: {', '.join(sorted(out))}."] if (out := found.problem.ruled_out) else []
    bent = _bent(found)
    if found.verdict:
        return [_missing(judged), *_twins(found), *bent, *ruled_out]
    if found.kind == "adequate":
        told = "Nothing is missing: with its plant parameters refitted the model is as near as noise allows"
        return [f"{told} (probability {chance(surely['adequate'])}).", *bent, *ruled_out]
    return [
        f"Something is missing, and none of the known effects explains it (probability {chance(surely['unknown'])}).",
        *bent,
        "See what the rest is locked to: that is the clue.",
        *ruled_out,
    ]


def _missing(judged: Judged) -> str:
    found, top = judged.diagnosis, ranking(judged)[0]
    name = full_name(found.ranking[0].hypothesis)
    others = top.get("together_with", {})
    more = f", and {', '.join(others)}," if others else ""
    what = "An instrument is at fault" if found.kind == "instrument" else "Missing"
    left = misfit(judged, found.ranking[0])
    rest = "" if left < 1.5 else f" It leaves {number(left)} times what noise would: perhaps something more is missing."
    return (
        f"{what}: {name}{more} with probability {chance(top['probability'])}. With it the error falls from "
        f"{percent(top['error_before'])} to {percent(top['error_after'])} on the fit runs and from "
        f"{percent(top['validate_error_before'])} to {percent(top['validate_error_after'])} on runs held out; noise alone would "
        f"leave {percent(judged.before.floor('fit'))} and {percent(judged.before.floor('validate'))}.{rest}"
    )


def _bent(found: Diagnosis) -> list[str]:
    """What a fit asks of the plant that no data sheet allows."""
    told = [f"{key} by {change:+.0%}, {abs(off):.0f} times what it usually errs by" for key, change, off in far_off(found)]
    return [f"The fit needs a plant far off what is stated: {'; '.join(told)}."] if told else []


def _twins(found: Diagnosis) -> list[str]:
    twins = sorted({a if b == found.verdict else b for a, b in found.alike if found.verdict in (a, b)})
    likely = [name for name in twins if found.probabilities.get(name, 0.0) > 0.02]
    return [f"These data hardly tell it from {', '.join(likely)}."] if likely else []


def ranking_table(judged: Judged, most: int = 100) -> Table:
    """The ranking: probability, errors and parameters."""
    head = ("effect", "probability", "fit runs", "held out", "left / noise", "parameters")
    rows = [
        (
            named(one), chance(one["probability"]), percent(one["error_after"]), percent(one["validate_error_after"]),
            number(one["misfit_per_datum"]), parameters(one) + (" (estimated)" if one["estimated"] else ""),
        )
        for one in ranking(judged)[:most]
    ]  # fmt: skip
    return Table(
        head, rows, f"Errors with the effect; now {percent(judged.before.fit_nrmse)} and {percent(judged.before.validate_nrmse)}"
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


def least_table(judged: Judged) -> Table:
    """What the data cannot see: sizes below which an effect would go unnoticed."""
    rows = []
    for one in judged.diagnosis.ranking:
        if not one.hypothesis.parts:
            effect = one.hypothesis.effect
            sizes = {key.split(".", 2)[2]: value for key, value in one.least.items() if "phase" not in key}
            told = ", ".join(sized(effect, name, value) for name, value in sizes.items())
            rows.append((effect, told, percent(one.visible)))
    return Table(("effect", "seen from about", "not mistaken for the plant"), sorted(rows))


def force_table(force: ResidualForce, most: int = 100) -> Table:
    """Places of an unknown force: what it explains of the rest there, and its size."""
    rows = [(one.place.name, percent(one.share), one.sized()) for one in force.suspects[:most]]
    return Table(("if it is", "explains of the rest", "rms"), rows, "Judged on data that were left out of each estimate")


def plant_table(found: Diagnosis) -> Table:
    """Plant parameters as the file has them and as fitted, and by how many of their usual deviations they moved."""
    rows = [(key, number(one.before), one.told(), f"{moved:+.1f}") for key, one, moved in biases(found)]
    return Table(("parameter", "file", "fitted", "moved, in usual deviations"), rows)


def value_table(values: Mapping[str, Value]) -> Table:
    """Fitted values with 95 % intervals."""
    rows = [(key, one.told(), f"{one.low:.4g}", f"{one.high:.4g}") for key, one in values.items() if one.deviation > 0.0]
    return Table(("parameter", "fitted", "95 %: from", "to"), rows)


# -- added effects -----------------------------------------------------------------------------------


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


def plain_table(table: Table) -> list[str]:
    """A table as lines of text."""
    cells: Sequence[Sequence[str]] = [list(table.head), *table.rows]
    widths = [max(len(row[k]) for row in cells) for k in range(len(table.head))]
    lines = []
    for row in cells:
        padded = (
            cell.rjust(w) if table.numeric(k) else cell.ljust(w) for k, (cell, w) in enumerate(zip(row, widths, strict=True))
        )
        lines.append("  ".join(padded).rstrip())
    return lines


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


def bought_table(found: Journey) -> Table:
    """Errors after each step of a journey, and each step's share of the fall."""
    shares = [("", ""), *((percent(fit), percent(held)) for _, fit, held in found.bought())]
    rows = [(one.name, percent(one.fit), percent(one.validate), *share) for one, share in zip(found.steps, shares, strict=True)]
    return Table(("step", "fit runs", "held out", "share of the fall", "held out"), rows)
