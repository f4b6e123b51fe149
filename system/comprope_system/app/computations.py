"""The other steps, as worker processes do them: each calls a public function and writes its result, completely or not at all."""

import pickle
import time
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

import numpy as np

import comprope_system
from comprope.errors import InputError

from ..identification.comparison.compare import compare as compare_at
from ..identification.preview.effect_preview import EffectPreview
from ..identification.preview.sliders import moved
from ..identification.reporting.pages.comparison import worst_run
from ..identification.reporting.pages.preview import preview_block
from ..identification.result.diagnosis import DiagnosisResult
from ..parallel.executors import threads
from ..parallel.progress import Progress
from ..report.curves import decode
from ..report.json_output import plain
from ..report.result import Result
from .workspace import new_result, write_record

PAGE, JSON, MODEL, PREVIEWS = "report.html", "output.json", "model.toml", "previews.pickle"
FMUS = "fmus"


def check(campaign: Path, results: Path) -> dict[str, Any]:
    """Read and check the campaign."""
    found = comprope_system.check(campaign)
    return _kept(results, "check", found, found.to_json())


def compare(campaign: Path, results: Path) -> dict[str, Any]:
    """The model against the measurements."""
    found = comprope_system.compare(campaign, previews=True)
    return _kept(results, "compare", found, {"fit_nrmse": found.fit_nrmse, "validate_nrmse": found.validate_nrmse})


def diagnose(campaign: Path, results: Path, executor: Executor, progress: Progress) -> dict[str, Any]:
    """Which effect is missing."""
    found = comprope_system.diagnose(campaign, executor=executor, previews=True, progress=progress)
    ranking = [{"effect": one["effect"], "probability": one["probability"], "nrmse": one["error_after"]} for one in found.ranking]
    facts = {"verdict": found.verdict, "verdict_kind": found.verdict_kind, "ranking": ranking}
    return _kept(results, "diagnose", found, facts, lambda folder: _keep_previews(folder, found))


def add(campaign: Path, results: Path, executor: Executor, progress: Progress, effect: str) -> dict[str, Any]:
    """Add an effect to the model."""
    found = comprope_system.add(campaign, effect, executor=executor, progress=progress)
    facts = {"effect": effect, "before": found.before.fit_nrmse, "after": found.after.fit_nrmse}
    facts |= {"validate_before": found.before.validate_nrmse, "validate_after": found.after.validate_nrmse}
    return _kept(results, f"add {effect}", found, facts, lambda folder: found.save_model(folder / MODEL))


def improve(campaign: Path, results: Path, executor: Executor, progress: Progress) -> dict[str, Any]:
    """Add until nothing is missing."""
    found = comprope_system.improve(campaign, executor=executor, progress=progress)
    facts = {"effects": found.effects, "before": found.before.fit_nrmse, "after": found.after.fit_nrmse}
    facts |= {"validate_before": found.before.validate_nrmse, "validate_after": found.after.validate_nrmse}
    return _kept(results, "improve", found, facts, lambda folder: found.save_model(folder / MODEL))


def fmus(results: Path, name: str, native: bool) -> dict[str, Any]:
    """The FMUs of a result's model, beside it."""
    model = results / name / MODEL
    if not model.is_file():
        raise InputError(f"{name}: has no new model")
    comprope_system.fmu(model, native=native).save(results / name / FMUS)
    return {"files": sorted(path.name for path in (results / name / FMUS).iterdir())}


def replay(results: Path, effect: str, values: list[float]) -> dict[str, Any]:
    """A true replay of a previewed effect at values in the units of the page: NRMSE by role, and curves at the drawn places."""
    try:
        kept = pickle.loads((results / "diagnose" / PREVIEWS).read_bytes())  # of this user's own private folder
        preview: EffectPreview = next(one for one in kept["previews"] if one.name == effect)
        in_si = [value / factor for value, factor in zip(values, kept["factors"][effect], strict=True)]
    except (OSError, StopIteration, ValueError):
        raise InputError(f"{effect}: there is no preview of it; diagnose first") from None
    campaign, point = preview.campaign, moved(preview.point, preview.sliders, in_si)
    with threads() as workers:
        found = compare_at(campaign, workers, point)
    curves = {
        file: {
            column: _drawn(next(one.time for one in campaign.runs if one.file == file),
                           found.predictions[file, column] / campaign.channels[column].scale, place)
            for column, place in columns.items()
        }
        for file, columns in kept["places"].items()
    }  # fmt: skip
    return {"errors": {"fit": _or_none(found.fit_nrmse), "validate": _or_none(found.validate_nrmse)}, "curves": curves}


def _drawn(time_of_run: Any, values: Any, place: Any) -> list[float | None]:
    """Values at the places that are drawn; None where there is none."""
    known = np.isfinite(values)
    found = np.interp(place, time_of_run[known], values[known], np.nan, np.nan) if known.any() else np.full(len(place), np.nan)
    return [_or_none(float(f"{one:.6g}")) for one in found]


def _keep_previews(folder: Path, found: DiagnosisResult) -> None:
    """What a true replay needs to know of the previews of a page."""
    if not found.previews:
        return
    before = found.validated.before
    shown = preview_block(found.previews, before, worst_run(before), fitted=True)
    places = {
        group["name"]: {panel["name"]: decode(panel["place"]) for panel in group["panels"]}
        for group in shown.curves.curve_data["groups"]
    }
    factors = {
        one.name: [
            part.nodes[part.centre] / slider.value if slider.value else part.nodes[-1] / slider.nodes[-1]
            for part, slider in zip(block.sliders, one.sliders, strict=True)
        ]
        for one, block in zip(found.previews, shown.effects, strict=True)
    }
    kept = {"previews": found.previews, "places": places, "factors": factors}
    (folder / PREVIEWS).write_bytes(pickle.dumps(kept))


def _kept(
    results: Path, name: str, found: Result, facts: Mapping[str, Any], more: Callable[[Path], None] = lambda _: None
) -> dict[str, Any]:
    """Write page, JSON and what else belongs to a result; returns what the app shows of it."""
    with new_result(results, name) as folder:
        found.save_html(folder / PAGE)
        found.save_json(folder / JSON)
        more(folder)
        record = {"name": name, "headline": found.headline(), "finished": time.time(), "facts": plain(facts)}
        record["model"] = (folder / MODEL).is_file()
        write_record(folder, record)
    return record


def _or_none(value: float) -> float | None:
    return value if np.isfinite(value) else None


COMPUTATIONS: dict[str, Callable[..., dict[str, Any]]] = {"diagnose": diagnose, "add": add, "improve": improve}
