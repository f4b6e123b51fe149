"""The result of `comprope_system.modes`: natural periods and mode shapes, with summary, table, plot and HTML page."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comprope.atomic_files import atomic_write
from comprope.rope.parameters import Base

from ...report.page import Block, Picture, Section, Table, save_page
from ...report.plot_style import COLOURS, label, legend, panels
from ...report.result import Result
from .hanging_string import side_string
from .modes import Mode, Modes
from .sheave_resonance import SheaveResonances

SHOWN = 6  # shapes in the picture
POINTS = 400  # of a shape in JSON, about
HEAD = ("period [s]", "frequency [Hz]", "place", "half waves", "string [s]")
LEAD = (
    "Small vibration about the static equilibrium: the rope sticks to a sheave that is free to turn and to rise. Beside each "
    "lateral mode is the period of an ideal hanging string of the same length and tension."
)


@dataclass(frozen=True, repr=False)
class ModesResult(Result, Modes):
    """Natural modes by falling period with the car at `car` [m]; `heights` (n,) [m] are those of the shapes' points at rest.

    `sheave` has the frequencies [Hz] of its bounce and its rotation.
    Each of `modes` has `period` [s], `frequency` [Hz], `place`, `half_waves` and `shape` (n + 1, 2).
    """

    model: Base
    model_name: str
    sheave: SheaveResonances

    def string_period(self, mode: Mode) -> float | None:
        """The hanging string's period [s] for a lateral mode; None for one along the rope."""
        return side_string(self.model, self.car, mode.place).period(mode.half_waves) if mode.half_waves else None

    def headline(self) -> str:
        """Number of modes, and the longest period [s]."""
        slowest = max(one.period for one in self.modes)
        return f"{len(self.modes)} natural modes, the slowest of {slowest:.4f} s, with the car at {self.car:g} m"

    def summary(self) -> str:
        """The modes as a table, longest period first."""
        lines = [f"{HEAD[0]:>11}  {HEAD[1]:>14}  {HEAD[2]:<14}  {HEAD[3]:>10}  {HEAD[4]:>10}"]
        lines += [
            f"{period:>11}  {frequency:>14}  {place:<14}  {waves:>10}  {string:>10}"
            for period, frequency, place, waves, string in self._rows()
        ]
        lines += [f"sheave's {name}: {text}" for name, text in self._resonances()]
        return "\n".join(lines)

    def _resonances(self) -> list[tuple[str, str]]:
        found = {"bounce": self.sheave.bounce, "rotation": self.sheave.rotation}
        return [(name, "none" if value is None else f"{value:.2f} Hz") for name, value in found.items()]

    def to_json(self) -> dict[str, Any]:
        """Periods [s], frequencies [Hz] and shapes; heights [m] are those of the shapes' points."""
        points = slice(None, None, max(1, len(self.heights) // POINTS))
        return {
            "car_position": self.car,
            "heights": self.heights[points].tolist(),
            "sheave_bounce": self.sheave.bounce,
            "sheave_rotation": self.sheave.rotation,
            "modes": [
                {
                    "period": mode.period, "frequency": mode.frequency, "place": mode.place, "half_waves": mode.half_waves,
                    "string_period": self.string_period(mode), "lateral_shape": mode.shape[:-1, 1][points].tolist(),
                }
                for mode in self.modes
            ],
        }  # fmt: skip

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each mode: period [s], frequency [Hz], place, half waves, period of the hanging string [s]."""
        rows = [(one.period, one.frequency, one.place, one.half_waves, self.string_period(one)) for one in self.modes]
        return pd.DataFrame(rows, columns=["period", "frequency", "place", "half_waves", "string_period"])

    def save_html(self, path: str | Path) -> None:
        """Write an HTML page with table and mode shapes, completely or not at all."""
        title = f"{self.model_name}: natural modes, car at {self.car:g} m"
        resonances = Table(("sheave", "largest mobility at"), self._resonances())
        blocks: list[Block] = [Table(HEAD, self._rows()), resonances, Picture("modes", self.plot())]
        save_page(path, title, LEAD, [Section("modes", "Natural modes", blocks)])

    def save_plot(self, path: str | Path) -> None:
        """Write the plot of the mode shapes as .png, .pdf or .svg, completely or not at all."""
        with atomic_write(path) as temporary:
            self.plot().savefig(temporary, dpi=150)

    def plot(self) -> Figure:
        """Figure of the lateral mode shapes of longest period, car side on the left."""
        figure, axes = panels(2, height=4.2)
        axes[1].sharey(axes[0])  # the same height stands at the same place in both
        lowest = int(np.argmin(self.heights))
        sides = {"car": slice(0, lowest), "counterweight": slice(lowest, None)}
        for one, (side, nodes) in zip(axes, sides.items(), strict=True):
            shown = [mode for mode in self.modes if mode.place in (side, "both")][:SHOWN]
            for k, mode in enumerate(shown):
                one.plot(mode.shape[:-1, 1][nodes], self.heights[nodes], color=COLOURS[k], label=f"{mode.period:.3f} s")
            label(one, "lateral displacement, largest 1", "height [m]", f"{side}'s side, car at {self.car:g} m")
            if shown:
                legend(one, loc="center left", bbox_to_anchor=(1.0, 0.5))
        return figure

    def _rows(self) -> list[tuple[str, str, str, str, str]]:
        rows = []
        for mode in self.modes:
            string = self.string_period(mode)
            waves, text = (str(mode.half_waves), f"{string:.4f}") if string else ("", "")
            rows.append((f"{mode.period:.4f}", f"{mode.frequency:.4f}", mode.place, waves, text))
        return rows
