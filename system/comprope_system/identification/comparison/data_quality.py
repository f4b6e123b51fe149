"""Data-quality checks of a campaign: each rule compares measurements with predictions and yields messages.

Gross errors of instruments (sign, unit, clock) are apparent in a comparison even with a poor model.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial

import numpy as np

from ...measurements.units import UNITS
from ..data.campaign import Campaign
from ..data.outliers import outliers
from ..data.plausibility import remarks_on_record
from ..data.runs import Channel
from ..data.trip_phases import phases
from ..prediction.parameter_point import Predictions
from ..settings import DATA_QUALITY, PAIRED_RECORDS
from .clock_offset import clock
from .paired_records import Record, by_column, records_of


def remarks(
    campaign: Campaign,
    predictions: Predictions,
    plain: Predictions | None = None,
    gains: Mapping[str, float] | None = None,
) -> list[str]:
    """Messages about the data, the most serious first; empty if there are none.

    `plain` are predictions without fitted instrument effects; by default `predictions`. `gains` are those of channels, by
    column, that a fit has found; the gains of others are those of the records.
    """
    plain_rules: tuple[Rule, ...] = (sign, partial(unit, fitted=gains or {}), drift)
    records = list(records_of(campaign, predictions))
    untouched = list(records_of(campaign, plain or predictions))
    of_channels = [sentence for rule in plain_rules for group in by_column(untouched) for sentence in rule(group)]
    of_channels += [sentence for rule in CHANNEL_RULES for group in by_column(records) for sentence in rule(group)]
    of_runs = [sentence for run in campaign.runs for sentence in remarks_on_record(run)]
    return [*campaign.notes, *of_channels, *clock(records), *of_runs, *(note for run in campaign.runs for note in run.notes)]


# -- one channel over all runs -----------------------------------------------------------------------


def sign(group: Sequence[Record]) -> Iterator[str]:
    """A channel that is anticorrelated with the model in every run."""
    seen = [one.gain() for one in group if np.isfinite(one.gain()[0])]
    if seen and max(c for _, c in seen) < 0.0 and min(c for _, c in seen) < -DATA_QUALITY.min_correlation:
        name = group[0].channel.column
        gain = float(np.median([g for g, _ in seen]))
        yield f"{name}: anticorrelated with the model in every run (gain {gain:.2f}): its sign is probably wrong"


def unit(group: Sequence[Record], fitted: Mapping[str, float]) -> Iterator[str]:
    """A channel whose amplitude indicates another unit or another power of ten."""
    channel = group[0].channel
    gain = fitted.get(channel.column, _common_gain(group))
    if gain is not None and (sentence := unit_by_gain(channel, gain)):
        yield sentence


def _common_gain(group: Sequence[Record]) -> float | None:
    """Size of the gain in which the runs agree, if they do."""
    seen = [abs(one.gain()[0]) for one in group if abs(one.gain()[1]) > DATA_QUALITY.min_correlation]
    return float(np.median(seen)) if seen and max(seen) <= 1.5 * min(seen) else None


def unit_by_gain(channel: Channel, gain: float) -> str | None:
    """What a channel's gain against the model tells of its unit, if anything."""
    scales, size = UNITS[channel.quantity], f"{channel.column}: {abs(gain):.3g} times the amplitude of the model"
    fitting = [name for name, scale in scales.items() if scale != channel.scale and _near(abs(gain) * scale / channel.scale)]
    if fitting and not _near(abs(gain)):
        return f'{size}; its unit is probably "{fitting[0]}", not "{channel.unit}"'
    power = float(np.log10(abs(gain))) if gain else 0.0
    if abs(power) > 0.8 and abs(power - round(power)) < 0.15:
        return f"{size}, near a power of ten: check its unit"
    return None


def _near(gain: float) -> bool:
    return 0.7 < gain < 1.4


def noise(group: Sequence[Record]) -> Iterator[str]:
    """A stated noise that differs from the one estimated from samples at rest."""
    channel = group[0].channel
    taken = [one.noise for one in group if channel.noise and one.noise != channel.noise * channel.scale]
    if channel.noise and taken:
        seen = float(np.median(taken)) / channel.scale
        stated = f"{channel.column}: noise = {channel.noise:g} {channel.unit} is stated"
        yield f"{stated}, but at rest its standard deviation is {seen:.2g} {channel.unit}; the latter is used"


