"""Stops of car and counterweight: rise of the sheave, forces and slack, with and without a tie-down; and a picture of one.

    python benchmarks/stops.py [--convergence] [--cost] [--bounce] [--picture FILE.png]

The car moves down at the speed named and is stopped at half height: at 3 m/s2, 1 g and 15 m/s2, or by its safety gear.
"""

import argparse
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import comprope_system
from comprope.rope.model_file import dump, load
from comprope_system import CarMotion, Stop, simulate
from comprope_system.presets import model_path
from comprope_system.simulation.trips.result import SimulationResult
from comprope_system.simulation.trips.rope_shapes import DEPTHS

SPEEDS = (2.5, 6.0, 9.0)
STOPS = {
    "3 m/s2": Stop(deceleration=3.0), "1 g": Stop(deceleration=9.81), "15 m/s2": Stop(deceleration=15.0),
    "safety gear": Stop(safety_gear=True),
}  # fmt: skip
ACCELERATION = 3.0  # m/s2, to reach the speed within the lower shaft
TIE_DOWN = {  # closes at 0.3 m/s; an end stop beyond
    "effects.tie_down.upward_damping": 1e3, "effects.tie_down.locking_damping": 1e5, "effects.end_stops.stiffness": 2e6,
    "effects.end_stops.damping": 2e4, "effects.end_stops.up": 0.1, "effects.end_stops.down": 0.2,
}  # fmt: skip
HEAD = (
    "| model | speed | stop | tie-down | rise mm | sheave force N | largest tension N | least at an end N | slack m | for s "
    "| residual J |"
)


def stopped(preset: str, speed: float, stop: Stop, changes: dict[str, float]) -> SimulationResult:
    """The stop of a car that comes down at a speed [m/s], at half height."""
    height = {"tower50": 50.0, "building200": 200.0}[preset]
    lead = speed**2 / (2.0 * ACCELERATION) + speed * 0.25  # way to the speed
    time = 1.0 + speed / ACCELERATION + 0.5 + (0.5 * height - lead) / speed * 0.5
    origin = 0.5 * height + lead + 0.25 * height - 0.5 * lead
    motion = CarMotion(
        min(origin, height), 0.0, speed, ACCELERATION, 6.0,
        stop=Stop(time, stop.deceleration, stop.safety_gear),
    )  # fmt: skip
    return comprope_system.simulate(preset, motion, changes=changes, duration=time + 4.0, step=0.01)


def row(preset: str, speed: float, name: str, held: bool, changes: dict[str, float] | None = None) -> str:
    """One line of the table."""
    table = stopped(preset, speed, STOPS[name], (TIE_DOWN if held else {}) | (changes or {})).table
    least = min(table["car_end_tension"].min(), table["counterweight_end_tension"].min())
    force = f"{table['sheave_force'].min():.0f} to {table['sheave_force'].max():.0f}"
    cells = (
        preset, f"{speed:g}", name, "yes" if held else "no", f"{1e3 * table['sheave_displacement'].max():.0f}", force,
        f"{table['peak_element_tension'].iloc[-1]:.0f}", f"{least:.0f}", f"{table['slack_length'].max():.0f}",
        f"{table['slack_duration'].iloc[-1]:.2f}", f"{table['energy_residual'].abs().max():.1f}",
    )  # fmt: skip
    return "| " + " | ".join(cells) + " |"


def convergence() -> None:
    """The hardest stop on other meshes and steps, and with other ratios of the stiffness in compression."""
    print(HEAD.replace("model", "change"))
    for changes in ({}, {"rope.element_length": 0.1}, {"rope.element_length": 0.025}, {"solver.step": 0.001},
                    {"rope.compression_ratio": 1e-2}, {"rope.compression_ratio": 3e-4}):  # fmt: skip
        text = ", ".join(f"{key} = {value:g}" for key, value in changes.items()) or "none"
        print(row("building200", 9.0, "15 m/s2", False, changes).replace("building200", text), flush=True)


def cost() -> None:
    """Processor time of a simulated second: a plain trip, walls beside it, a building that moves, stops with slack rope."""
    walls = {"effects.shaft_walls.stiffness": 1e5, "effects.shaft_walls.damping": 100.0, "effects.shaft_walls.distance": 0.5}
    times = np.arange(0.0, 40.0, 0.02)
    sway = 0.02 * np.sin(2.0 * np.pi * times / 5.0) * np.minimum(times / 5.0, 1.0)
    print("| run | tower50: s | ratio | building200: s | ratio |")
    found: dict[str, list[float]] = {}
    for preset, height in (("tower50", 50.0), ("building200", 200.0)):
        with TemporaryDirectory() as folder:
            moving = Path(folder) / "m.toml"
            dump(load(model_path(preset)), moving)
            with moving.open("a", encoding="utf-8") as file:
                file.write(f'[building]\nrecord = "r.csv"\nunit = "m"\ncolumns = ["ground", "top"]\nheights = [-5.0, {height}]\n')
            pd.DataFrame({"time": times, "ground": 0.1 * sway, "top": sway}).to_csv(moving.with_name("r.csv"), index=False)
            trip = CarMotion(0.5 * height, 0.5 * height + 10.0)
            for name, model, changes in (
                ("plain trip", preset, {}), ("plain trip", preset, {}), ("with walls beside the rope", preset, walls),
                ("in a building that moves", moving, {}), ("both", moving, walls),
            ):  # fmt: skip
                begin = process_time()
                simulate(model, trip, changes=changes, duration=10.0)
                found.setdefault(name, []).append((process_time() - begin) / 10.0)
        for name in ("1 g", "safety gear"):
            begin = process_time()
            table = stopped(preset, 6.0, STOPS[name], {}).table
            found.setdefault(f"stop at 6 m/s, {name}", []).append((process_time() - begin) / table["time"].iloc[-1])
    for name, values in found.items():
        costs = values if len(values) == 2 else values[1::2]  # the first plain trip of each loads its kernels
        cells = (f"{one:.3f} | {one / plain:.2f}" for one, plain in zip(costs, found["plain trip"][1::2], strict=True))
        print(f"| {name} | {' | '.join(cells)} |", flush=True)


