"""Curves of a page, drawn in the browser by curves.js: panels on one axis, with cursor, zoom and switches."""

import base64
import itertools
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

MEASURED, BEFORE, MODEL = "measured", "before", "model"  # styles of curves; "0", "1" ... are those of equal curves
EQUAL_STYLES = 8  # after which they repeat
MAX_VALUES = 280_000  # in a page: 1.5 MB as text, so that the page stays below 3 MB with a preview
MIN_SAMPLES = 400  # of each curve, however many there are: about one for every second pixel
GAP = 5.0  # intervals of sampling without a sample, above which a curve is interrupted


@dataclass(frozen=True)
class Curve:
    """Values (n,) at the places of its panel, NaN where there is none; `style` is one of those above."""

    name: str
    style: str
    value: Floats


@dataclass(frozen=True)
class Panel:
    """Curves of one quantity over `place` (n,), in the same unit.

    Where one of the curves is measured, the residual (measured less each other curve) is drawn below. `noise` are spans
    (from, to, half width) of the band in which the residual is explained by noise.
    """

    name: str
    unit: str
    place: Floats
    curves: Sequence[Curve]
    detail: str = ""
    noise: Sequence[tuple[float, float, float]] = ()


@dataclass(frozen=True)
class Span:
    """A named part of an axis, such as a phase of the trip; its background is tinted or not."""

    name: str
    start: float
    end: float
    tinted: bool = False


@dataclass(frozen=True)
class Group:
    """Panels on one axis, such as the channels of a run, whose `spans` are the phases of the trip."""

    name: str
    title: str
    panels: Sequence[Panel]
    spans: Sequence[Span] = ()
    shown: bool = True


@dataclass(frozen=True)
class Curves:
    """Groups of panels over a quantity in `unit`; a page draws those that are switched on. `kind` says what the groups are."""

    name: str
    groups: Sequence[Group]
    unit: str = "s"
    kind: str = "runs"
    caption: str = ""

    @cached_property
    def curve_data(self) -> dict[str, Any]:
        """What curves.js draws: numbers as base64 of little-endian 32-bit floats."""
        count = sum(1 + len(panel.curves) for group in self.groups for panel in group.panels)
        most = max(MIN_SAMPLES, MAX_VALUES // max(count, 1))
        groups = [_group(one, most) for one in self.groups]
        return {"unit": self.unit, "kind": self.kind, "groups": groups}

    @property
    def thinned(self) -> bool:
        """Whether a curve has fewer points than samples."""
        return any(panel["thinned"] for group in self.curve_data["groups"] for panel in group["panels"])


def _group(group: Group, most: int) -> dict[str, Any]:
    """A group as JSON, each curve with at most `most` samples."""
    ends = [float(panel.place[k]) for panel in group.panels if len(panel.place) for k in (0, -1)]
    return {
        "name": group.name, "title": group.title, "shown": group.shown, "range": [min(ends, default=0.0), max(ends, default=1.0)],
        "spans": [asdict(one) for one in group.spans], "panels": [_panel(one, most) for one in group.panels],
    }  # fmt: skip


def _panel(panel: Panel, most: int) -> dict[str, Any]:
    place, values = with_gaps(panel.place, [one.value for one in panel.curves])
    kept = thinned(place, values, most)
    curves = [
        {"name": one.name, "style": one.style, "value": encode(value[kept])}
        for one, value in zip(panel.curves, values, strict=True)
    ]
    return {
        "name": panel.name, "unit": panel.unit, "detail": panel.detail, "thinned": len(kept) < len(place),
        "place": encode(place[kept]), "curves": curves, "noise": [list(one) for one in panel.noise],
    }  # fmt: skip


def thinned(place: Floats, values: Sequence[Floats], most: int) -> NDArray[np.int64]:
    """Indices (m,) of about `most` samples of curves (n,): first, last, gaps, and the extremes of each curve in each interval."""
    if len(place) <= most or not values:
        return np.arange(len(place))
    edges = np.linspace(0, len(place), max(most // (2 * len(values)), 1) + 1).astype(int)
    kept = {0, len(place) - 1, *np.flatnonzero(np.isnan(values).all(0)).tolist()}
    for value, (first, last) in itertools.product(values, itertools.pairwise(edges)):
        part = value[first:last]
        if np.isfinite(part).any():
            kept |= {first + int(np.nanargmin(part)), first + int(np.nanargmax(part))}
    return np.array(sorted(kept))


def with_gaps(place: Floats, values: Sequence[Floats]) -> tuple[Floats, list[Floats]]:
    """Curves (n,) with a missing value in each gap of `place` (n,), so that no line is drawn across it."""
    steps = np.diff(place)
    wide = np.flatnonzero(steps > GAP * np.median(steps)) if len(steps) else np.array([], int)
    middles = place[wide] + 0.5 * steps[wide] if len(wide) else np.array([])
    return np.insert(place, wide + 1, middles), [np.insert(np.asarray(one, float), wide + 1, np.nan) for one in values]


def encode(values: Floats) -> str:
    """Base64 of values (n,) as little-endian 32-bit floats: seven digits, NaN for none."""
    return base64.b64encode(np.asarray(values, "<f4").tobytes()).decode()


def decode(text: str) -> Floats:
    """The values (n,) of a text of `encode`."""
    return np.frombuffer(base64.b64decode(text), "<f4").astype(float)
