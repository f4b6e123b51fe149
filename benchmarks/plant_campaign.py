"""Campaigns on the virtual tower, with hidden causes, in the form that `comprope diagnose` reads.

    python benchmarks/plant_campaign.py --out FOLDER --cause bearing_friction [--level 0.5] [--size 12] [--seed 3]
    python benchmarks/plant_campaign.py --out FOLDER --random 1:40 [--jobs 2]
    python benchmarks/plant_campaign.py --list

Campaigns are of the 50 m tower, or of another `--site`. Several `--cause` are hidden together. `--level` goes from 0, barely
visible, to 1, large; `--size` is the first quantity itself. With `--random` each seed has a folder of its own below FOLDER. The
truth is beside the data, in truth.json.
"""

import argparse
import multiprocessing
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path

from plant.campaign import Plan, draw_plan, random_plan, write
from plant.causes import CAUSES
from plant.sites import SITES, TOWER50


def main() -> None:
    """Make what the command line asks for."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default=Path("campaigns"))
    options.add_argument("--site", choices=SITES, default=TOWER50.name)
    options.add_argument("--cause", action="append", choices=sorted(CAUSES))
    options.add_argument("--level", type=float)
    options.add_argument("--size", type=float)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--before", type=float, default=0.0, help="seconds that all goes on before the record begins")
    options.add_argument("--correlation", type=float, default=0.0, help="of the noise from sample to sample")
    options.add_argument("--unstated", action="store_true", help="campaign.toml states no noise")
    options.add_argument("--random", metavar="FIRST:LAST")
    options.add_argument("--jobs", type=int, default=1)
    options.add_argument("--list", action="store_true")
    chosen = options.parse_args()
    site = SITES[chosen.site]
    instruments = {"correlation": chosen.correlation, "stated": not chosen.unstated}
    if chosen.list:
        listed()
    elif chosen.random:
        first, _, last = chosen.random.partition(":")
        seeds = range(int(first), int(last or first) + 1)
        with ProcessPoolExecutor(chosen.jobs, mp_context=multiprocessing.get_context("spawn")) as executor:
            plans = [replace(random_plan(seed, site), **instruments) for seed in seeds]
            folders = [chosen.out / f"{seed:04d}" for seed in seeds]
            for line in executor.map(made, plans, folders):
                print(line, flush=True)
    else:
        plan = draw_plan(chosen.seed, tuple(chosen.cause or ["nothing"]), chosen.level, site)
        plan = replace(plan, before=chosen.before, **instruments)
        print(made(plan if chosen.size is None else sized(plan, chosen.size), chosen.out))


def made(plan: Plan, folder: Path) -> str:
    """Write one campaign; what it is, in one line."""
    write(plan, folder)
    return f"{folder}: {plan.kind} {dict(plan.causes)}"


def sized(plan: Plan, size: float) -> Plan:
    """The plan with the first quantity of its first cause as given."""
    first = next(iter(plan.causes))
    name = next(iter(CAUSES[first].size))
    return replace(plan, level=None, causes={**plan.causes, first: {**plan.causes[first], name: size}})


def listed() -> None:
    """Every cause with what is drawn."""
    for name, cause in CAUSES.items():
        sizes = ", ".join(f"{which} {one.low:g} to {one.high:g}" for which, one in cause.size.items())
        print(f"{cause.kind:10s} {name:22s} {sizes}")


if __name__ == "__main__":
    main()
