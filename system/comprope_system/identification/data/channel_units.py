"""Lasers whose unit is another than those of the others: both their noise and their motion differ by a power of ten."""

from collections.abc import Iterator, Mapping

import numpy as np

from ...measurements.units import UNITS
from ..settings import PLAUSIBILITY
from .channel_noise import spread_of_steps
from .runs import Channel, Run


def other_units(run: Run, channels: Mapping[str, Channel]) -> Iterator[str]:
    """Sentences about lateral channels of a run, each with the unit with which it would agree with the others."""
    sizes = {column: found for column, one in channels.items() if (found := _sizes(run, one)) is not None}
    for column, own in sizes.items():
        # The median is that of the others, whichever of three or more is off; of two, each is compared with the other.
        among = [size for name, size in sizes.items() if len(sizes) >= PLAUSIBILITY.enough_lasers or name != column]
        if not among:
            return
        noise, motion = np.array(own) / np.median(among, axis=0)
        if _within(noise, PLAUSIBILITY.alike_noise) or _within(motion, 0.5 * PLAUSIBILITY.alike_motion):
            continue
        channel = channels[column]
        for unit, scale in UNITS[channel.quantity].items():
            factor = scale / channel.scale  # by which noise and motion are larger in that unit
            if _within(factor * noise, PLAUSIBILITY.alike_noise) and _within(factor * motion, PLAUSIBILITY.alike_motion):
                size = f"noise and motion are about {1.0 / factor:.3g} times those of the other lasers"
                yield f'{column}: {size}: if it is in {unit}, write unit = "{unit}" for this channel'
                break


def _sizes(run: Run, channel: Channel) -> tuple[float, float] | None:
    """Noise at rest and largest motion [m] of a lateral channel; None of others, and without either."""
    if channel.quantity != "lateral_displacement":
        return None
    value = run.values[channel.column]
    rest = value[run.rest & np.isfinite(value)]
    if len(rest) < PLAUSIBILITY.min_samples:
        return None
    noise, distance = spread_of_steps(rest), np.abs(value - np.nanmedian(value))
    motion = float(np.nanpercentile(distance, PLAUSIBILITY.motion_percentile))
    return (noise, motion) if noise > 0.0 and motion > 0.0 else None


def _within(ratio: float, factor: float) -> bool:
    return 1.0 / factor <= ratio <= factor
