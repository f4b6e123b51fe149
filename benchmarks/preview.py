"""Error of previews of effects: interpolated between replays at nodes, against true replays at random settings.

    python benchmarks/preview.py CAMPAIGN [--settings 50] [--effects air_drag bearing_friction] [--pairs] [--size 1] [--seed 1]

Each effect that a diagnosis knows, and each fault of an instrument in the first channel that has it, has its typical size (times
--size) at the centre of its nodes and is moved from nothing to half as much again. Printed for each: the settings, the difference
between the NRMSE that the preview shows and that of a replay (median, 95 % and largest, in points), the RMS difference of the
curves over the standard deviation of the measured channel (median and 95 %), processor seconds to make the preview of a run, and
what a straight line from the centre would show (95 % of the error of NRMSE in points). The first fit run is used.
"""

import argparse
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import combinations

import numpy as np

from comprope.errors import SimulationError
from comprope.rope.effects import INSTRUMENT, REGISTRY, names_of
from comprope_system.identification.comparison.nrmse import nrmse
from comprope_system.identification.data.campaign import Campaign, load_campaign
from comprope_system.identification.prediction.effect_hypotheses import (
    Hypothesis,
    combine,
    heights_tried,
    hypotheses_of_effect,
    instrument_hypotheses,
)  # fmt: skip
from comprope_system.identification.prediction.parameter_point import ParameterPoint, predict, run_at_point
from comprope_system.identification.prediction.replay import relative_to_rest
from comprope_system.identification.preview.effect_preview import EffectPreview, preview_effect
from comprope_system.identification.preview.sliders import moved, sliders_of
from comprope_system.identification.settings import REPLAY

PAIRED = ("air_drag", "bearing_friction", "sheave_eccentricity", "guide_friction")


def hypothesis_of(name: str, campaign: Campaign) -> Hypothesis:
    """The first variant of an effect, or of a fault of an instrument."""
    if name in REGISTRY:
        return hypotheses_of_effect(REGISTRY[name], (), heights_tried(campaign.model))[0]
    return next(one for one in instrument_hypotheses(campaign.channels) if one.effect == name)


def straight_line(preview: EffectPreview, values: tuple[float, ...]) -> float:
    """The NRMSE of predictions that are linearised at the centre."""
    steps = np.subtract(values, preview.lines.centre)
    weights = np.zeros(len(next(iter(preview.data.values()))))
    weights[0], weights[1 : 1 + len(steps)] = 1.0, steps
    linear = {place: weights @ data for place, data in preview.data.items()}
    return nrmse(preview.campaign, preview.campaign.runs, linear)


def shape_error(preview: EffectPreview, shown: dict, true: dict) -> float:
    """The largest RMS difference of a curve, over the standard deviation of the measured channel."""
    (run,) = preview.campaign.runs
    measured = relative_to_rest(run.values, run, preview.campaign.channels)
    rows = [(shown[place] - true[place], np.nanstd(measured[place[1]])) for place in shown]
    return max(float(np.sqrt(np.nanmean(row**2)) / size) for row, size in rows if size > 0.0)


def measured_row(campaign: Campaign, hypothesis: Hypothesis, size: float, settings: int, random: np.random.Generator) -> str:
    """One row of the table, of an effect of `size` times its typical one."""
    coefficients = [size] * len(hypothesis.directions)
    point = ParameterPoint(effects=hypothesis.parameters(coefficients))
    sliders = sliders_of(hypothesis.split_coefficients(coefficients))
    (run,) = campaign.runs
    with ThreadPoolExecutor(1) as executor:
        begin = time.process_time()
        preview = preview_effect(hypothesis.effect, campaign, point, sliders, executor)
        made = time.process_time() - begin
    errors, shapes, straight = [], [], []
    for _ in range(settings):
        values = tuple(float(random.uniform(min(one.nodes), max(one.nodes))) for one in sliders)
        there = run_at_point(campaign.model, run, moved(point, sliders, values))
        found = predict(campaign.model, there, campaign.channels, REPLAY.time_step)
        true = {(run.file, column): value for column, value in found.items()}
        truth = nrmse(campaign, campaign.runs, true)
        errors.append(100.0 * abs(preview.nrmse(values, "fit") - truth))
        straight.append(100.0 * abs(straight_line(preview, values) - truth))
        shapes.append(100.0 * shape_error(preview, preview.predictions(values), true))
    moving = ", ".join(f"{one.key.removeprefix('effects.')} {min(one.nodes):g} to {max(one.nodes):g}" for one in sliders)
    shown = f"{np.median(errors):.2g} | {np.percentile(errors, 95):.2g} | {max(errors):.2g}"
    curves = f"{np.median(shapes):.2g} % | {np.percentile(shapes, 95):.2g} %"
    return f"| {moving} | {shown} | {curves} | {made:.1f} | {np.percentile(straight, 95):.2g} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("campaign")
    parser.add_argument("--settings", type=int, default=50)
    parser.add_argument("--effects", nargs="+")
    parser.add_argument("--pairs", action="store_true")
    parser.add_argument("--size", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    whole = load_campaign(given.campaign)
    campaign = replace(whole, runs=whole.of_role("fit")[:1])
    known = [name for name in names_of(whole.model) if REGISTRY[name].hypothesis]
    names = given.effects or (list(PAIRED) if given.pairs else [*known, *INSTRUMENT])
    tried = [hypothesis_of(name, whole) for name in names]
    if given.pairs:
        tried = [combine(a, b) for a, b in combinations(tried, 2)]
    print("| moved | NRMSE off by, median | 95 % | largest | curves off by, median | 95 % | CPU s a run | straight line, 95 % |")
    print("|---|---|---|---|---|---|---|---|")
    for one in tried:
        try:
            print(measured_row(campaign, one, given.size, given.settings, np.random.default_rng(given.seed)), flush=True)
        except SimulationError as error:
            print(f"| {one.effect}: {error} | | | | | | | |", flush=True)


if __name__ == "__main__":
    main()
