"""Effects outside the library, for trials of "none of the known": what the model's effects cannot express.

Each acts on a replay from outside: on the ends' lateral motion, on the end positions, or on the shape
of what is measured.
"""

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from comprope.rope.effects import RopeModel
from comprope_system.identify import replay as replaying
from comprope_system.identify.campaign import Channel, Run

Floats = NDArray[np.float64]


def rail_waves(rng: np.random.Generator, run: Run, grid: Floats, paths: Floats) -> None:
    """Guide rails with 5 m joints push the car sideways, locked to its position."""
    size, shift = rng.uniform(2e-3, 6e-3), rng.uniform(0.0, 5.0)
    _push(paths, 1, grid, size * np.sin(2.0 * np.pi * (run.trip.position(grid) + shift) / 5.0))


def gusts(rng: np.random.Generator, run: Run, grid: Floats, paths: Floats) -> None:
    """Irregular sway of both ends, of no single frequency."""
    amplitudes, rates, phases = rng.uniform(2e-3, 6e-3, 8), rng.uniform(0.1, 1.5, 8), rng.uniform(0.0, 6.3, 8)
    wave = sum(a * np.sin(2.0 * np.pi * r * grid + p) for a, r, p in zip(amplitudes, rates, phases, strict=True))
    for k in (1, 3):
        _push(paths, k, grid, np.asarray(wave))


def hoist_bounce(rng: np.random.Generator, run: Run, grid: Floats, paths: Floats) -> None:
    """The counterweight bounces on its hoist rope, which the car's encoder does not see."""
    size, rate = rng.uniform(2e-3, 6e-3), rng.uniform(1.0, 2.5)
    acceleration = run.trip.acceleration(grid)
    _push(
        paths,
        2,
        grid,
        size
        * np.convolve(acceleration, np.sin(2.0 * np.pi * rate * (grid - grid[0])) * np.exp(-(grid - grid[0])), "full")[
            : len(grid)
        ]
        * 0.06,
    )


STRANGE: dict[str, Callable[[np.random.Generator, Run, Floats, Floats], None]] = {
    one.__name__: one for one in (rail_waves, gusts, hoist_bounce)
}


def _push(paths: Floats, coordinate: int, grid: Floats, shift: Floats) -> None:
    """Add a motion and its derivatives to one coordinate of the ends; it fades in within the first second."""
    fade = np.clip(grid - grid[0], 0.0, 1.0)
    fade = fade**3 * (10.0 - 15.0 * fade + 6.0 * fade**2)
    for k in range(3):
        paths[:, coordinate, k] += fade * shift if k == 0 else _derivative(grid, fade * shift, k)


def _derivative(grid: Floats, values: Floats, order: int) -> Floats:
    for _ in range(order):
        values = np.gradient(values, grid)
    return values


def replayed(
    name: str, rng: np.random.Generator, model: RopeModel, run: Run, channels: Mapping[str, Channel]
) -> dict[str, Floats]:
    """Channels of a run with a strange effect in it."""
    plain = replaying._paths

    def moved(model: RopeModel, run: Run, grid: Floats) -> Floats:
        paths = plain(model, run, grid)
        STRANGE[name](rng, run, grid, paths)
        return paths

    replaying._paths = moved
    try:
        return replaying.replay(model, run, channels, step=0.002).values
    finally:
        replaying._paths = plain
