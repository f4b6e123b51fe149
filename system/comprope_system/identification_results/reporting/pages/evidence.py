"""Where a missing effect shows: channels and phases of the trip whose error it takes away."""

import itertools

import numpy as np

from ....identification.comparison.compare import Comparison
from ....identification.data.trip_phases import PHASES
from ....report.heat_map import Target
from ..run_curves import channels_shown
from ..texts.formatting import percent

SHOWN = 3  # channels and phases that are named
LEAST = 0.5  # share of the error that must be gone for it to be named


def evidence(without: Comparison, with_it: Comparison, curves: str) -> list[tuple[str, Target]]:
    """Sentences with the panels of the figure `curves` to which they lead, the largest fall of the NRMSE first.

    `without` is the model with refitted plant parameters, so that what they explain is no evidence. Of a channel in a phase of
    the trip only the run in which it shows most is named.
    """
    found: dict[tuple[str, str], tuple[float, str, Target]] = {}
    for k, (before, after) in enumerate(zip(without.runs, with_it.runs, strict=True)):
        shown = channels_shown(after)
        for (panel, j), phase in itertools.product(enumerate(shown), PHASES):
            a, b = (one.channels[j].by_phase.get(phase, np.nan) for one in (before, after))
            fall, column, span = a**2 - b**2, after.channels[j].column, phase.replace("_", " ")
            if not b <= (1.0 - LEAST) * a or fall <= found.get((column, phase), (0.0,))[0]:
                continue
            during = f"{column} in {after.file}, {span}: NRMSE {percent(a)} without it, {percent(b)} with it"
            found[column, phase] = fall, during, Target(curves, k, panel, span)
    best = sorted(found.values(), key=lambda one: -one[0])[:SHOWN]
    return [(text, target) for _, text, target in best]
