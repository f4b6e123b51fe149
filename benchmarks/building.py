"""Checks of buildings that move, stated against obtained: `python benchmarks/building.py`."""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

import numpy as np
import pandas as pd

import comprope_system
from comprope.rope.model_file import dump, load
from comprope.rope.simulator.rope import CompensationRope
from comprope_system.presets import model_path
from comprope_system.vibration.modal.hanging_string import side_string
from comprope_system.vibration.sway_operation.full_simulation import simulated_amplitudes
from comprope_system.vibration.sway_operation.parked_response import Sway, parked_rope

LAST, STEP = 8.0, 0.02
TIMES = np.arange(0.0, LAST + 1.0, STEP)
TOWER = load(model_path("tower50"))


def trip(columns: dict[str, np.ndarray] | None, shapes: str = "") -> tuple[pd.DataFrame, float]:
    """A trip from 10 to 20 m in a building with a record, or at rest, and its processor time [s]."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "m.toml"
        dump(TOWER, path)
        if columns:
            heights = "[-1.5, 50.0]" if not shapes else "[-1.5, 25.0, 50.0]"
            with path.open("a", encoding="utf-8") as file:
                file.write(f'[building]\nrecord = "r.csv"\nunit = "m"\ncolumns = {list(columns)}\nheights = {heights}\n{shapes}')
            pd.DataFrame({"time": TIMES} | columns).to_csv(path.with_name("r.csv"), index=False)
        begin = process_time()
        table = comprope_system.simulate(path, comprope_system.CarMotion(10.0, 20.0), duration=LAST).table
        return table, process_time() - begin


def largest(table: pd.DataFrame, other: pd.DataFrame) -> float:
    """Largest difference of any sensor [m]."""
    return max(float(np.nanmax(np.abs(table[name] - other[name]))) for name in (one.name for one in TOWER.sensors))


def rise(out: float) -> tuple[float, float]:
    """Rise of the sheave with both ends aside by a distance [m], and half the excess of arc by the string's formula [m]."""
    found = []
    for aside in (0.0, out):
        rope = CompensationRope(TOWER)
        rope.solve_equilibrium(35.0, 15.0, (-aside, aside))
        found.append(rope.sheave()["sheave_displacement"])
    c = 0.5 * TOWER.sheave.mass_per_rope / TOWER.rope.mass_per_length
    excess = sum(0.5 * (out / np.log1p(L / c)) ** 2 * (1.0 / c - 1.0 / (c + L)) for L in (36.5, 16.5))
    return found[1] - found[0], 0.5 * excess


def main() -> None:
    """Print the checks as rows of a table."""
    zero, ramp = np.zeros(len(TIMES)), 0.5 * (1.0 - np.cos(np.pi * np.minimum(TIMES / 2.0, 1.0)))
    trip(None)  # loads the kernels
    plain, cost = trip(None)
    none, _ = trip({"ground": zero, "top": zero})
    rigid, _ = trip({"ground": 1.7 + 0.3 * TIMES, "top": 1.7 + 0.3 * TIMES})
    first, second = (a * ramp * np.sin(2.0 * np.pi * TIMES / T) for a, T in ((2e-3, 2.5), (1e-3, 0.8)))
    shapes = "shapes = [[0.0, 0.4, 1.0], [0.0, 1.0, -0.6]]\n"
    one, other, both = (trip({"a": a, "b": b}, shapes)[0] for a, b in ((first, zero), (zero, second), (first, second)))
    swayed, moved = trip({"ground": 0.3 * ramp * np.sin(2.0 * np.pi * TIMES / 4.0), "top": 50.0 * first})
    names = [one.name for one in TOWER.sensors]
    sum_of_both = one[names] + other[names] - plain[names]
    up, by_hand = rise(0.4)
    sway, period = Sway(2e-4, 20.0, 0.0), side_string(TOWER, 30.0, "counterweight").period()
    added = largest(both, sum_of_both) / largest(both, plain)
    linear, full = parked_rope(TOWER, 30.0).amplitudes(sway, period)[1], simulated_amplitudes(TOWER, 30.0, sway, period)[1]
    for name, stated, found in (
        ("record of zeros: largest difference from a building at rest", "0", f"{largest(none, plain):g} m"),
        ("rigid building, 1.7 m aside and 0.3 m/s", "0", f"{largest(rigid, plain):.1e} m"),
        (
            "two modes at once less the sum of each, of 2 and 1 mm",
            "0",
            f"{added:.1e}",
        ),
        ("rise of the sheave, ends aside by 0.4 m", f"{1e3 * by_hand:.3f} mm", f"{1e3 * up:.3f} mm"),
        ("swing of a parked car in resonance, 20 s", f"{1e3 * linear:.2f} mm", f"{1e3 * full:.2f} mm"),
        ("energy residual, ground 0.3 m and top 0.1 m", "0", f"{swayed['energy_residual'].abs().max():.2g} J"),
        ("processor time of a trip of 8 s, building at rest and moving", f"{cost:.2f} s", f"{moved:.2f} s"),
    ):
        sys.stdout.write(f"| {name} | {stated} | {found} |\n")


if __name__ == "__main__":
    main()
