"""Which effects have a preview: those of a diagnosis's best fits, and those that a model has already."""

from collections.abc import Sequence
from concurrent.futures import Executor

from comprope.errors import SimulationError

from ..data.campaign import Campaign
from ..diagnosis.diagnose import Diagnosis
from ..estimation.gauss_newton import FitResult
from ..prediction.effect_hypotheses import Hypothesis
from ..prediction.model_effects import effect_name, effects_in_model
from ..prediction.parameter_point import ParameterPoint
from ..progress import ProgressCallback
from ..settings import PREVIEW
from .effect_preview import EffectPreview, preview_effect
from .sliders import sliders_of

Parts = Sequence[tuple[Hypothesis, Sequence[float]]]


def preview_fits(found: Diagnosis, executor: Executor, report_progress: ProgressCallback) -> list[EffectPreview]:
    """Previews of the best fit of a diagnosis and of its close rivals, with the plant as fitted with each; none if adequate."""
    if found.kind == "adequate":
        return []
    fits = [one.fitted for one in found.ranking if one.refined and one.fitted.hypothesis]
    least = min((one.chi_square for one in fits), default=0.0)
    close = [one for one in fits if one.chi_square <= PREVIEW.rival_factor * least][: 1 + PREVIEW.max_rivals]
    return _previews(found.campaign, [(_parts(one), one.point) for one in close], executor, report_progress)


def preview_model_effects(campaign: Campaign, executor: Executor, report_progress: ProgressCallback) -> list[EffectPreview]:
    """Previews of the effects that the model of a campaign has, each alone."""
    hypothesis, coefficients = effects_in_model(campaign)
    if hypothesis is None:
        return []
    point = ParameterPoint(effects=hypothesis.parameters([float(c) for c in coefficients]))
    each = [([part], point) for part in hypothesis.split_coefficients([float(c) for c in coefficients])]
    return _previews(campaign, each[: 1 + PREVIEW.max_rivals], executor, report_progress)


def _parts(fitted: FitResult) -> Parts:
    assert fitted.hypothesis is not None
    return fitted.hypothesis.split_coefficients(fitted.effect_coefficients)


def _previews(
    campaign: Campaign, each: Sequence[tuple[Parts, ParameterPoint]], executor: Executor, report_progress: ProgressCallback
) -> list[EffectPreview]:
    """A preview for each group of effects that can be simulated at all nodes."""
    found = []
    for parts, point in each:
        name = " + ".join(dict.fromkeys(effect_name(part) for part, _ in parts))
        if not (sliders := sliders_of(parts)):
            continue
        report_progress(f"{name}: replays for the preview")
        try:
            found.append(preview_effect(name, campaign, point, sliders, executor))
        except SimulationError:  # a node too far away: the page then offers no preview of this effect
            continue
    return found