def drift(group: Sequence[Record]) -> Iterator[str]:
    """A residual with the same slope before and after the trip."""
    slopes = [pooled_slope(group, phase) for phase in ("rest", "after_stop")]
    (before, d_before), (after, d_after) = slopes
    surely = min(abs(before) / d_before, abs(after) / d_after)
    if surely > 4.0 and before * after > 0.0 and 0.5 < before / after < 2.0:
        channel = group[0].channel
        rate = 60.0 * 0.5 * (before + after) / channel.scale
        yield f"{channel.column}: drifts by about {rate:.2g} {channel.unit} per minute, before and after the trips"


def pooled_slope(group: Sequence[Record], phase: str) -> tuple[float, float]:
    """Mean slope [SI/s] of the residual in a phase over all runs, and its standard error from run scatter and noise."""
    found = []
    for one in group:
        mask = phases(one.run.trip, one.run.time)[phase] & one.both
        mask[mask] = ~outliers(one.measured[mask], one.noise) if mask.sum() >= PAIRED_RECORDS.min_samples else False
        if mask.sum() >= PAIRED_RECORDS.min_samples:
            t = one.run.time[mask] - one.run.time[mask].mean()
            x = one.measured[mask] - one.predicted[mask]
            found.append((float(t @ x / (t @ t)), one.noise / float(np.sqrt(t @ t))))
    if not found:
        return 0.0, float("inf")
    slopes, deviations = np.array(found).T
    scatter = float(np.std(slopes)) / max(len(slopes) - 1, 1) ** 0.5
    return float(slopes.mean()), max(scatter, float(np.sqrt((deviations**2).sum())) / len(slopes))


def far_out(group: Sequence[Record]) -> Iterator[str]:
    """Outliers: samples far from their neighbours."""
    counts = {}
    for one in group:
        known = one.measured[np.isfinite(one.measured)]
        if len(known) >= PAIRED_RECORDS.min_samples and (count := int(outliers(known, one.noise).sum())):
            counts[one.run.file] = count
    if counts:
        numbers = ", ".join(f"{count} in {file}" for file, count in counts.items())
        yield f"{group[0].channel.column}: outliers ({numbers}); they are excluded from fits"


def gaps(group: Sequence[Record]) -> Iterator[str]:
    """Samples missing while the rope is in view of the sensor, or present after its end has passed the sensor."""
    missing, extra = {}, {}
    for one in group:
        if not np.isfinite(one.measured).any():
            continue  # left out of the run, which its notes say
        sampled = one.run.sampled.get(one.channel.column, np.ones(len(one.measured), bool))
        holes, seen = np.isnan(one.measured) & sampled, np.isfinite(one.predicted) & sampled
        gone = ~seen & sampled
        if (share := float(np.mean(holes[seen]))) > 0.002 if seen.any() else False:
            missing[one.run.file] = share
        if (share := float(np.mean(~holes[gone]))) > 0.5 if gone.sum() >= PAIRED_RECORDS.min_samples else False:
            extra[one.run.file] = share
    name = group[0].channel.column
    if missing:
        shares = ", ".join(f"{100 * share:.2g} % in {file}" for file, share in missing.items())
        yield f"{name}: samples missing while the rope is in view of the sensor: {shares}"
    if extra:
        yield f"{name}: values although the rope's end has passed the sensor, in {', '.join(extra)}; they are excluded"


def unseen_rest(group: Sequence[Record]) -> Iterator[str]:
    """A channel with reference "rest" that has no samples at rest."""
    used = [one for one in group if np.isfinite(one.measured).any()]
    runs = [one.run.file for one in used if not np.isfinite(one.measured[one.run.rest]).any()]
    if group[0].channel.reference == "rest" and runs:
        missing = f'{group[0].channel.column}: reference = "rest", but no samples before the trip in {", ".join(runs)}'
        yield f"{missing}; these values are used as absolute ones"


Rule = Callable[[Sequence[Record]], Iterator[str]]
CHANNEL_RULES: tuple[Rule, ...] = (noise, far_out, gaps, unseen_rest)
