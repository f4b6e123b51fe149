"""The public function `comprope_system.new`."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from comprope.atomic_files import atomic_write
from comprope.errors import InputError
from comprope.rope.effects import RopeModel

from ..identification_results.workflow import check
from ..measurements.files.raw_table import printable
from ..measurements.files.reader import require_regular_file
from ..measurements.units import MOTIONS
from .campaign_text import campaign_text
from .car_direction import counts_downward, with_sheave_turned
from .column_matching import own_name, roles
from .column_roles import BY_SIZE, Role, reach
from .corrections import Corrections, corrected, require_runs
from .elevator_model.model_choice import choose_model, copied
from .questions import Ask, asked_changes, asked_role, asked_start, without_guess
from .result import NewCampaign
from .run_entries import Answers, noise, run_entry
from .survey.run_grouping import grouped
from .survey.surveyed_runs import SurveyedRun, survey

HELD_OUT = 2  # runs from which on one is held out
DOWNWARD = "written as sign = -1 with the height of the shaft as zero under [car]"
SHEAVE_OF_RUN = 'where it was another, write set = { "sheave.mass" = ..., "sheave.inertia" = ... } in its run'
SHORT_REST = 1.0  # s at rest before a trip that references need


def new(
    campaign: str | Path,
    files: Sequence[str | Path],
    *,
    model: str | Path | RopeModel | None = None,
    ask: Ask | None = None,
    corrections: Corrections | None = None,
) -> NewCampaign:
    """Describe raw logger files: write campaign.toml, model and files into a folder; nothing is replaced.

    Each file with the car's motion is a run. One without is part of the run to which it belongs by date and time or by its name;
    files of one run may be stated together, "drive.csv+lasers.csv".
    `model` is a model file, a data sheet (a model file with the rope's construction in place of its mass and stiffness, which are
    estimated), a preset's name or a `RopeModel`, by default the only one in the folder or the preset tower50.
    `ask(question, default)` returns the answer to what the files do not say; an answer that is not accepted is asked for again.
    Without `ask` guessed columns are left out and the sheave is the model's. `corrections` state what columns and runs are,
    whatever the files look like. Raises `InputError` if campaign.toml exists, or a file holds no motion of a car.
    """
    known = corrections or Corrections()
    folder = Path(campaign)
    path = folder / "campaign.toml"
    stated = [_together(one) for one in files]
    _require_new(path, [one for together in stated for one in together])
    folder.mkdir(parents=True, exist_ok=True)
    chosen = choose_model(folder, model, ask)
    loaded, remarks = chosen.model, list(chosen.remarks)
    groups = grouped(folder, [[copied(one, folder) for one in together] for together in stated])
    surveyed = survey(folder, groups, loaded, known.car)
    found = _roles(surveyed, loaded, ask, known)
    if downward := known.car.column is None and counts_downward(surveyed, found, loaded):
        found = with_sheave_turned(found)
    used = {column: role for column, role in found.items() if role.quantity}
    channels = [(column, role, noise(surveyed, column, role)) for column, role in used.items()]
    if not channels:
        columns = ", ".join(found)
        raise InputError(f"{folder}: no column is a channel that is known; describe them in campaign.toml: {columns}")
    held_out = _held_out(surveyed)
    by_file = {run.file: "validate" if run.file == held_out else "fit" for run in surveyed} | dict(known.roles)
    runs = [run_entry(run, by_file[run.file], found, _answers(run, loaded, ask, known.changes)) for run in surveyed]
    tables = _tables(surveyed, loaded.shaft.height / MOTIONS["position"][surveyed[0].car.unit] if downward else None)
    tables["plant"] = {key: {"relative": one} for key, one in chosen.tolerances.items()}
    with atomic_write(path) as temporary:
        temporary.write_text(campaign_text(folder.resolve().name, chosen.file, tables, channels, runs), "utf-8")
    remarks += [*_remarks(surveyed), *_assumed_units(used, surveyed)]
    if downward:
        remarks.append(f"{surveyed[0].car.column}: counts downward: then the lasers see the rope where they should; {DOWNWARD}")
    if not ask and not known.changes:
        remarks.append(f"the sheave of the model, {loaded.sheave.mass:g} kg, is taken in every run; {SHEAVE_OF_RUN}")
    parts = {run.file: run.group.others for run in surveyed}
    return NewCampaign(path, surveyed[0].car.column, found, by_file, parts, tuple(remarks), check(path))


def _roles(runs: Sequence[SurveyedRun], model: RopeModel, ask: Ask | None, known: Corrections) -> dict[str, Role]:
    """The role of each column as found, asked for and corrected; raises `InputError` for corrections that cannot be."""
    found = roles(runs, model)
    found = {name: asked_role(name, role, model, ask) if ask else without_guess(role) for name, role in found.items()}
    require_runs(known, [run.file for run in runs], model)
    return corrected(found, known.columns, model)


def _remarks(runs: Sequence[SurveyedRun]) -> list[str]:
    """Sentences about short rests, and columns that nearly hold numbers."""
    short = [run for run in runs if run.trip is not None and run.rest < SHORT_REST]
    need = f"references at rest need {SHORT_REST:g} s"
    rests = [f"{run.file}: {run.rest:.2g} s at rest before the trip; {need}" for run in short]
    return [*rests, *(sentence for run in runs for sentence in run.unread)]


def _assumed_units(used: Mapping[str, Role], runs: Sequence[SurveyedRun]) -> Iterator[str]:
    """A sentence about channels whose unit no file states, with the largest motions in the unit that is taken."""
    assumed = {name: role.unit for name, role in used.items() if role.why.endswith(BY_SIZE)}
    if assumed:
        sizes = {
            name: max((reach(run.columns[own].samples.values) for run in runs if (own := own_name(run, name))), default=0.0)
            for name in assumed
        }
        shown = ", ".join(f"{printable(name)} moves by {sizes[name]:.2g} {unit}" for name, unit in assumed.items())
        yield f"no file states a unit, and by the size of the readings {shown}; if it is another, correct unit under [[channels]]"


def _answers(run: SurveyedRun, model: RopeModel, ask: Ask | None, stated: Mapping[str, Mapping[str, float]]) -> Answers:
    """What is asked about a run: where its car starts, unless its column tells, and its sheave, unless that is `stated`."""
    if ask is None:
        return Answers(None, stated.get(run.file, {}))
    start = None if run.motion.grounded else asked_start(run.file, model, ask)
    return Answers(start, stated[run.file] if run.file in stated else asked_changes(run.file, model, ask))


def _together(one: str | Path) -> list[Path]:
    """The files of one argument: several of one run are written with + between them."""
    return [Path(one)] if Path(one).exists() or "+" not in str(one) else [Path(part) for part in str(one).split("+")]


def _require_new(path: Path, files: Sequence[Path]) -> None:
    """Raise `InputError` if there is a campaign already, or no files, or some that are none, or named twice."""
    if path.exists():
        raise InputError(f"{path}: exists and is not replaced; remove it, or name another folder")
    if not files:
        raise InputError("no files: name at least one file of a run")
    for one in files:
        require_regular_file(one, None)
        if not one.name.isprintable():  # nor can a name that is no UTF-8 be written into campaign.toml
            raise InputError(f"{printable(one, 200)}: its name has characters that cannot be shown; rename the file")
    if twice := sorted({one.name for one in files if sum(other.name == one.name for other in files) > 1}):
        raise InputError(f"{', '.join(twice)}: named twice; each file is accepted once, with a name of its own")


def _tables(runs: Sequence[SurveyedRun], top: float | None) -> dict[str, dict[str, object]]:
    """What `[file]` states because the files do not, and `[car]` or `[counterweight]` if they have one column.

    `top` is the reading at the bottom landing of a car that counts downward.
    """
    units = {run.time_unit for run in runs}
    file: dict[str, object] = {}
    if len(units) == 1 and (unit := units.pop()):
        file["time_unit"] = unit
    ends = {(run.motion.end, run.motion.column, run.car.quantity) for run in runs}
    found: dict[str, dict[str, object]] = {"file": file}
    if len(ends) == 1:
        end, column, quantity = ends.pop()
        found[end] = {"column": column}
        found[end] |= {} if quantity == "position" else {"quantity": quantity}
    if top is not None:
        found.setdefault("car", {}).update({"sign": -1, "zero": top})
    return found


def _held_out(runs: Sequence[SurveyedRun]) -> str | None:
    """The run that is kept for validation: the one with the shortest travel; None of a single run."""
    return min(runs, key=lambda run: run.travel).file if len(runs) >= HELD_OUT else None
