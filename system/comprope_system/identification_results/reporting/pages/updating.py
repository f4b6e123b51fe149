"""The pages of `comprope add` and `comprope improve`."""

from pathlib import Path

from ....identification.model_updating.stepwise_selection import StepwiseSelection
from ....identification.model_updating.updated_model import UpdatedModel
from ....report.page import Block, Picture, Section, save_page
from .. import figures, tables
from ..texts import sentences
from ..texts.estimate_sentences import estimate_sentences
from .comparison import before_and_after, order_section

ESTIMATES = "With one standard error and a 95 % confidence interval: the effect, then the plant parameters."


def save_updated_model(path: Path, updated: UpdatedModel) -> None:
    """Write the page of a model with an effect added or refitted, completely or not at all."""
    stages = {"as given": updated.before, "plant refitted": updated.refitted, f"with {updated.effect}": updated.after}
    fit, validate = [one.fit_nrmse for one in stages.values()], [one.validate_nrmse for one in stages.values()]
    errors: list[Block] = [Picture("errors", figures.error_bars(list(stages), fit, validate)), tables.stage_table(stages)]
    title = f"{updated.before.campaign.name}: {updated.effect} {'refitted' if updated.already_present else 'added'}"
    save_page(path, title, sentences.update_sentence(updated), [Section("errors", "NRMSE", errors), *_model_sections(updated)])


def save_selection(path: Path, found: StepwiseSelection) -> None:
    """Write the page of a stepwise selection, completely or not at all."""
    fit, validate = [one.fit_nrmse for one in found.steps], [one.validate_nrmse for one in found.steps]
    steps: list[Block] = [
        Picture("steps", figures.error_bars([one.name for one in found.steps], fit, validate), "NRMSE after each step."),
        tables.step_table(found),
        tables.removal_table(found.removals),
    ]
    title = f"{found.final.before.campaign.name}: improved model"
    sections = [Section("steps", "Stepwise selection", steps), *_model_sections(found.final)]
    save_page(path, title, sentences.selection_sentence(found), sections)


def _model_sections(updated: UpdatedModel) -> list[Section]:
    """Estimates, and residuals before and after."""
    fit = f"{updated.effect} and plant parameters as fitted"
    limits = estimate_sentences(updated.fitted, updated.effects)
    estimates: list[Block] = [ESTIMATES, *limits, tables.estimate_table(updated.effects), tables.estimate_table(updated.plant)]
    return [
        Section("estimates", "Estimates", estimates),
        before_and_after(updated.before, updated.after, fit),
        order_section(updated.after, "Residual by order of the sheave's rotation, after", fit, folded=True),
    ]
