"""Clearance of the rope from the shaft's walls during a trip, by height and car position: least, and first touch.

The wall is a plane outside of each side, at a distance from the vertical through the sheave's side, and moves with the building.
Shapes are those of the animation, 20 a second in trips of up to a minute; where the building is at rest the largest displacement
of each side at every communication step counts as well.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import NDArray

from comprope.errors import InputError
from comprope.rope.effects import RopeModel

from ...report.plot_style import label, panels
from ..building_motion.motion import BuildingMotion
from .rope_shapes import DEPTHS, SIDES, Recording

Floats = NDArray[np.float64]

HEIGHTS = 120  # rows of the map
CARS = 60  # columns of the map
SHORTEST_TRAVEL = 0.5  # m of the car, up to which the map has one column
LARGEST = 20.0  # m, as for the effect `shaft_walls`


@dataclass(frozen=True)
class Wall:
    """Outward distance from the vertical through the sheave's side, and heights between which the wall is [m]."""

    distance: float
    bottom: float = -np.inf
    top: float = np.inf


@dataclass(frozen=True)
class Place:
    """A place of the rope in a trip: clearance [m], negative beyond the wall, side, height and car position [m], time [s]."""

    clearance: float
    side: str
    height: float
    car: float
    time: float

    def __str__(self) -> str:
        return (
            f"{1e3 * self.clearance:.0f} mm at {self.height:.1f} m on the {self.side}'s side, car at {self.car:.1f} m, "
            f"{self.time:.2f} s"
        )


@dataclass(frozen=True)
class Clearance:
    """Least clearance of a trip.

    `least` is the nearest place of all, `touch` the first one beyond the wall, None if there is none; `margins` (side, car,
    height) [m] is the least clearance with the car about `cars` [m] at `heights` [m], NaN where there was no rope or is no wall.
    """

    wall: Wall
    least: Place
    touch: Place | None
    cars: Floats
    heights: Floats
    margins: Floats

    def summary(self) -> str:
        """The least clearance, and the first touch."""
        text = f"clearance from a wall at {1e3 * self.wall.distance:g} mm: least {self.least}"
        return f"{text}\nthe rope touches the wall first {self.touch}" if self.touch else text

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each side, car position [m] and height [m] with a rope: `clearance` [m]."""
        side, car, height = np.nonzero(np.isfinite(self.margins))
        return pd.DataFrame(
            {
                "side": np.array(SIDES)[side],
                "car_position": self.cars[car],
                "height": self.heights[height],
                "clearance": self.margins[side, car, height],
            }
        )

    def to_json(self) -> dict[str, Any]:
        """Wall, least clearance and first touch."""
        touch = vars(self.touch) if self.touch else None
        return {"distance": self.wall.distance, "least": vars(self.least), "touch": touch}

    def plot(self) -> Figure:
        """Map of each side's clearance over car position and height; the places of least clearance and of first touch."""
        figure, axes = panels(2, height=4.6)
        shown = 1e3 * self.margins
        span = 1e3 * self.wall.distance
        for one, side, values in zip(axes, SIDES, shown, strict=True):
            mesh = one.pcolormesh(
                self.cars, self.heights, values.T, cmap="RdYlGn", vmin=-span, vmax=span, shading="nearest", rasterized=True
            )
            for place, mark in ((self.least, "o"), (self.touch, "X")):
                if place is not None and place.side == side:
                    one.plot(place.car, place.height, mark, color="black", markersize=6.0)
            label(one, "height of the car [m]", "height in the shaft [m]", f"{side}'s side")
        figure.colorbar(mesh, ax=list(axes), label="least clearance [mm]; dot: least, cross: first touch")
        return figure


def known_wall(model: RopeModel, distance: float | None) -> Wall:
    """The wall at a distance [m], else that of the model's effect; raises `InputError` if there is none, or it is impossible."""
    if distance is not None:
        if not 0.0 < distance <= LARGEST:
            raise InputError(f"wall = {distance:g} m: above 0 to {LARGEST:g} m is accepted")
        return Wall(distance)
    walls = getattr(model.effects, "shaft_walls", None)
    if walls is None:
        raise InputError("clearance: the model has no effects.shaft_walls; the distance of the wall is needed: --wall MM")
    return Wall(walls.distance, walls.bottom, walls.top)


