"""The public functions `comprope_system.check`, `compare`, `diagnose`, `add` and `improve`."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from pathlib import Path

from comprope.errors import InputError
from comprope.rope.effects import REGISTRY, RopeModel
from comprope.rope.model_file import with_changes

from ..identification.comparison.compare import compare as compare_with_model
from ..identification.comparison.data_quality import remarks
from ..identification.data.campaign import Campaign, load_campaign, with_model
from ..identification.data.campaign_check import check_campaign
from ..identification.diagnosis.diagnose import diagnose as rank_effects
from ..identification.diagnosis.experiment_design import is_inconclusive, rank_candidate_runs
from ..identification.diagnosis.held_out_validation import validate
from ..identification.model_updating.add_effect import add_effect
from ..identification.model_updating.stepwise_selection import select_stepwise
from ..identification.prediction.model_effects import effect_values, hypotheses_named, require_effects
from ..identification.prediction.parameter_point import ParameterPoint
from ..identification.prediction.plant_parameters import plant_values, with_tolerances
from ..identification.preview.candidates import preview_fits, preview_model_effects
from ..identification.progress import ProgressCallback
from ..identification.residuals.input_estimation import estimate_residual_force
from ..identification.residuals.residual_correlation import residual_correlations
from ..identification.residuals.residual_series import rest_ratio_of
from ..identification.settings import MODEL_UPDATING
from ..parallel.executors import processes, threads
from ..parallel.progress import Progress, no_progress
from ..presets.overrides import Changes, by_key
from .reporting.run_curves import MOST_MODELS
from .result.check import CheckResult
from .result.comparison import ComparisonResult
from .result.diagnosis import DiagnosisResult
from .result.updating import AddResult, ImproveResult

CampaignInput = str | Path | Campaign
ModelFiles = Sequence[str | Path] | Mapping[str, str | Path]


def check(campaign: str | Path) -> CheckResult:
    """Read all files of a campaign and check them, without a simulation.

    `campaign` is a folder with campaign.toml, or that file. Problems of its files are in the result; raises `InputError` only if
    campaign.toml is missing or cannot be understood.
    """
    return CheckResult(check_campaign(campaign))


def compare(
    campaign: CampaignInput,
    *,
    models: ModelFiles = (),
    executor: Executor | str | None = None,
    previews: bool = False,
    progress: Progress = no_progress,
) -> ComparisonResult:
    """Simulate the model with the measured car motion, and compute its error for each run and channel.

    `campaign` is a folder with campaign.toml, that file, or a `Campaign`. `models` are files of further models to be compared
    with the same runs, perhaps by a name for each. Runs on `executor` (of concurrent.futures, or
    "dask://HOST:PORT"), else on threads of this process. With `previews` the effects that the model has are replayed with other
    parameters too, so that the page of the result lets them be moved. Raises `InputError` with every problem of the campaign's
    files, `SimulationError` where a run cannot be simulated.
    """
    loaded = _loaded(campaign)
    files = models if isinstance(models, Mapping) else {str(one): one for one in models}
    if len(files) >= MOST_MODELS:
        raise InputError(f"{len(files)} models: at most {MOST_MODELS - 1} are compared with that of the campaign")
    others = {name: with_model(loaded, file) for name, file in files.items()}
    with threads(executor) as workers:
        progress("simulating the runs", 0, 0)
        found = compare_with_model(loaded, workers)
        variants = {name: compare_with_model(one, workers) for name, one in others.items()}
        moved = preview_model_effects(loaded, workers, _stages(progress)) if previews else []
    return ComparisonResult(found, tuple(remarks(loaded, found.predictions)), tuple(moved), variants)


def diagnose(
    campaign: CampaignInput,
    *,
    without: Sequence[str] = (),
    executor: Executor | str | None = None,
    jobs: int | None = 1,
    previews: bool = False,
    progress: Progress = no_progress,
) -> DiagnosisResult:
    """Identify the physical effect that is missing from the model, with its probability.

    Every known effect but those in `without` is fitted on the fit runs; validation runs are used for neither fit nor ranking.
    `campaign` is a folder with campaign.toml, that file, or a `Campaign`. Runs on `executor` (of concurrent.futures, or
    "dask://HOST:PORT"), else on `jobs` processes, 1 being this one and None one for each core; it takes minutes. With `previews`
    the best fits are replayed with other parameters too, so that the page of the result lets them be moved. Raises `InputError`
    for problems of the campaign's files or an unknown effect, `SimulationError` where the model cannot be simulated.
    """
    loaded, report = _loaded(campaign), _stages(progress)
    require_effects(without)
    base = ParameterPoint(effects=effect_values(loaded.model))
    with processes(jobs, executor) as workers:
        found = rank_effects(loaded, workers, report, base, without)
        report("validating on the runs held out")
        validated = validate(found, workers, base)
        report("proposing the next run")
        next_runs = rank_candidate_runs(found, workers) if is_inconclusive(found) else []
        unknown = found.kind == "unknown_effect"
        force = estimate_residual_force(found.problem, found.baseline, report) if unknown else None
        moved = preview_fits(found, workers, report) if previews else []
    residual = validated.refitted.predictions
    correlations = [] if found.kind == "adequate" else residual_correlations(loaded, residual)
    return DiagnosisResult(
        validated, tuple(correlations), rest_ratio_of(loaded, residual), force, tuple(next_runs), tuple(moved)
    )


def add(
    campaign: CampaignInput,
    effect: str,
    *,
    start: Changes | None = None,
    executor: Executor | str | None = None,
    jobs: int | None = 1,
    progress: Progress = no_progress,
) -> AddResult:
    """Add an effect to the model of a campaign, fitted on its fit runs together with the plant parameters.

    `effect` is a name such as "air_drag", an instrument's with its channel as "sensor_gain.cw_low"; an effect that the model has
    already is refitted. The fit begins at the values that `start` gives by their keys in a model file, as
    {"effects.air_drag.drag_coefficient": 1.0}, else at those that a linear screening proposes. Other arguments and errors as for
    `diagnose`.
    """
    loaded = _loaded(campaign)
    hypotheses_named(effect, loaded, ())
    stated = _stated(loaded, effect, start) if start else None
    with processes(jobs, executor) as workers:
        return AddResult(add_effect(loaded, effect, workers, _stages(progress), stated))


def improve(
    campaign: CampaignInput,
    *,
    max_effects: int = MODEL_UPDATING.max_effects,
    executor: Executor | str | None = None,
    jobs: int | None = 1,
    progress: Progress = no_progress,
) -> ImproveResult:
    """Diagnose and add until nothing is missing or no known effect helps (stepwise selection), then remove what is not needed.

    At most `max_effects` are added. Other arguments and errors as for `diagnose`.
    """
    loaded = _loaded(campaign)
    with processes(jobs, executor) as workers:
        return ImproveResult(select_stepwise(loaded, workers, _stages(progress), max_effects))


def _stated(campaign: Campaign, effect: str, start: Changes) -> RopeModel:
    """The model with the effect at its stated values; raises `InputError` for values that are none of it or that cannot be."""
    values, source = by_key(start, "--start", "start")
    name, _, column = effect.partition(".")
    accepted = f"effects.{name}.{column}"
    if name in REGISTRY and f"effects.{name}" in {key.rpartition(".")[0] for key in effect_values(campaign.model)}:
        raise InputError(f"{source}: {effect} is in the model already, where its values are changed")
    if wrong := [key for key in values if not (key == accepted if column else key.startswith(accepted))]:
        raise InputError(f"{source}: {', '.join(wrong)}: values of {accepted}{'' if column else 'PARAMETER'} are accepted")
    return with_changes(campaign.model, values, source)


def _loaded(campaign: CampaignInput) -> Campaign:
    loaded = campaign if isinstance(campaign, Campaign) else load_campaign(campaign)
    with_tolerances(loaded.tolerances, plant_values(loaded.model))  # refuses what is no tolerance before anything is simulated
    return loaded


def _stages(progress: Progress) -> ProgressCallback:
    """Progress by the name of each stage, whose number of steps is unknown."""
    return lambda stage: progress(stage, 0, 0)