def bounce() -> None:
    """The safety gear in the tower: rise in the first flight, and the bounce off the rope whose ends the hoist ropes throw up.

    A light mass that comes down at `down` on to a lossless spring whose other end goes up at `ends` leaves at `down + 2 ends`.
    """
    print("| speed | half the gap mm | rise then mm | down m/s | ends up m/s | up m/s | lossless m/s | restitution | rise mm |")
    print("|---|---|---|---|---|---|---|---|---|")
    for speed in SPEEDS:
        table = stopped("tower50", speed, STOPS["safety gear"], {}).table
        seen = table[table["time"] >= table["time"].iloc[-1] - 4.0]
        half = 0.5 * (seen["car_position"] + seen["counterweight_position"] - 50.0).to_numpy()
        rise, rate = seen["sheave_displacement"].to_numpy(), seen["sheave_velocity"].to_numpy()
        most = int(np.argmax(rate))
        least = most - 30 + int(np.argmin(rate[most - 30 : most]))  # rows of 0.01 s: the bounce is over within 0.3 s
        ends = np.gradient(half, 0.01)[least : most + 1].max()
        flight = int(np.argmax(half))
        bound, returned = 2.0 * ends - rate[least], (rate[most] - ends) / (ends - rate[least])
        heights = f"{1e3 * half[flight]:.0f} | {1e3 * rise[: flight + 15].max():.0f}"
        speeds = f"{-rate[least]:.2f} | {ends:.2f} | {rate[most]:.2f} | {bound:.2f} | {returned:.2f}"
        print(f"| {speed:g} | {heights} | {speeds} | {1e3 * rise.max():.0f} |", flush=True)


def picture(path: Path) -> None:
    """Sheave rise, tensions and rope shapes in the hardest stop of the 200 m building."""
    result = stopped("building200", 9.0, STOPS["safety gear"], {})
    table, figure = result.table, Figure(figsize=(11.0, 6.0), layout="constrained")
    grid = figure.add_gridspec(3, 2, width_ratios=(1.4, 1.0))
    top, middle, low = (figure.add_subplot(grid[k, 0]) for k in range(3))
    begin = table["time"].iloc[-1] - 4.0
    seen = table[table["time"] > begin - 0.3]
    time = seen["time"] - begin
    top.plot(time, seen["car_position"] - seen["car_position"].iloc[-1], label="car")
    top.plot(time, seen["counterweight_position"] - seen["counterweight_position"].iloc[-1], label="counterweight")
    top.set_ylabel("from the end [m]")
    middle.plot(time, 1e3 * seen["sheave_displacement"], color="black")
    middle.set_ylabel("sheave rise [mm]")
    low.plot(time, 1e-3 * seen["car_end_tension"], label="car's end")
    low.plot(time, 1e-3 * seen["counterweight_end_tension"], label="counterweight's end")
    low.plot(time, 1e-3 * seen["sheave_force"], color="black", linewidth=0.8, label="sheave")
    low.set(xlabel="time from the stop [s]", ylabel="force [kN]")
    for axes in (top, low):
        axes.legend(frameon=False, fontsize=8)
    _draw_shapes(figure.add_subplot(grid[:, 1]), result, begin)
    figure.suptitle("Car down at 9 m/s, stopped by its safety gear: 200 m building")
    figure.savefig(path, dpi=110)


def _draw_shapes(axes: Axes, result: SimulationResult, begin: float) -> None:
    """The rope before and at some times after the stop, car's side left; lateral positions are enlarged by the axes."""
    for after in (-0.2, 0.8, 1.5, 1.8, 2.5):
        frame = result.recording.frames[round((begin + after) / result.recording.interval)]
        axle = frame.axle - result.model.shaft.pit
        heights = [end + DEPTHS * (axle - end) for end in frame.ends]
        across = [-0.4 - frame.sides[0], 0.4 + frame.sides[1]]
        (line,) = axes.plot(across[0], heights[0], linewidth=1.0, label=f"{after:+.1f} s")
        axes.plot(across[1], heights[1], linewidth=1.0, color=line.get_color())
    axes.set(xlabel="lateral position [m]", ylabel="height [m]")
    axes.legend(frameon=False, fontsize=8, title="after the stop")


def main() -> None:
    """Print the table, or what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--convergence", action="store_true", help="print what mesh and step change instead")
    parser.add_argument("--cost", action="store_true", help="print what slack, walls and a moving building cost instead")
    parser.add_argument("--bounce", action="store_true", help="print the sheave's bounce after a safety gear beside hand values")
    parser.add_argument("--picture", type=Path, help="draw one stop instead")
    options = parser.parse_args()
    if options.picture:
        picture(options.picture)
        return
    for wanted, table in ((options.convergence, convergence), (options.cost, cost), (options.bounce, bounce)):
        if wanted:
            table()
            return
    print(HEAD, "|---|---|---|---|---|---|---|---|---|---|---|", sep="\n")
    for preset in ("tower50", "building200"):
        for speed in SPEEDS:
            for name in STOPS:
                for held in (False, True):
                    print(row(preset, speed, name, held), flush=True)


if __name__ == "__main__":
    main()