def clearance_of(
    recording: Recording, table: pd.DataFrame, model: RopeModel, wall: Wall, building: BuildingMotion | None = None
) -> Clearance:
    """Least clearance of a recorded trip from a wall; the building moves the wall."""
    times = float(table["time"].iloc[0]) + recording.interval * np.arange(len(recording.frames))
    ends = np.array([frame.ends for frame in recording.frames])
    axles = np.array([frame.axle for frame in recording.frames]) - model.shaft.pit
    heights = ends[:, :, None] + DEPTHS * (axles[:, None, None] - ends[:, :, None])  # (frames, side, points)
    moved = np.array([frame.sides for frame in recording.frames])
    if building is not None:
        for k, time in enumerate(times):
            by = building.displacements(heights[k].ravel(), [float(time)])[0].reshape(heights[k].shape)
            moved[k] -= by * np.array([[-1.0], [1.0]])
    margins = np.where((heights >= wall.bottom) & (heights <= wall.top), wall.distance - moved, np.nan)
    if not np.isfinite(margins).any():
        raise InputError(f"clearance: no rope between {wall.bottom:g} and {wall.top:g} m, where the wall is")
    places = _places(margins, heights, ends[:, 0], np.asarray(times))
    if building is None:
        places += _largest(table, wall)
    touches = [one for one in places if one.clearance < 0.0]
    least, touch = min(places, key=lambda one: one.clearance), min(touches, key=lambda one: one.time, default=None)
    return Clearance(wall, least, touch, *_map(margins, heights, ends[:, 0], model))


def _places(margins: Floats, heights: Floats, cars: Floats, times: Floats) -> list[Place]:
    """The nearest place of each side in each frame (frames, side, points)."""
    found = []
    for k, side in np.ndindex(margins.shape[:2]):
        row = margins[k, side]
        if np.isfinite(row).any():
            at = int(np.nanargmin(row))
            found.append(Place(float(row[at]), SIDES[side], float(heights[k, side, at]), float(cars[k]), float(times[k])))
    return found


def _largest(table: pd.DataFrame, wall: Wall) -> list[Place]:
    """The nearest place and the first touch of each side over all communication steps, by its largest displacement."""
    found = []
    for side in SIDES:
        height, moved = table[f"{side}_side_max_height"], table[f"{side}_side_max_displacement"]
        margin = (wall.distance - moved).where((height >= wall.bottom) & (height <= wall.top))
        known = margin.dropna()
        chosen = [] if known.empty else [known.idxmin(), *known.index[known < 0.0][:1]]
        found += [
            Place(float(margin[k]), side, float(height[k]), float(table["car_position"][k]), float(table["time"][k]))
            for k in chosen
        ]
    return found


def _map(margins: Floats, heights: Floats, cars: Floats, model: RopeModel) -> tuple[Floats, Floats, Floats]:
    """Car positions and heights of the map [m], and the least margin (side, car, height) in each of its cells."""
    low, high = float(cars.min()), float(cars.max())
    count = CARS if high - low > SHORTEST_TRAVEL else 1
    middles = np.linspace(low, high, count) if count > 1 else np.array([0.5 * (low + high)])
    column = np.abs(cars[:, None] - middles).argmin(axis=1)
    grid = np.linspace(-model.shaft.pit, model.shaft.height, HEIGHTS)
    least = np.full((len(SIDES), count, HEIGHTS), np.inf)
    for k, side in np.ndindex(margins.shape[:2]):
        row, at = margins[k, side][::-1], heights[k, side][::-1]  # heights rise
        read = np.interp(grid, at, row, left=np.nan, right=np.nan)
        least[side, column[k]] = np.fmin(least[side, column[k]], read)
    return middles, grid, np.where(np.isfinite(least), least, np.nan)
