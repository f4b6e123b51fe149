"""The result of `comprope_system.sway`: a map of swing, floors to avoid, and a comparison with the full model."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from comprope.atomic_files import atomic_write
from comprope.rope.effects import RopeModel

from ...report.page import Block, Picture, Section, Table, save_page
from ...report.plot_style import label, legend, panels
from ...report.result import Result
from ..modal.hanging_string import side_string
from .options import SwayOptions
from .parked_response import SIDES, Floats

LEAD = (
    "Largest displacement of each side relative to the building while it sways and the car is parked: linearised rope from rest, "
    "in a sway of constant amplitude."
)


@dataclass(frozen=True)
class Verified:
    """A car position [m] and period [s]: swing of both sides [m] without damping, linearised and by the full model."""

    car: float
    period: float
    linear: tuple[float, ...]
    full: tuple[float, ...]


@dataclass(frozen=True)
class Bracket:
    """A bracket at a `height` and `distance` [m]: the largest `swing` there [m], with the car at `car` [m], on a `side`.

    `cars` are the car positions [m] at which the swing reaches it, so that the rope may catch behind it.
    """

    height: float
    distance: float
    swing: float
    side: str
    car: float
    cars: tuple[float, ...]

    def __str__(self) -> str:
        at = f"bracket at {self.height:g} m, {1e3 * self.distance:g} mm"
        most = f"swing of up to {1e3 * self.swing:.0f} mm on the {self.side}'s side, car at {self.car:g} m"
        caught = ", ".join(f"{one:.1f}" for one in self.cars)
        return f"{at}: {most}; " + (f"the rope may catch with the car at {caught} m" if self.cars else "not reached")


@dataclass(frozen=True, repr=False)
class SwayResult(Result):
    """Swing (2, cars, periods) [m] of car's and counterweight's side at car positions [m] and periods of the building [s].

    `floors` are pairs of height [m] and largest swing [m] there, in the period of the building that was asked for, or any;
    `brackets` what the swing is at each of them then, and `speeds` a speed [m/s] and the swing [m] up and down at it.
    """

    model_name: str
    model: RopeModel
    options: SwayOptions
    cars: Floats
    periods: Floats
    swing: Floats
    floors: tuple[tuple[float, float], ...]
    verified: tuple[Verified, ...]
    brackets: tuple[Bracket, ...] = ()
    speeds: tuple[tuple[float, float, float], ...] = ()

    @property
    def avoided(self) -> list[float]:
        """Heights of floors [m] at which the swing exceeds the limit."""
        return [height for height, swing in self.floors if swing > self.options.limit]

    def headline(self) -> str:
        """The largest swing, and where."""
        _, i, j = np.unravel_index(int(np.argmax(self.swing)), self.swing.shape)
        return (
            f"{self.model_name}: swing of up to {1e3 * self.swing.max():.0f} mm with the car at {self.cars[i]:g} m and a "
            f"period of {self.periods[j]:.2f} s"
        )

    def summary(self) -> str:
        """The largest swing, floors to avoid for parking, and the full model's swing."""
        options = self.options
        own = f"periods of {options.period or 0.0:g} s ± {100 * options.spread:g} %"
        when = own if options.period else "any period of the map"
        floors = ", ".join(f"{height:.1f}" for height in self.avoided)
        lines = [
            self.headline(),
            f"sway of {1e3 * options.amplitude:g} mm at the top for {options.duration:g} s, damping ratio {options.damping:g}",
            f"parking floors to avoid (more than {1e3 * options.limit:g} mm, {when}): {f'{floors} m' if floors else 'none'}",
        ]
        best, swing = min(self.floors, key=lambda one: one[1])
        lines.append(f"least at the floor at {best:.1f} m: {1e3 * swing:.0f} mm")
        lines += [str(one) for one in self.brackets]
        lines += _speed_lines(self)
        lines += [
            f"full model, car at {one.car:g} m, {one.period:.2f} s, undamped: {_millimetres(one.full)}; linearised "
            f"{_millimetres(one.linear)}"
            for one in self.verified
        ]
        return "\n".join(lines)

    def to_json(self) -> dict[str, Any]:
        """Options, the map [m], floors with their swing [m], and the cells that were verified."""
        return {
            "model": self.model_name, "options": vars(self.options), "cars": self.cars.tolist(), "periods": self.periods.tolist(),
            **{f"{side}_swing": self.swing[k].tolist() for k, side in enumerate(SIDES)},
            "floors": [{"height": height, "swing": swing, "avoid": swing > self.options.limit} for height, swing in self.floors],
            "verified": [vars(one) for one in self.verified], "brackets": [vars(one) for one in self.brackets],
            "speeds": [{"speed": speed, "up": up, "down": down} for speed, up, down in self.speeds],
        }  # fmt: skip

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each car position [m] and period [s]: `car_swing` and `counterweight_swing` [m]."""
        cars, periods = np.meshgrid(self.cars, self.periods, indexing="ij")
        swings = {f"{side}_swing": self.swing[k].ravel() for k, side in enumerate(SIDES)}
        return pd.DataFrame({"car_position": cars.ravel(), "period": periods.ravel()} | swings)

    def to_csv(self, path: str | Path) -> None:
        """Write the map, completely or not at all."""
        with atomic_write(path) as temporary:
            self.to_dataframe().to_csv(temporary, index=False, float_format="%.6g", lineterminator="\n")

    def save_plot(self, path: str | Path) -> None:
        """Write the picture, completely or not at all."""
        with atomic_write(path) as temporary:
            self.plot().savefig(temporary, dpi=150)

    def save_html(self, path: str | Path) -> None:
        """Write the page, completely or not at all."""
        floors = [(f"{height:.1f}", f"{1e3 * one:.0f}", "yes" if one > self.options.limit else "") for height, one in self.floors]
        blocks: list[Block] = [
            self.summary(), Picture("sway", self.plot()),
            Table(("floor at [m]", "largest swing [mm]", "avoid"), floors, "Swing of a car parked at each floor"),
            Table(
                ("car at [m]", "period [s]", "linearised [mm]", "full model [mm]"),
                [(f"{at.car:g}", f"{at.period:.3f}", _millimetres(at.linear), _millimetres(at.full)) for at in self.verified],
                "Largest swing of car's and counterweight's side without damping",
            ),
        ]  # fmt: skip
        if self.brackets:
            rows = [
                (f"{one.height:g}", f"{1e3 * one.distance:g}", f"{1e3 * one.swing:.0f}", one.side, f"{one.car:g}",
                 ", ".join(f"{car:.1f}" for car in one.cars))
                for one in self.brackets
            ]  # fmt: skip
            head = ("bracket at [m]", "distance [mm]", "swing [mm]", "side", "car at [m]", "may catch with the car at [m]")
            blocks.append(Table(head, rows, "Swing at brackets, car parked"))
        if self.speeds:
            trips = [(f"{speed:g}", f"{1e3 * up:.0f}", f"{1e3 * down:.0f}") for speed, up, down in self.speeds]
            blocks.append(Table(("speed [m/s]", "up [mm]", "down [mm]"), trips, "Swing on trips through the shaft, full model"))
        save_page(path, self.headline(), LEAD, [Section("sway", "Swing in a swaying building", blocks)])

    def plot(self) -> Figure:
        """Map of each side's swing over car position and period, with the string's natural periods and the limit."""
        figure, axes = panels(2, height=4.6)
        low = max(1e3 * float(self.swing.min()), 1e-3 * 1e3 * float(self.swing.max()))
        norm = LogNorm(low, 1e3 * float(self.swing.max()))
        for k, (one, side) in enumerate(zip(axes, SIDES, strict=True)):
            shown = np.maximum(1e3 * self.swing[k].T, low)
            mesh = one.pcolormesh(self.cars, self.periods, shown, norm=norm, cmap="viridis", shading="nearest", rasterized=True)
            if self.swing[k].min() < self.options.limit < self.swing[k].max():
                one.contour(self.cars, self.periods, shown, [1e3 * self.options.limit], colors="white", linewidths=1.0)
            for waves, style in ((1, "-"), (2, "--"), (3, ":")):
                own = [side_string(self.model, float(car), side).period(waves) for car in self.cars]
                one.plot(self.cars, own, style, color="#d7191c", linewidth=1.0, label=f"{waves} half wave{'s' * (waves > 1)}")
            if self.options.period:
                one.axhline(self.options.period, color="white", linewidth=0.8)
            one.set_yscale("log")
            one.set_ylim(self.periods[0], self.periods[-1])
            ticks = [1, 2, 3, 5, 7, 10, 15, 20]
            one.set_yticks(ticks, [str(tick) for tick in ticks], minor=False)
            one.minorticks_off()
            one.set_ylim(self.periods[0], self.periods[-1])
            label(one, "height of the parked car [m]", "period of the building [s]", f"{side}'s side")
        legend(axes[0], loc="lower left", labelcolor="white")
        figure.colorbar(mesh, ax=list(axes), label="swing relative to the building [mm]")
        return figure


def _speed_lines(result: SwayResult) -> list[str]:
    """Swing on trips at each speed, and which speeds keep the limit."""
    if not result.speeds:
        return []
    swings = "; ".join(f"{speed:g} m/s {1e3 * max(up, down):.0f} mm" for speed, up, down in result.speeds)
    kept = ", ".join(f"{speed:g}" for speed, up, down in result.speeds if max(up, down) <= result.options.limit)
    return [f"trips through the shaft: {swings}; within {1e3 * result.options.limit:g} mm at {f'{kept} m/s' if kept else 'none'}"]


def _millimetres(values: tuple[float, ...]) -> str:
    return " and ".join(f"{1e3 * one:.1f}" for one in values) + " mm"
