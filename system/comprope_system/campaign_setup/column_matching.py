"""Which columns of several files are one channel: by name, or by what they hold where the names differ."""

from collections.abc import Sequence
from dataclasses import replace

from comprope.rope.effects import RopeModel

from ..measurements.columns.column_names import plain_name
from ..measurements.columns.readings import written_unit
from ..measurements.units import is_unit, unit_named
from .column_roles import GUESS, LIKELY, SURE, Evidence, Role, role_of
from .survey.surveyed_runs import SurveyedColumn, SurveyedRun


def roles(runs: Sequence[SurveyedRun], model: RopeModel) -> dict[str, Role]:
    """The role of each column by its name in the first file that has it; columns that differ in separators only are the same."""
    names: list[str] = []
    for run in runs:
        names += [name for name in run.columns if all(own_name(run, one) != name for one in names)]
    found = {name: role_of(name, _evidence(runs, name, model), model.sensors) for name in names}
    having = {name: {run.file for run in runs if own_name(run, name)} for name in found}
    return _one_each(found, having)


def own_name(run: SurveyedRun, name: str) -> str | None:
    """The name of a column in a run, which may differ in unit and separators; None where the run has none, or several."""
    alike = [own for own in run.columns if plain_name(own) == plain_name(name)]
    return name if name in run.columns else alike[0] if len(alike) == 1 else None


def _evidence(runs: Sequence[SurveyedRun], name: str, model: RopeModel) -> list[Evidence]:
    found = []
    for run in runs:
        if (own := own_name(run, name)) is not None:
            column = run.columns[own]
            rolling = run.speed(column.samples.time) * column.related / model.sheave.radius
            found.append(Evidence(column.samples.values, rolling, stated_unit(column)))
    return found


def stated_unit(column: SurveyedColumn) -> str | None:
    """The unit that a file states for a column, if it is one."""
    written = written_unit(column.raw)
    return (unit_named(written) or (written if is_unit(written) else None)) if written else None


def _one_each(found: dict[str, Role], having: dict[str, set[str]]) -> dict[str, Role]:
    """The roles with one column for each sensor and each quantity of the sheave: the surest.

    Columns with the same role and sign in other files are the same under another name; further ones are left out. `having`
    are the files that have each column.
    """
    order = {SURE: 0, LIKELY: 1, GUESS: 2}
    taken: dict[tuple[str, str | None], str] = {}
    result = dict(found)
    for name, role in sorted(found.items(), key=lambda item: order[item[1].certainty]):
        if role.quantity is None:
            continue
        if role.quantity == "lateral_displacement" and role.sensor is None:
            result[name] = Role(None, certainty=GUESS, why="a lateral displacement, but at which sensor of the model?")
        elif (place := (role.quantity, role.sensor)) in taken:
            first = found[taken[place]]
            alike = role.sign == first.sign and role.certainty != GUESS
            if alike and having[name].isdisjoint(having[taken[place]]):
                having[taken[place]] |= having[name]
                result[name] = replace(role, quantity=None, same_as=taken[place])
            else:
                result[name] = Role(None, certainty=GUESS, why=f"{role.shown}, as {taken[place]}")
        else:
            taken[place] = name
    return result
