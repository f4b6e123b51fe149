"""Preview of effects in a page: sliders that move curves and errors, computed in the browser by preview.js."""

import base64
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .curves import Curves, Floats, Group, Panel, encode, with_gaps

MAX_BYTES = 500_000  # of the data of all previews of a page, as text
FEWEST, MOST = 120, 600  # samples of each curve
LEVELS = 32_000  # of a curve between zero and its largest value; it takes two bytes a sample
MISSING = -32_768
BYTES = 2.0 * 4.0 / 3.0  # of a sample as text in base64


@dataclass(frozen=True)
class PreviewSlider:
    """A parameter in `unit`, with its nodes and the number of the node at its present value."""

    name: str
    unit: str
    nodes: Sequence[float]
    centre: int


@dataclass(frozen=True)
class Response:
    """What a channel would be at the nodes: `data` (nodes * (1 + sliders), n) at the places and in the unit of its panel.

    `form` (data, data) is the matrix of the squared NRMSE (see `identification.preview`), None where that is not defined.
    """

    data: Floats
    form: Floats | None


@dataclass(frozen=True)
class PreviewRun:
    """A run with its role: channels as measured and at the present values, and the response of each."""

    group: Group
    role: str
    responses: Sequence[Response]


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
    def drawn(self) -> list[int]:
        """Numbers of the runs whose curves are drawn, so that the page stays small: the one shown first, then the others."""
        order = sorted(range(len(self.effects[0].runs)), key=lambda k: not self.effects[0].runs[k].group.shown)
        sizes = np.cumsum([FEWEST * self._rows(k) * BYTES for k in order])
        return sorted(order[: max(1, int(np.searchsorted(sizes, MAX_BYTES, "right")))])

    @cached_property
    def samples(self) -> int:
        """Of each curve that is drawn."""
        rows = sum(self._rows(k) for k in self.drawn)
        return int(np.clip(MAX_BYTES / (BYTES * max(rows, 1)), FEWEST, MOST))

    def _rows(self, k: int) -> int:
        """Rows of data of a run, of all effects together, with those of its own curves, which take twice as much."""
        own = 6 * len(self.effects[0].runs[k].responses)
        return own + sum(len(one.data) for effect in self.effects for one in effect.runs[k].responses)

    @cached_property
    def curves(self) -> Curves:
        """The curves of the first effect at its present values."""
        drawn = [self.effects[0].runs[k].group for k in self.drawn]
        groups = [replace(one, panels=[self._thinned(panel) for panel in one.panels]) for one in drawn]
        return Curves(f"{self.name}_curves", groups, caption=self._left_out())

    def _left_out(self) -> str:
        """Which runs are not drawn."""
        files = [run.group.name for k, run in enumerate(self.effects[0].runs) if k not in self.drawn]
        return f"Not drawn, so that the page stays small, but part of the errors: {', '.join(files)}." if files else ""

    def _thinned(self, one: Panel) -> Panel:
        """A channel with the samples that are drawn."""
        kept = self._kept(one)
        curves = [replace(curve, value=curve.value[kept]) for curve in one.curves]
        return replace(one, place=one.place[kept], curves=curves)

    def _kept(self, one: Panel) -> NDArray[np.int64]:
        """The samples of a channel that are drawn: evenly chosen of those at which all its curves are known."""
        known = np.flatnonzero(np.isfinite([curve.value for curve in one.curves]).all(0))
        if len(known) <= self.samples:
            return known
        return known[np.unique(np.linspace(0, len(known) - 1, self.samples).round().astype(int))]

    @cached_property
    def preview_data(self) -> dict[str, Any]:
        """What preview.js reads."""
        errors = {role: [_or_none(one) for one in pair] for role, pair in self.errors.items()}
        return {"curves": self.curves.name, "errors": errors, "effects": [self._effect(one) for one in self.effects]}

    def _effect(self, effect: PreviewEffect) -> dict[str, Any]:
        runs = []
        for k, (run, first) in enumerate(zip(effect.runs, self.effects[0].runs, strict=True)):
            drawn = k in self.drawn
            panels = [
                _packed(one, panel.place, self._kept(panel) if drawn else None)
                for one, panel in zip(run.responses, first.group.panels, strict=True)
            ]
            runs.append({"role": run.role, "drawn": drawn, "panels": panels})
        sliders = [
            {"name": one.name, "unit": one.unit, "nodes": [float(x) for x in one.nodes], "centre": one.centre}
            for one in effect.sliders
        ]
        return {"name": effect.name, "sliders": sliders, "runs": runs}


def _packed(one: Response, place: Floats, kept: NDArray[np.int64] | None) -> dict[str, Any]:
    """Data of a channel as text, none if not drawn: each row as 16-bit integers with a scale, and the gaps of the curves."""
    form = None if one.form is None else _packed_form(one.form)
    if kept is None:
        return {"form": form}
    _, rows = with_gaps(place[kept], [row[kept] for row in one.data])
    scales = [float(np.nanmax(np.abs(row), initial=0.0)) / LEVELS or 1.0 for row in rows]
    whole = [np.where(np.isfinite(row), np.round(row / scale), MISSING) for row, scale in zip(rows, scales, strict=True)]
    text = base64.b64encode(np.asarray(whole, "<i2").tobytes()).decode()
    return {"data": text, "scales": encode(np.array(scales)), "form": form}


def _packed_form(form: Floats) -> str:
    """The upper triangle of a matrix as text: the squared error is a small difference of its terms, so with all digits."""
    return base64.b64encode(form[np.triu_indices(len(form))].astype("<f8").tobytes()).decode()


def _or_none(value: float) -> float | None:
    return value if np.isfinite(value) else None
