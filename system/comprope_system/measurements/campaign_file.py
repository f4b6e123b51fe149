"""What campaign.toml may say: how files are written, the column of the car, channels and runs."""

from pathlib import Path
from typing import Any, Literal

from pydantic import ConfigDict, Field, ValidationError

from comprope.errors import InputError
from comprope.quantities import Component
from comprope.rope.model_file import read_toml
from comprope.validation_messages import validation_problems

from .files.file_format import FileFormat
from .motion.recover import Motion
from .units import UNITS

Quantity = Literal[
    "lateral_displacement", "sheave_displacement", "sheave_angular_velocity", "sheave_force",
    "car_end_tension", "counterweight_end_tension",
]  # fmt: skip


class Reading(Component):
    """From the readings of a column to values: sign * scale * (reading - zero), in the unit of the column."""

    model_config = ConfigDict(populate_by_name=True)  # in Python a channel's `scale` is its unit in SI units

    factor: float = Field(default=1.0, alias="scale", gt=0.0, description="units per reading, e.g. millimetres per volt")
    sign: Literal[1, -1] = Field(default=1, description="-1 for an instrument that counts the other way round")
    zero: float = Field(default=0.0, description="the reading at which the value is zero")
    missing: tuple[float | int | str, ...] = Field(default=(), description="readings that stand for no value, e.g. [9999]")
    time: str | None = Field(
        default=None, description="the column of its own clock, if it is not that of the nearest column of times"
    )


class MotionColumn(Reading):
    """The column that gives the motion of the car or of the counterweight."""

    column: str | None = Field(default=None, description="the column's name, if it is not recognised by it")
    quantity: Literal["position", "speed", "acceleration"] | None = Field(
        default=None, description="what is measured; default by the name"
    )
    unit: str | None = Field(default=None, description="unit of the column: m, cm, mm, ft, in; m/s, ...; m/s2, g, ...")


class Channel(Reading):
    """Measured channel: a column of the run files with its quantity, unit, reference and noise."""

    column: str = Field(description="the column's name in the file")
    quantity: Quantity = Field(description="what is measured")
    sensor: str | None = Field(default=None, description="for lateral_displacement: a sensor of the model")
    unit: str = Field(description="unit of the column and of its noise")
    reference: Literal["rest", "absolute"] = Field(
        default="absolute", description="value less its mean before the trip, or the value"
    )
    noise: float | None = Field(
        default=None, ge=0.0, description="one standard deviation of the noise, in the unit of the column"
    )

    @property
    def scale(self) -> float:
        """SI units per unit of the column."""
        return UNITS[self.quantity][self.unit]


class RunReading(Reading):
    """What differs in one run from how a channel or a motion is read in the others; what is absent is as there."""

    unit: str | None = Field(default=None, description="unit of the column in this run")


class RunSpec(Component):
    """Entry of a run in campaign.toml: its files, its role, and the parameters that differ from the model file."""

    file: str = Field(description="the file of the run, relative to campaign.toml")
    role: Literal["fit", "validate"] = Field(default="fit", description="validate: never used for fitting or ranking")
    set: dict[str, float | str] = Field(default_factory=dict, description='changes of the model, e.g. { "sheave.mass" = 120.0 }')
    files: dict[str, str] = Field(default_factory=dict, description='other files by channel, or "car": { cw_low = "laser.csv" }')
    columns: dict[str, str] = Field(
        default_factory=dict, description='names in this run\'s files by channel: { cw_low = "Laser 1" }, "" where it has none'
    )
    readings: dict[str, RunReading] = Field(
        default_factory=dict, description='what differs in this run, by channel or "car": { cw_low = { unit = "m", sign = -1 } }'
    )
    offsets: dict[str, float] = Field(default_factory=dict, description="seconds to add to the times of another file, by file")
    car_start: float | None = Field(
        default=None, description="height of the car at the start [m], where its column counts from there, or is a speed"
    )
    car_end: float | None = Field(
        default=None, description="the same at the end; with car_start, it removes the drift of an integrated signal"
    )
    motion: Motion | None = Field(default=None, description="of this run alone; default that of the campaign")


class Tolerance(Component):
    """How well a parameter of the model is known: one standard deviation of its prior."""

    relative: float | None = Field(default=None, gt=0.0, le=2.0, description="share of its value, e.g. 0.05 for five per cent")
    absolute: float | None = Field(default=None, gt=0.0, description="the same in the unit of the parameter")


class CampaignFile(Component):
    """Content of campaign.toml."""

    name: str = Field(description="name of the campaign")
    model: str = Field(description="the model file, relative to campaign.toml")
    file: FileFormat = Field(default_factory=FileFormat, description="how the run files are written")
    car: MotionColumn = Field(default_factory=MotionColumn, description="the column of the car's motion")
    counterweight: MotionColumn = Field(default_factory=MotionColumn, description="the same of the counterweight")
    motion: Motion = Field(
        default="auto", description='"exact": motions are taken as they are; "auto": where they are no smooth trips'
    )
    plant: dict[str, Tolerance | Literal["fixed"]] = Field(
        default_factory=dict,
        description='how well parameters of the model are known: { "rope.mass_per_length" = { relative = 0.02 } } or "fixed"',
    )
    channels: tuple[Channel, ...] = Field(description="the channels, at least one")
    runs: tuple[RunSpec, ...] = Field(description="the runs, at least one")


def read_campaign_file(path: Path) -> CampaignFile:
    """The content of a campaign.toml; raises `InputError` with one line for each problem."""
    try:
        return CampaignFile.model_validate(_with_tuples(read_toml(path)))
    except ValidationError as error:
        raise InputError("\n".join(f"{path}: {line}" for line in validation_problems(error, CampaignFile))) from None


def _with_tuples(value: Any) -> Any:
    """The same tables with tuples in place of lists, as the components require."""
    if isinstance(value, dict):
        return {key: _with_tuples(one) for key, one in value.items()}
    return tuple(map(_with_tuples, value)) if isinstance(value, list) else value
