"""The public function `comprope_system.sway`: swing of the rope in a swaying building by car position and period."""

import numpy as np

from comprope.rope.effects import RopeModel

from ...parallel.progress import Progress, no_progress
from ...presets.inputs import ModelInput, model_name, read_model, require_still_building
from ...presets.overrides import Changes
from ..modal.hanging_string import side_string
from .full_simulation import simulated_amplitudes
from .options import SwayOptions
from .parked_response import SIDES, ParkedRope, Sway, parked_rope
from .result import Bracket, SwayResult, Verified
from .travelling_response import travelling_swing

__all__ = ["SwayOptions", "sway"]
SAME = 1e-5  # m or s, up to which heights and periods are equal
BELOW, ABOVE = 0.25, 1.4  # of the rope's shortest and longest first period: the periods of the map


def sway(
    model: ModelInput, options: SwayOptions | None = None, *, changes: Changes | None = None, progress: Progress = no_progress
) -> SwayResult:
    """Compute how far both sides of the rope swing while the building sways and the car is parked.

    `model` is a model file, a preset's name or a `RopeModel`; `changes` are values by key. Raises `InputError` for bad input,
    `SimulationError` where no static equilibrium is found.
    """
    options = options or SwayOptions()
    given = require_still_building(read_model(model, changes), "the map of sway")
    cars, periods = _grid(given, options)
    beside = list[np.ndarray]()
    found, heights, floors = np.zeros((2, len(cars), len(periods))), _floors(given, options), list[tuple[float, float]]()
    for i, car in enumerate(cars):
        parked = parked_rope(given, float(car))
        found[:, i] = np.array([parked.amplitudes(options.sway, float(period)) for period in periods]).T
        if np.abs(heights - car).min() < SAME:
            floors.append((float(car), _floor_swing(parked, options, periods, found[:, i])))
        progress("positions of the car", i + 1, len(cars))
        beside.append(_beside(parked, options, periods))
    verified = tuple(_verified(given, options, cars, periods, found, progress))
    speeds = [(speed, *travelling_swing(given, options.sway, options.period or 0.0, speed).tolist()) for speed in options.speeds]
    return SwayResult(
        model_name(model), given, options, cars, periods, found, tuple(floors), verified,
        _brackets(options, cars, np.array(beside)), tuple(speeds),
    )  # fmt: skip


def _floors(model: RopeModel, options: SwayOptions) -> np.ndarray:
    """Heights of the floors [m]."""
    return np.linspace(0.0, model.shaft.height, options.floors)


def _floor_swing(parked: ParkedRope, options: SwayOptions, periods: np.ndarray, swing: np.ndarray) -> float:
    """Largest swing [m] in the building's periods that count, the rope's own among them, as these are narrow."""
    low, high = _range(options, periods)
    kept = (periods >= low - SAME) & (periods <= high + SAME)
    resonant = [parked.amplitudes(options.sway, float(one)).max() for one in _own(parked, low, high)]
    return float(max([swing[:, kept].max(), *resonant]))


def _range(options: SwayOptions, periods: np.ndarray) -> tuple[float, float]:
    """Least and largest period [s] that count."""
    if options.period is None:
        return float(periods[0]), float(periods[-1])
    return options.period * (1.0 - options.spread), options.period * (1.0 + options.spread)


def _own(parked: ParkedRope, low: float, high: float) -> list[float]:
    """Natural periods of the rope in a range [s]."""
    return [float(one) for one in 2.0 * np.pi / parked.rates if low <= one <= high]


def _beside(parked: ParkedRope, options: SwayOptions, periods: np.ndarray) -> np.ndarray:
    """Largest swing [m] of both sides at each bracket (2, brackets) in the periods that count, the rope's own among them."""
    if not options.brackets:
        return np.zeros((2, 0))
    low, high = _range(options, periods)
    counted = [*(float(one) for one in periods if low - SAME <= one <= high + SAME), *_own(parked, low, high)]
    heights = np.array([height for height, _ in options.brackets])
    return np.max([parked.at_heights(options.sway, one, heights) for one in counted], axis=0)


def _brackets(options: SwayOptions, cars: np.ndarray, swings: np.ndarray) -> tuple[Bracket, ...]:
    """What the swing (cars, 2, brackets) [m] is at each bracket, and the car positions at which it is reached."""
    found = []
    for k, (height, distance) in enumerate(options.brackets):
        at = swings[:, :, k]
        i, side = (int(one) for one in np.unravel_index(int(at.argmax()), at.shape))
        reached = tuple(float(car) for car in cars[at.max(axis=1) >= distance])
        found.append(Bracket(height, distance, float(at[i, side]), SIDES[side], float(cars[i]), reached))
    return tuple(found)


def _grid(model: RopeModel, options: SwayOptions) -> tuple[np.ndarray, np.ndarray]:
    """Car positions [m], floors among them, and periods [s] of the map."""
    height = model.shaft.height
    between = np.linspace(0.0, height, options.positions)
    cars = np.unique(np.concatenate([_floors(model, options), between]).round(6))
    firsts = [side_string(model, at, "counterweight").period() for at in (0.0, height)]
    periods = np.geomspace(BELOW * max(firsts), ABOVE * max(firsts), options.periods)
    if options.period is not None:
        own = options.period * np.linspace(1.0 - options.spread, 1.0 + options.spread, 5)
        periods = np.unique(np.concatenate([periods, own]).round(6))
    return cars, periods


def _verified(
    model: RopeModel, options: SwayOptions, cars: np.ndarray, periods: np.ndarray, found: np.ndarray, progress: Progress
) -> list[Verified]:
    """The cells with the largest swing, in different quarters of the car's travel, by the full model and without damping."""
    still, taken = Sway(options.amplitude, options.duration, 0.0), list[Verified]()
    worst = found.max(axis=0)
    for place in np.argsort(worst, axis=None)[::-1]:
        if len(taken) == options.verify:
            break
        i, j = (int(k) for k in np.unravel_index(place, worst.shape))
        car, period = float(cars[i]), float(periods[j])
        if any(abs(one.car - car) < 0.25 * model.shaft.height for one in taken):
            continue
        linear = parked_rope(model, car).amplitudes(still, period)
        taken.append(Verified(car, period, tuple(linear), tuple(simulated_amplitudes(model, car, still, period))))
        progress("full model", len(taken), options.verify)
    return taken
