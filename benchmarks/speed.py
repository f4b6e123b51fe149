"""Processor time of whole trips, of one Newton iteration beside its limit, and how both grow with the rope.

    python benchmarks/speed.py [--runs 3]

Of several runs the fastest counts. The limit is what plain C needs, in the same process, for the linear
algebra alone of one iteration at the same number of nodes (see limit.py); needs gcc.
"""

import argparse

import numpy as np
from cases import Cost, model, ride, trip
from limit import microseconds

from comprope.rope.parameters import DEFAULT_STEP

TRIPS = {  # name: preset, origin, destination [m], until [s]
    "50 m tower, 45 m": ("tower50", 2.0, 47.0, 24.0),
    "200 m building, 200 m": ("building200", 0.0, 200.0, 34.0),
}
NODES = (500, 1000, 2000, 4000, 8000)
HEAD = f"{'':28}{'nodes':>6}{'step ms':>9}{'CPU s/s':>9}{'iter/step':>10}{'us/iter':>9}{'limit us':>9}{'ratio':>7}"


def best(preset: str, origin: float, destination: float, until: float, runs: int, **changes: float) -> Cost:
    """The cheapest of several equal runs."""
    chosen = model(preset, **changes)
    return min((ride(chosen, trip(preset, origin, destination), until)[1] for _ in range(runs)), key=lambda cost: cost.cpu)


def row(name: str, step: float, cost: Cost) -> str:
    """One line of the table: the cost of a run beside the limit at its number of nodes."""
    limit = microseconds(cost.nodes)
    numbers = f"{cost.nodes:6}{1e3 * step:9.1f}{cost.per_second:9.4f}{cost.newton / cost.steps:10.2f}"
    return f"{name:28}{numbers}{cost.per_iteration:9.1f}{limit:9.1f}{cost.per_iteration / limit:7.2f}"


def scaling(runs: int) -> None:
    """Cost of a 6 m trip at mid height for shafts of any height, and the exponent of its growth."""
    costs = []
    for nodes in NODES:
        height = 0.05 * (nodes - 1) - 3.0 - np.pi * 0.4
        cost = best("tower50", 0.5 * height, 0.5 * height + 6.0, 4.0, runs, shaft__height=height)
        print(row("6 m at mid height", DEFAULT_STEP, cost))
        costs.append(cost)
    for what in ("per_iteration", "per_second"):
        values = [getattr(cost, what) for cost in costs]
        exponent = np.polyfit(np.log(NODES), np.log(values), 1)[0]
        print(f"{what} grows as nodes^{exponent:.2f}")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=3, help="runs of which the fastest counts")
    runs = parser.parse_args().runs
    print(HEAD)
    for name, (preset, origin, destination, until) in TRIPS.items():
        for step in (0.001, DEFAULT_STEP):
            cost = best(preset, origin, destination, until, runs, solver__step=step)
            print(row(name, step, cost) + (f"   {cost.halved} halvings" if cost.halved else ""))
    scaling(runs)


if __name__ == "__main__":
    main()
