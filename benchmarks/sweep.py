"""A sweep of 40 trips on one and on two processes: wall times and their ratio.

    python benchmarks/sweep.py [--runs 40] [--distance 20]

Each run is a trip in the 50 m tower with another sheave. Processes start fresh and load the compiled kernels;
that start is part of the time.
"""

import argparse
import json
import os
import time
from pathlib import Path

from comprope_system.parallel.executors import workers
from comprope_system.parallel.sweep import Case, sweep, values
from comprope_system.presets.paper_installations import TOWER, sheave_changes
from comprope_system.studies.paper.swing import swing, swing_case


def cases(runs: int, distance: float) -> list[Case]:
    """Trips over `distance` [m] with sheaves of 60 to 240 kg."""
    masses = [60.0 + 180.0 * k / max(1, runs - 1) for k in range(runs)]
    return [swing_case(TOWER, distance, sheave_changes(TOWER, mass)) for mass in masses]


def timed(chosen: list[Case], jobs: int) -> tuple[float, list[dict[str, object]]]:
    """Wall time [s] of the sweep in so many processes of its own, and its results."""
    begin = time.perf_counter()
    with workers(jobs, fresh=True) as executor:
        found = values(sweep(swing, chosen, executor))
    return time.perf_counter() - begin, found


def main() -> None:
    """Run, check that both give the same, and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=40)
    parser.add_argument("--distance", type=float, default=20.0, help="m")
    parser.add_argument("--json", type=Path, help="write the times")
    options = parser.parse_args()
    chosen = cases(options.runs, options.distance)
    timed(chosen[:1], 1)  # the kernels are compiled once for a machine
    one, first = timed(chosen, 1)
    two, second = timed(chosen, 2)
    if first != second:
        raise SystemExit("one and two processes differ in their results")
    print(f"{options.runs} trips of {options.distance:g} m; {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    print(f"one process    {one:7.1f} s")
    print(f"two processes  {two:7.1f} s   {one / two:.2f} times as fast")
    if options.json:
        options.json.write_text(json.dumps({"runs": options.runs, "one": one, "two": two, "ratio": one / two}), encoding="utf-8")


if __name__ == "__main__":
    main()
