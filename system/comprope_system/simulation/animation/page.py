"""The page of one trip: key figures, the animation, the picture, the model."""

from pathlib import Path

from comprope.rope.parameters import Base
from comprope.rope.runtime.parameter_vector import DECLARED
from comprope.rope.simulator.rope import values_of

from ...report.page import Animation, Picture, Section, Table, save_page
from ..measured_run import Run
from ..plot import draw_trip
from ..trip_simulation import Simulated, summary
from .encoding import film
from .frames import Camera
from .traces import traces

_LEAD = "One trip of {distance:.1f} m in a shaft of {height:g} m, under a sheave of {mass:g} kg for each rope."
_CAPTION = (
    "Left, the whole shaft: lateral motion is magnified; the gap between the sides and the sheave's size are not to scale. "
    "“From rest” shows how far the rope is from where it would hang at rest under a car at the same height, “as it stands” how far "  # noqa: E501
    "from the dotted lines, where a straight, perfectly flexible rope would hang. Right, the rope round the sheave in true "
    "proportion; the sheave's rise and fall is magnified. Curves are as the sensors see the rope: outward is positive on either "
    "side, and a curve stops where the rope's end has passed the sensor."
)


def save_trip_page(path: Path, name: str, model: Base, simulated: Simulated, camera: Camera, measured: Run | None = None) -> None:
    """Write the page of a simulated trip of the model called `name`, whole or not at all."""
    car = simulated.table["car_position"]
    lead = _LEAD.format(distance=float(car.max() - car.min()), height=model.shaft.height, mass=model.sheave.mass)
    moving = Animation("trip", film(model, camera.frames, camera.interval, traces(simulated, measured)), _CAPTION)
    sections = [
        Section("motion", "The trip", [moving]),
        Section("figures", "Key figures", [Table(("", ""), summary(simulated))]),
        Section("curves", "The curves", [Picture("curves", draw_trip(simulated, measured))]),
        Section("model", "The model", [_model(model)]),
    ]
    save_page(path, f"Compensation rope: {name}", lead, sections)


def _model(model: Base) -> Table:
    """Every value of the model but for effects that it does not have."""
    rows = [(name, f"{value:g}", DECLARED[name].unit, DECLARED[name].help) for name, value in values_of(model).items()]
    return Table(("", "value", "unit", ""), rows)
