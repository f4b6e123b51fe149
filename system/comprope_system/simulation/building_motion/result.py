"""The result of `comprope_system.building`: a synthetic record, as a table, as a model's `[building]`, and as a picture."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.signal import welch

from comprope.atomic_files import atomic_write
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import dump
from comprope.rope.parameters import Building

from ...report.page import Picture, Section, save_page
from ...report.plot_style import COLOURS, label, legend, panels
from ...report.result import Result
from .spectra import ground_acceleration, wind_force
from .synthetic_record import STEP, Floats, RecordOptions, SyntheticRecord

SEGMENTS = 8  # of a record, for its spectrum
SHOWN = 5.0  # Hz, up to which spectra are drawn
LEAD = "A random motion with a stated spectrum, made by a formula: an example, not a hazard at any site."


@dataclass(frozen=True, repr=False)
class BuildingResult(Result):
    """A synthetic record: `record` has times, heights and displacements, `options` how it was made."""

    model_name: str
    model: RopeModel
    options: RecordOptions
    record: SyntheticRecord

    def headline(self) -> str:
        """Kind, duration and largest displacement."""
        top = self._relative_top
        return f"{self.options.kind} of {self.options.duration:g} s: the top moves by up to {1e3 * np.abs(top).max():.0f} mm"

    def summary(self) -> str:
        """What was made, and how a model takes it."""
        ground = float(np.abs(self.record.ground_acceleration).max())
        periods = " and ".join(f"{one:.3g}" for one in self.options.building.periods)
        return "\n".join(
            (
                f"{self.options.kind}, {self.options.duration:g} s, seed {self.options.seed}; modes of {periods} s",
                f"ground: up to {ground:.3g} m/s2",
                f"top relative to the base: up to {1e3 * np.abs(self._relative_top).max():.1f} mm, rms "
                f"{1e3 * np.std(self._relative_top):.1f} mm",
            )
        )

    @property
    def _relative_top(self) -> Floats:
        return np.asarray(self.record.displacements[:, -1] - self.record.displacements[:, 0])

    def building_table(self, record: str | Path) -> Building:
        """`[building]` of a model for the record in a file."""
        heights = tuple(round(float(one), 6) for one in self.record.heights)
        return Building(record=str(record), columns=self.record.columns, heights=heights)

    def to_csv(self, path: str | Path) -> None:
        """Write the record: `time [s]` and displacements `level_0 [m]` by height, lowest first."""
        with atomic_write(path) as temporary:
            self.to_dataframe().to_csv(temporary, index=False, float_format="%.9g", lineterminator="\n")

    def save_model(self, path: str | Path, record: str | Path) -> None:
        """Write the model with a `[building]` that replays the record in a file."""
        moved = self.model.model_copy(update={"building": self.building_table(Path(record).resolve())})
        dump(moved, path, f"{self.model_name} in a building that moves: {self.headline()}")

    def toml(self, record: str | Path) -> str:
        """`[building]` as text, to be copied into a model file."""
        table = self.building_table(record)
        rows = (("record", table.record), ("columns", table.columns), ("heights", table.heights))
        return "\n".join(("[building]", *(f"{key} = {json.dumps(value)}" for key, value in rows)))

    def to_json(self) -> dict[str, Any]:
        """How the record was made, its heights [m] and its largest values."""
        return {
            "model": self.model_name,
            **vars(self.options),
            "heights": self.record.heights.tolist(),
            "peak_ground_acceleration": float(np.abs(self.record.ground_acceleration).max()),
            "peak_top_displacement": float(np.abs(self._relative_top).max()),
        }

    def to_dataframe(self) -> pd.DataFrame:
        """The record: `time [s]` and a column for each height [m]."""
        return self.record.to_dataframe()

    def save_html(self, path: str | Path) -> None:
        """Write a page with the picture, completely or not at all."""
        save_page(path, self.headline(), LEAD, [Section("record", "Record", [self.summary(), Picture("record", self.plot())])])

    def save_plot(self, path: str | Path) -> None:
        """Write the picture, completely or not at all."""
        with atomic_write(path) as temporary:
            self.plot().savefig(temporary, dpi=150)

    def plot(self) -> Figure:
        """Displacements of ground and top over time, and the spectra of the record beside those that were asked for."""
        figure, (motion, spectrum) = panels(1, 2, height=2.9)
        record, earthquake = self.record, self.options.kind == "earthquake"
        motion.plot(record.times, 1e3 * self._relative_top, color=COLOURS[0], linewidth=0.9, label="top relative to the base")
        if earthquake:
            motion.plot(record.times, 1e3 * record.displacements[:, 0], color=COLOURS[1], linewidth=0.9, label="ground")
        label(motion, "time [s]", "displacement [mm]", self.headline())
        legend(motion)
        shown = record.ground_acceleration if earthquake else self._relative_top
        unit = "(m/s2)2/Hz" if earthquake else "m2/Hz"
        frequency, found = welch(shown, 1.0 / STEP, nperseg=2 * len(shown) // SEGMENTS)
        part = (frequency > 0.0) & (frequency < SHOWN)
        spectrum.loglog(frequency[part], found[part], color=COLOURS[0], linewidth=1.0, label="record")
        target = self.target_spectrum(frequency[part])
        target *= float(np.sum(found[part]) / np.sum(target))
        spectrum.loglog(frequency[part], target, color=COLOURS[1], linewidth=1.3, label="formula, of equal variance")
        what = "acceleration of the ground" if earthquake else "displacement of the top"
        label(spectrum, "frequency [Hz]", f"{what} [{unit}]")
        legend(spectrum)
        return figure

    def target_spectrum(self, frequency: Floats) -> Floats:
        """Spectral density of the formula, up to a factor: of the ground's acceleration, or of the top's displacement in wind."""
        if self.options.kind == "earthquake":
            return ground_acceleration(frequency, self.options.soil_period)
        building, height = self.options.building, float(self.record.heights[-1] - self.record.heights[0])
        gain = sum(np.abs(building.receptance(mode, frequency)) ** 2 for mode in range(len(building.periods)))
        return np.asarray(gain * wind_force(frequency, self.options.speed, self.options.width * height))
