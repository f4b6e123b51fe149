"""The virtual tower beside the library, which it knows nothing of, and beside itself with finer elements.

    python benchmarks/plant_check.py

Root mean square of differences along whole trips without noise, each displacement from its rest, and processor seconds per ride.
"""

import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from plant.campaign import NOISE, SCALE, Plan, measured, planted, write
from plant.faults import Rows

from comprope_system.identify.campaign import Campaign, Run, load_campaign
from comprope_system.identify.replay import replay
from comprope_system.trips import recover_trip

SOUND: dict[str, dict[str, float]] = {"nothing": {}}
COARSE, USUAL, FINE = (Plan(SOUND, {"element": size}) for size in (0.02, 0.01, 0.005))


def main() -> None:
    """Print both comparisons, run by run."""
    with tempfile.TemporaryDirectory() as room:
        write(COARSE, Path(room))  # compiles, too
        campaign = load_campaign(room)
    print(f"| run | against | {' | '.join(NOISE)} | CPU s |\n|{'---|' * (len(NOISE) + 3)}")
    for run in campaign.runs:
        rows, spent = driven(USUAL, run)
        print(line(run, "the library", rows, replayed(campaign, run, rows), spent), flush=True)
    run = campaign.runs[-1]
    rows, _ = driven(USUAL, run)
    for plan, what in ((FINE, "elements of 5 mm"), (COARSE, "elements of 2 cm")):
        other, spent = driven(plan, run)
        print(line(run, what, rows, other, spent), flush=True)


def driven(plan: Plan, run: Run) -> tuple[Rows, float]:
    """What the plant's channels are, without noise, and the processor time it takes."""
    began = time.process_time()
    true, car = planted(plan, Path(run.file).stem, plan.causes)
    return measured(plan, true, car, plan.causes), time.process_time() - began


def replayed(campaign: Campaign, run: Run, rows: Rows) -> Rows:
    """The library's channels for the true motion of the car."""
    trip = recover_trip(rows["time"], rows["car_position"])
    exact = replace(run, time=rows["time"], trip=trip, counterweight=trip.mirrored(campaign.model.shaft.height))
    return {name: SCALE[name] * values for name, values in replay(campaign.model, exact, campaign.channels).values.items()}


def line(run: Run, what: str, rows: Rows, other: Rows, spent: float) -> str:
    """One comparison, in the units of the files."""
    apart = (f"{np.sqrt(np.nanmean((rows[name] - other[name]) ** 2)):.2g}" for name in NOISE)
    return f"| {Path(run.file).stem} | {what} | {' | '.join(apart)} | {spent:.1f} |"


if __name__ == "__main__":
    main()
