"""HTML page of one trip: animation, key figures, plots, parameters of the model."""

from collections.abc import Sequence
from pathlib import Path

from comprope.rope.parameters import Base
from comprope.rope.parameters.parameter_vector import DECLARED
from comprope.rope.simulator.rope import values_of

from ....report.page import Animation, Picture, Section, Table, save_page
from ..measured_run import Run
from ..plot import draw_trip
from ..rope_shapes import Recording
from ..trip_simulation import Simulated
from .encoding import animation_data
from .traces import traces

_LEAD = "One trip of {distance:.1f} m in a shaft of {height:g} m with a sheave mass of {mass:g} kg per rope."
_CAPTION = (
    "Left: the shaft; lateral motion is magnified, the distance of the two sides, the size of the sheave and the pit below the"
    " bottom landing are not to scale. A side that the magnification would lead through the sheave is drawn on its rim."
    " The displacement is drawn relative to the static shape for the same car position, or relative to the vertical (dotted),"
    " where a straight, perfectly flexible rope would be. Circles are what sensors measured. Right: the rope around the sheave,"
    " to scale; the vertical motion of the sheave is magnified. Plots: displacement at each sensor, positive outward on either"
    " side; a curve is interrupted while the end of the rope has passed the sensor."
)


def save_trip_page(
    path: Path,
    name: str,
    model: Base,
    trip: Simulated,
    figures: Sequence[tuple[str, str]],
    recording: Recording,
    measured: Run | None = None,
    others: Sequence[Section] = (),
) -> None:
    """Write the page of a simulated trip of the model called `name`, with its key figures and other sections.

    Completely or not at all.
    """
    car = trip.table["car_position"]
    lead = _LEAD.format(distance=float(car.max() - car.min()), height=model.shaft.height, mass=model.sheave.mass_per_rope)
    moving = Animation("trip", animation_data(model, recording.frames, recording.interval, traces(trip, measured)), _CAPTION)
    sections = [
        Section("motion", "Animation", [moving]),
        Section("figures", "Key figures", [Table(("", ""), figures)]),
        Section("curves", "Plots", [Picture("curves", draw_trip(trip, measured))]),
        *others,
        Section("model", "Model parameters", [_model(model)]),
    ]
    source = "simulated with the measured motion of the car" if measured else "simulated"
    save_page(path, f"Trip of a compensation rope, {source}: {name}", lead, sections)


def _model(model: Base) -> Table:
    """All parameters of the model, except those of effects that it does not have."""
    rows = [(name, f"{value:g}", DECLARED[name].unit, DECLARED[name].help) for name, value in values_of(model).items()]
    return Table(("", "value", "unit", ""), rows)
