"""The section of a page in which the parameters of effects are moved by hand, and curves and errors follow."""

from collections.abc import Sequence

from ....identification.comparison.compare import Comparison
from ....identification.data.runs import Run
from ....identification.prediction.replay import relative_to_rest
from ....identification.preview.effect_preview import EffectPreview
from ....identification.preview.sliders import Slider
from ....report.curves import MEASURED, MODEL, Curve, Group, Panel
from ....report.page import Section
from ....report.preview import Preview, PreviewEffect, PreviewRun, PreviewSlider, Response
from ..run_curves import noise_spans, phase_spans
from ..texts.effect_descriptions import parameter_label, parameter_unit
from ..texts.formatting import handy_unit

TITLE = "Try it: move the effect and watch the error"
CAPTION = (
    "Interpolated between simulations at four values of each parameter, with their derivatives; the errors are of all samples. "
    "In the bars: blue the error now, grey the model as given, green noise alone. {plant}"
)
PLANT_FITTED = "Plant parameters are those fitted with each effect."
PLANT_GIVEN = "Plant parameters are those of the model file."


def preview_section(previews: Sequence[EffectPreview], given: Comparison, first: str, *, fitted: bool) -> list[Section]:
    """The section, or none without previews."""
    return [Section("try", TITLE, [preview_block(previews, given, first, fitted=fitted)])] if previews else []


def preview_block(previews: Sequence[EffectPreview], given: Comparison, first: str, *, fitted: bool) -> Preview:
    """What the section shows. `given` is the model as it is; of the runs, `first` is shown at once."""
    errors = {
        "fit": (given.fit_nrmse, given.noise_nrmse("fit")),
        "validate": (given.validate_nrmse, given.noise_nrmse("validate")),
    }
    effects = [preview_effect_block(one, given, first) for one in previews]
    return Preview("preview", effects, errors, CAPTION.format(plant=PLANT_FITTED if fitted else PLANT_GIVEN))


def preview_effect_block(one: EffectPreview, given: Comparison, first: str) -> PreviewEffect:
    """An effect as the page shows it: parameters in handy units, channels in their own."""
    units = [_unit(one, slider) for slider in one.sliders]
    sliders = [
        PreviewSlider(parameter_label(*slider.key.split(".", 2)[1:]), name, [factor * x for x in slider.nodes], slider.centre)
        for slider, (factor, name) in zip(one.sliders, units, strict=True)
    ]
    runs = [_run(one, given, run, [factor for factor, _ in units], run.file == first) for run in one.campaign.runs]
    return PreviewEffect(one.name, sliders, runs)


def _unit(one: EffectPreview, slider: Slider) -> tuple[float, str]:
    """Factor and name of a handy unit of a slider."""
    _, effect, name = slider.key.split(".", 2)
    return handy_unit(parameter_unit(one.campaign.channels, effect, name), max(map(abs, slider.nodes)))


def _run(one: EffectPreview, given: Comparison, run: Run, factors: Sequence[float], shown: bool) -> PreviewRun:
    """The channels of a run that hold enough to be compared."""
    measured = relative_to_rest(run.values, run, one.campaign.channels)
    compared = next(each for each in given.runs if each.file == run.file)
    panels, responses = [], []
    for channel in (each for each in compared.channels if len(each.time)):
        column, scale = channel.column, channel.channel.scale
        data = one.data[run.file, column] / scale
        for k, factor in enumerate(factors, 1):
            data[k :: 1 + len(factors)] /= factor
        # A derivative by a parameter in other units is smaller by their factor; so are its rows in the form.
        sizes = [1.0, *(1.0 / factor for factor in factors)] * (len(data) // (1 + len(factors)))
        form = one.forms.get((run.file, column))
        scaled = None if form is None else form * [[a * b for a in sizes] for b in sizes]
        curves = [Curve("measured", MEASURED, measured[column] / scale), Curve("model", MODEL, data[0])]
        panels.append(Panel(column, channel.channel.unit, run.time, curves, noise=noise_spans(given, run, channel)))
        responses.append(Response(data, scaled))
    return PreviewRun(Group(run.file, f"{run.file} ({run.role})", panels, phase_spans(run), shown), run.role, responses)
