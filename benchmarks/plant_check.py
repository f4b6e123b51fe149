"""The virtual tower beside the library, which it knows nothing of, and beside itself with finer elements.

    python benchmarks/plant_check.py [--site NAME]

Root mean square of differences along whole trips without noise, each displacement from its rest, and processor seconds per ride.
"""

import argparse
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from plant.campaign import Plan, measured, simulate_run, write
from plant.faults import Rows
from plant.sites import SITES, Site

from comprope_system.identification.data.campaign import Campaign, load_campaign
from comprope_system.identification.data.runs import Run
from comprope_system.identification.prediction.replay import replay
from comprope_system.measurements import recover_trip

SOUND: dict[str, dict[str, float]] = {"nothing": {}}
COARSE, USUAL, FINE = (Plan(SOUND, {"element": size}) for size in (0.02, 0.01, 0.005))


def main() -> None:
    """Print both comparisons for each site."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--site", action="append", choices=SITES, help="all without")
    for name in options.parse_args().site or SITES:
        checked(SITES[name])


def checked(site: Site) -> None:
    """Print both comparisons at one site, run by run."""
    coarse, usual, fine = (replace(plan, site=site) for plan in (COARSE, USUAL, FINE))
    with tempfile.TemporaryDirectory() as room:
        write(coarse, Path(room))  # compiles, too
        campaign = load_campaign(room)
    print(f"\n| {site.name} | against | {' | '.join(site.channels)} | CPU s |\n|{'---|' * (len(site.channels) + 3)}")
    for run in campaign.runs:
        rows, spent = driven(usual, run)
        print(line(run, "the library", rows, replayed(site, campaign, run, rows), spent), flush=True)
    run = campaign.runs[-1]
    rows, _ = driven(usual, run)
    for plan, what in ((fine, "elements of 5 mm"), (coarse, "elements of 2 cm")):
        other, spent = driven(plan, run)
        print(line(run, what, rows, other, spent), flush=True)


def driven(plan: Plan, run: Run) -> tuple[Rows, float]:
    """What the plant's channels are, without noise, and the processor time it takes."""
    began = time.process_time()
    true, car = simulate_run(plan, Path(run.file).stem, plan.causes)
    return measured(plan, true, car, plan.causes), time.process_time() - began


def replayed(site: Site, campaign: Campaign, run: Run, rows: Rows) -> Rows:
    """The library's channels for the true motion of the car."""
    trip = recover_trip(rows["time"], rows["car_position"])
    exact = replace(run, time=rows["time"], trip=trip, counterweight=trip.mirrored(campaign.model.shaft.height))
    values = replay(campaign.model, exact, campaign.channels).values
    return {name: channel.scale * values[name] for name, channel in site.channels.items()}


def line(run: Run, what: str, rows: Rows, other: Rows, spent: float) -> str:
    """One comparison, in the units of the files."""
    apart = (f"{np.sqrt(np.nanmean((rows[name] - other[name]) ** 2)):.2g}" for name in other if name in run.values)
    return f"| {Path(run.file).stem} | {what} | {' | '.join(apart)} | {spent:.1f} |"


if __name__ == "__main__":
    main()
