"""Settings that a slider was moved to: simulated truly, and as the start of a fit."""

import pickle
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from comprope.errors import InputError

from ..identification.comparison.compare import Comparison
from ..identification.comparison.compare import compare as compare_at
from ..identification.prediction.parameter_point import ParameterPoint
from ..identification.preview.effect_preview import EffectPreview
from ..identification.preview.sliders import moved
from ..identification_results.reporting.pages.comparison import worst_run
from ..identification_results.reporting.pages.preview import preview_block
from ..parallel.executors import threads
from ..report.curves import decode

PREVIEWS = "previews.pickle"


def replay(results: Path, source: str, effect: str, values: list[float]) -> dict[str, Any]:
    """A true replay of an effect that the page of result `source` previews, at values in the units of that page.

    NRMSE by role, and curves at the drawn places.
    """
    preview, point, places = _setting(results, source, effect, values)
    campaign = preview.campaign
    with threads() as workers:
        found = compare_at(campaign, workers, point)
    times = {run.file: run.time for run in campaign.runs}
    curves = {
        file: {
            column: _drawn(times[file], found.predictions[file, column] / campaign.channels[column].scale, place)
            for column, place in columns.items()
        }
        for file, columns in places.items()
    }
    return {"errors": {"fit": _or_none(found.fit_nrmse), "validate": _or_none(found.validate_nrmse)}, "curves": curves}


def start_of_fit(results: Path, effect: str, values: list[float]) -> dict[str, Any]:
    """Values by model key of an effect that the page of the diagnosis previews, at values in the units of that page."""
    _, point, _ = _setting(results, "diagnose", effect, values)
    prefix = f"effects.{effect}" if "." in effect else f"effects.{effect}."
    start = {key: value for key, value in point.effects.items() if key.startswith(prefix)}
    if not start:
        raise InputError(f"{effect}: a fit begins at the values of one effect; add one after the other")
    return start


def keep_previews(folder: Path, previews: Sequence[EffectPreview], given: Comparison, fitted: bool) -> None:
    """Keep what a replay needs to know of the previews of a page."""
    if not previews:
        return
    shown = preview_block(previews, given, worst_run(given), fitted=fitted)
    places = {
        group["name"]: {panel["name"]: decode(panel["place"]) for panel in group["panels"]}
        for group in shown.curves.curve_data["groups"]
    }
    factors = {
        one.name: [
            part.nodes[part.centre] / slider.value if slider.value else part.nodes[-1] / slider.nodes[-1]
            for part, slider in zip(block.sliders, one.sliders, strict=True)
        ]
        for one, block in zip(previews, shown.effects, strict=True)
    }
    (folder / PREVIEWS).write_bytes(pickle.dumps({"previews": tuple(previews), "places": places, "factors": factors}))


def _setting(
    results: Path, source: str, effect: str, values: list[float]
) -> tuple[EffectPreview, ParameterPoint, dict[str, dict[str, Any]]]:
    """The preview of an effect, the point at values in the units of its page, and the places that the page draws."""
    if source not in ("compare", "diagnose"):
        raise InputError(f"{source[:80]}: compare, diagnose are accepted")
    try:
        kept = pickle.loads((results / source / PREVIEWS).read_bytes())  # of this user's own private folder
        preview: EffectPreview = next(one for one in kept["previews"] if one.name == effect)
        in_si = [value / factor for value, factor in zip(values, kept["factors"][effect], strict=True)]
    except (OSError, StopIteration, ValueError):
        raise InputError(f"{effect}: there is no preview of it; {source} first") from None
    return preview, moved(preview.point, preview.sliders, in_si), kept["places"]


def _drawn(time_of_run: Any, values: Any, place: Any) -> list[float | None]:
    """Values at the places that are drawn; None where there is none."""
    known = np.isfinite(values)
    found = np.interp(place, time_of_run[known], values[known], np.nan, np.nan) if known.any() else np.full(len(place), np.nan)
    return [_or_none(float(f"{one:.6g}")) for one in found]


def _or_none(value: float) -> float | None:
    return value if np.isfinite(value) else None
