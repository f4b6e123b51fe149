"""The result of `comprope_system.simulate`: one trip as a table, with summary, plot and HTML page."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd

from comprope.atomic_files import atomic_write
from comprope.errors import InputError
from comprope.rope.effects import RopeModel

from ...report.json_output import plain
from ...report.page import Picture, Section
from ...report.result import Result
from ..building_motion.motion import BuildingMotion
from .clearance import Clearance, clearance_of, known_wall
from .measured_run import Run
from .rope_shapes import Recording, rest_displacements
from .trip_simulation import Simulated, summary, travel


@dataclass(frozen=True, repr=False)
class SimulationResult(Result, Simulated):
    """One simulated trip.

    `table` has a column `time` [s] and those that `columns` describes with unit and meaning; cells are NaN where a rope end has
    passed the sensor. `sensors` are the names of the model's sensors, `model` is the model with its changes, `measured` the run
    that the car followed. `remarks` are about the motion. `recording` holds the rope's shapes, which FMUs do not show. `building`
    is the motion of the building, None if it is at rest.
    """

    model: RopeModel
    model_name: str
    measured: Run | None
    recording: Recording | None
    remarks: tuple[str, ...] = ()
    building: BuildingMotion | None = None

    def headline(self) -> str:
        """Start and end of the car's motion, and the simulated time."""
        return f"{self.model_name}: the car from {travel(self.table)}, {self.table['time'].iloc[-1]:.2f} s simulated"

    @cached_property
    def key_figures(self) -> list[tuple[str, str]]:
        """Names and texts: duration, swings about the shape at rest, forces, accuracy."""
        ends = (self.table[f"{side}_position"].to_numpy(float) for side in ("car", "counterweight"))
        return summary(self, dict(zip(self.sensors, rest_displacements(self.model, *ends), strict=True)))

    def summary(self) -> str:
        """Key figures of the trip, one per line, and remarks about a measured motion."""
        lines = self.key_figures
        width = max(len(name) for name, _ in lines)
        remarks = (*self.remarks, *(self.measured.remarks if self.measured else ()))
        return "\n".join((*(f"{name:<{width}}  {text}" for name, text in lines), *(f"note: {remark}" for remark in remarks)))

    def to_json(self) -> dict[str, Any]:
        """Key figures, the columns with their units, and the table as lists, in SI units."""
        return {
            "model": self.model_name,
            "sensors": list(self.sensors),
            "key_figures": dict(self.key_figures),
            "remarks": [*self.remarks, *(self.measured.remarks if self.measured else ())],
            "units": {"time": "s"} | {one.name: one.unit for one in self.columns},
            "table": plain({name: self.table[name].to_numpy() for name in self.table}),
        }

    def to_dataframe(self) -> pd.DataFrame:
        """The table (n, columns): one row for each communication step."""
        return self.table

    def clearance(self, wall: float | None = None) -> Clearance:
        """Clearance from a wall at an outward distance [m] of both sides, by default that of the model's effect `shaft_walls`.

        Raises `InputError` without a wall, or if the rope was an FMU, which does not output its shape.
        """
        if self.recording is None:
            raise InputError("fmu = True: the clearance needs the rope's shape, which an FMU does not output; False is accepted")
        return clearance_of(self.recording, self.table, self.model, known_wall(self.model, wall), self.building)

    def save_clearance(self, path: str | Path, wall: float | None = None) -> None:
        """Write the map of the clearance as .png, .pdf or .svg, completely or not at all."""
        figure = self.clearance(wall).plot()
        with atomic_write(path) as temporary:
            figure.savefig(temporary, dpi=150)

    def save_html(self, path: str | Path, wall: float | None = None) -> None:
        """Write an HTML page with an animation, and the clearance from a wall at a distance [m], or from that of the model.

        Raises `InputError` if the rope was an FMU, which does not output its shape.
        """
        from .animation.page import save_trip_page

        if self.recording is None:
            raise InputError("fmu = True: the page needs the rope's shape, which an FMU does not output; fmu = False is accepted")
        others = []
        if wall is not None or getattr(self.model.effects, "shaft_walls", None) is not None:
            found = self.clearance(wall)
            others.append(Section("clearance", "Clearance", [found.summary(), Picture("clearance", found.plot())]))
        save_trip_page(Path(path), self.model_name, self.model, self, self.key_figures, self.recording, self.measured, others)

    def save_plot(self, path: str | Path) -> None:
        """Write the plot of the trip as .png, .pdf or .svg, completely or not at all."""
        from .plot import save_trip

        save_trip(Path(path), self, self.measured)
