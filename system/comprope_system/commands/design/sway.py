"""`comprope sway`: swing of the rope in a swaying building, by car position and period."""

from dataclasses import dataclass
from typing import Annotated

import typer

import comprope_system
from comprope.errors import InputError

from .._parameters import MODEL, SET, ResultFiles, numbers
from .._terminal import progress_display

AMPLITUDE = Annotated[float, typer.Option(metavar="MM", help="Amplitude of the building sway at the top landing.")]
PERIOD = Annotated[float | None, typer.Option(metavar="S", help="Period of the building, for the floors; default any.")]
LIMIT = Annotated[float, typer.Option(metavar="MM", help="Swing above which a floor is to be avoided for parking.")]
FLOORS = Annotated[int, typer.Option(metavar="N", help="Number of equally spaced floors.")]
DURATION = Annotated[float, typer.Option(metavar="S", help="Duration of the sway.")]
DAMPING = Annotated[float, typer.Option(metavar="X", help="Damping ratio of the rope's modes.")]
VERIFY = Annotated[int, typer.Option(metavar="N", help="Cells of the map that the full model simulates as well.")]


BRACKETS = Annotated[
    str | None, typer.Option(metavar="M:MM,...", help="Brackets by height and outward distance: where the rope may catch.")
]
SPEEDS = Annotated[
    str | None, typer.Option(metavar="M/S,...", help="Simulate trips through the shaft at these speeds, with --period.")
]


@dataclass(frozen=True)
class Building:
    """The sway, and what is asked of the rope."""

    amplitude: AMPLITUDE = 50.0
    period: PERIOD = None
    limit: LIMIT = 200.0
    floors: FLOORS = 11
    duration: DURATION = 120.0
    damping: DAMPING = 0.005
    verify: VERIFY = 2
    brackets: BRACKETS = None
    speeds: SPEEDS = None

    @property
    def options(self) -> "comprope_system.SwayOptions":
        """The same in SI units."""
        return comprope_system.SwayOptions(
            1e-3 * self.amplitude, self.period, 1e-3 * self.limit, self.floors, self.duration, self.damping, verify=self.verify,
            brackets=_brackets(self.brackets), speeds=numbers("speeds", self.speeds),
        )  # fmt: skip


def _brackets(text: str | None) -> tuple[tuple[float, float], ...]:
    """Heights and distances [m] of an option such as 60:400,80:350; raises `InputError` for anything else."""
    pairs = [one.split(":") for one in text.split(",")] if text else []
    try:
        return tuple((float(height), 1e-3 * float(distance)) for height, distance in pairs)
    except ValueError:
        raise InputError(f"brackets = {text}: heights in m and distances in mm such as 60:400,80:350 are accepted") from None


def sway(model: MODEL, building: Building, files: ResultFiles, changes: SET = None) -> None:
    """Compute how far the rope of a parked car swings while the building sways: a map over car position and building period.

    Also lists the floors at which no car should be parked. Modes of the linearised rope; the largest cells of the map are
    simulated with the full model as well.
    """
    files.require()
    with progress_display() as progress:
        result = comprope_system.sway(model, building.options, changes=changes, progress=progress)
    files.finish(result)
