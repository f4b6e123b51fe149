"""Preview of effects in a page: sliders that move curves and errors, computed in the browser by preview.js."""

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .curves import MEASURED, MODEL, Curve, Curves, Floats, Group, Panel, Span, encode, with_gaps

MAX_BYTES = 800_000  # of the data of all previews of a page, as text
FEWEST, MOST = 120, 600  # samples of each curve
LEVELS = 32_000  # of a curve between zero and its largest value; it takes two bytes a sample
MISSING = -32_768
TEXT = 4.0 / 3.0  # characters for each byte in base64


@dataclass(frozen=True)
class PreviewSlider:
    """A parameter in `unit`, with its nodes and the number of the node at its present value."""

    name: str
    unit: str
    nodes: Sequence[float]
    centre: int


@dataclass(frozen=True)
class PreviewPanel:
    """One channel of a run: measured (n,) at `place` (n,), and `data` (nodes * (1 + sliders), n), all in `unit`.

    `form` (data, data) is the matrix of the squared NRMSE (see `identification.preview`), None where that is not defined.
    """

    name: str
    unit: str
    place: Floats
    measured: Floats
    data: Floats
    form: Floats | None
    noise: Sequence[tuple[float, float, float]] = ()


@dataclass(frozen=True)
class PreviewRun:
    """A run with its role, its phases and its channels."""

    file: str
    role: str
    panels: Sequence[PreviewPanel]
    spans: Sequence[Span] = ()
    shown: bool = True


@dataclass(frozen=True)
class PreviewEffect:
    """An effect with its sliders and what the runs would be at their nodes."""

    name: str
    sliders: Sequence[PreviewSlider]
    runs: Sequence[PreviewRun]


@dataclass(frozen=True)
class Preview:
    """Effects, one of which is shown at a time. `errors` are NRMSE by role: (as given, of noise alone)."""

    name: str
    effects: Sequence[PreviewEffect]
    errors: dict[str, tuple[float, float]]
    caption: str = ""

    @cached_property
    def samples(self) -> int:
        """Of each curve, so that the page stays small."""
        rows = sum(len(panel.data) + 2 for effect in self.effects for run in effect.runs for panel in run.panels)
        return int(np.clip(MAX_BYTES / (2.0 * TEXT * max(rows, 1)), FEWEST, MOST))

    @cached_property
    def curves(self) -> Curves:
        """The curves of the first effect at its present values."""
        groups = [
            Group(run.file, f"{run.file} ({run.role})", [self._panel(one) for one in run.panels], run.spans, run.shown)
            for run in self.effects[0].runs
        ]
        return Curves(f"{self.name}_curves", groups)

    def _panel(self, one: PreviewPanel) -> Panel:
        kept = self._kept(one)
        curves = [Curve("measured", MEASURED, one.measured[kept]), Curve("model", MODEL, one.data[0][kept])]
        return Panel(one.name, one.unit, one.place[kept], curves, noise=one.noise)

    def _kept(self, one: PreviewPanel) -> NDArray[np.int64]:
        """The samples of a channel that are drawn: evenly chosen of those at which the first effect is known."""
        known = np.flatnonzero(np.isfinite(one.measured) & np.isfinite(one.data[0]))
        if len(known) <= self.samples:
            return known
        return known[np.unique(np.linspace(0, len(known) - 1, self.samples).round().astype(int))]

    @cached_property
    def preview_data(self) -> dict[str, Any]:
        """What preview.js reads."""
        errors = {role: [_or_none(one) for one in pair] for role, pair in self.errors.items()}
        return {"curves": self.curves.name, "errors": errors, "effects": [self._effect(one) for one in self.effects]}

    def _effect(self, effect: PreviewEffect) -> dict[str, Any]:
        first = self.effects[0]
        places = [[(panel.place, self._kept(panel)) for panel in run.panels] for run in first.runs]
        runs = [
            {"role": run.role, "panels": [_packed(one, *place) for one, place in zip(run.panels, own, strict=True)]}
            for run, own in zip(effect.runs, places, strict=True)
        ]
        sliders = [
            {"name": one.name, "unit": one.unit, "nodes": [float(x) for x in one.nodes], "centre": one.centre}
            for one in effect.sliders
        ]
        return {"name": effect.name, "sliders": sliders, "runs": runs}


def _packed(one: PreviewPanel, place: Floats, kept: NDArray[np.int64]) -> dict[str, Any]:
    """Data of a channel as text: each row as 16-bit integers with a scale, with the same gaps as the curves."""
    _, rows = with_gaps(place[kept], [row[kept] for row in one.data])
    scales = [float(np.nanmax(np.abs(row), initial=0.0)) / LEVELS or 1.0 for row in rows]
    whole = [np.where(np.isfinite(row), np.round(row / scale), MISSING) for row, scale in zip(rows, scales, strict=True)]
    text = base64.b64encode(np.asarray(whole, "<i2").tobytes()).decode()
    return {"data": text, "scales": encode(np.array(scales)), "form": None if one.form is None else _packed_form(one.form)}


def _packed_form(form: Floats) -> str:
    """The upper triangle of a matrix as text: the squared error is a small difference of its terms, so with all digits."""
    return base64.b64encode(form[np.triu_indices(len(form))].astype("<f8").tobytes()).decode()


def _or_none(value: float) -> float | None:
    return value if np.isfinite(value) else None
