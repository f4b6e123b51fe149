"""The other steps, as worker processes do them: each calls a public function and writes its result, completely or not at all."""

import time
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from functools import partial
from pathlib import Path
from typing import Any

import comprope_system
from comprope.errors import InputError

from ..identification_results.reporting.texts.estimate_sentences import estimate_in_words
from ..identification_results.result.updating import AddResult, ImproveResult
from ..parallel.progress import Progress
from ..report.json_output import plain
from ..report.result import Result
from .replays import keep_previews
from .workspace import new_result, write_record

PAGE, JSON, MODEL = "report.html", "output.json", "model.toml"
FMUS = "fmus"


def check(campaign: Path, results: Path) -> dict[str, Any]:
    """Read and check the campaign."""
    found = comprope_system.check(campaign)
    return _kept(results, "check", found, found.to_json())


def compare(campaign: Path, results: Path) -> dict[str, Any]:
    """The model against the measurements."""
    found = comprope_system.compare(campaign, previews=True)
    facts = {"fit_nrmse": found.fit_nrmse, "validate_nrmse": found.validate_nrmse}
    shown = partial(keep_previews, previews=found.previews, given=found.comparison, fitted=False)
    return _kept(results, "compare", found, facts, shown)


def overlay(campaign: Path, results: Path, names: list[str]) -> dict[str, Any]:
    """The models of some results drawn together over the measurements."""
    models = {name.removeprefix("add "): results / name / MODEL for name in names}
    if not models or not all(path.is_file() for path in models.values()):
        raise InputError("no models to be drawn together: choose some that have been made")
    found = comprope_system.compare(campaign, models=models)
    return _kept(results, "overlay", found, {"models": names})


def diagnose(campaign: Path, results: Path, executor: Executor, progress: Progress) -> dict[str, Any]:
    """Which effect is missing."""
    found = comprope_system.diagnose(campaign, executor=executor, previews=True, progress=progress)
    ranking = [{"effect": one["effect"], "probability": one["probability"], "nrmse": one["error_after"]} for one in found.ranking]
    facts = {"verdict": found.verdict, "verdict_kind": found.verdict_kind, "ranking": ranking}
    shown = partial(keep_previews, previews=found.previews, given=found.validated.before, fitted=True)
    return _kept(results, "diagnose", found, facts, shown)


def add(
    campaign: Path, results: Path, executor: Executor, progress: Progress, effect: str, start: dict[str, float] | None = None
) -> dict[str, Any]:
    """Add an effect to the model, fitted from values by model key if they are stated."""
    found = comprope_system.add(campaign, effect, start=start, executor=executor, progress=progress)
    stated = ", ".join(f"{key.split('.', 2)[2]} {value:.4g}" for key, value in (start or {}).items())
    name = f"add {effect}{f' from {stated}' if stated else ''}"
    facts: dict[str, Any] = {"effect": effect, "start": start, "before": found.before.fit_nrmse, "after": found.after.fit_nrmse}
    facts |= {"validate_before": found.before.validate_nrmse, "validate_after": found.after.validate_nrmse}
    return _kept(results, name, found, facts | _values(found), lambda folder: found.save_model(folder / MODEL))


def improve(campaign: Path, results: Path, executor: Executor, progress: Progress) -> dict[str, Any]:
    """Add until nothing is missing."""
    found = comprope_system.improve(campaign, executor=executor, progress=progress)
    facts = {"effects": found.effects, "before": found.before.fit_nrmse, "after": found.after.fit_nrmse}
    facts |= {"validate_before": found.before.validate_nrmse, "validate_after": found.after.validate_nrmse}
    return _kept(results, "improve", found, facts | _values(found), lambda folder: found.save_model(folder / MODEL))


def fmus(results: Path, name: str, native: bool) -> dict[str, Any]:
    """The FMUs of a result's model, beside it."""
    model = results / name / MODEL
    if not model.is_file():
        raise InputError(f"{name}: has no new model")
    comprope_system.fmu(model, native=native).save(results / name / FMUS)
    return {"files": sorted(path.name for path in (results / name / FMUS).iterdir())}


def _values(found: AddResult | ImproveResult) -> dict[str, Any]:
    """Parameters of the effects of a new model in words, with their intervals."""
    channels = found.campaign.channels
    told = [estimate_in_words(channels, key, one) for key, one in found.parameters.items() if not key.endswith(".phase")]
    return {"values": [f"{name} {value} ({interval})" for name, value, interval in told]}


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


COMPUTATIONS: dict[str, Callable[..., dict[str, Any]]] = {"diagnose": diagnose, "add": add, "improve": improve}
