"""Tuning of ten trips, or those named, in the 200 m building: swing against the best S-curve, time for quiet, another sheave.

    python benchmarks/tuning.py [--jobs 2] [--times 1.1,1.3] [--trips 0:4,0:8] [--out results/tuning]
    python benchmarks/tuning.py --read results/tuning/result.json

Prints tables in Markdown; swings are in mm, during and after the trip. Each trip's search runs on one process.
"""

import argparse
import json
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import comprope_system
from comprope_system.tuning import report

TRIPS = ("0:4", "0:8", "0:14", "0:22", "0:40", "0:100", "0:200", "200:170", "100:122", "150:60")


def mm(values: Any) -> str:
    """Two swings [m] in mm."""
    return f"{1e3 * values[0]:.2f}, {1e3 * values[1]:.2f}"


def name(trip: Mapping[str, Any]) -> str:
    """A trip as a text."""
    return f"{trip['origin']:g} to {trip['destination']:g} m"


def row(*cells: object) -> str:
    """A row of a table."""
    return f"| {' | '.join(str(cell) for cell in cells)} |"


def head(*names: str) -> list[str]:
    """A table's first two rows."""
    return [row(*names), "|" + "---|" * len(names)]


def swings(trips: list[Mapping[str, Any]]) -> list[str]:
    """By the FMUs: present, best S-curve, tuned."""
    lines = head("trip", "present, s", "factor", "present", "best S-curve", "tuned", "kind", "less in both")
    for trip in trips:
        shown = trip["installed"]
        point = next(one for one in trip["points"] if one["factor"] == shown["factor"])
        three = [shown[key]["swing"] for key in ("present", "s_curve", "tuned")]
        less = all(a < b for a, b in zip(three[2], three[1], strict=True))
        kind = point["tuned"]["kind"]
        lines.append(row(name(trip), f"{trip['present']['time']:.2f}", f"{shown['factor']:g}", *map(mm, three), kind, less))
    return lines


def fronts(trips: list[Mapping[str, Any]]) -> list[str]:
    """On the full model with drive, every travel time."""
    lines = head("trip", "factor", "best S-curve", "tuned", "kind")
    for trip in trips:
        for one in trip["points"]:
            told = one["s_curve"]["full"], one["tuned"]["full"]
            lines.append(row(name(trip), f"{one['factor']:g}", *map(mm, told), one["tuned"]["kind"]))
    return lines


def quiet(trips: list[Mapping[str, Any]]) -> list[str]:
    """Extra time for half and for a fifth of the present swing after the trip, share left on the full model, and the bound."""
    asked = [text for share in ("half", "fifth") for text in (f"{share}: extra, s", "left", "bound, s")]
    lines = head("trip", "period, s", *asked, "too short to hide")
    for trip in trips:
        cells: list[str] = []
        for saved, least in zip(trip["saved"], trip["bound"]["times"], strict=True):
            own = trip["present"]
            extra = f"{saved['time'] - own['time']:.2f}" if saved["time"] else "none found"
            left = f"{100.0 * saved['full'][1] / own['full'][1]:.0f} %" if saved["full"] else ""
            cells += [extra, left, f"{max(least - own['time'], 0.0):.2f}" if least else "none"]
        lines.append(row(name(trip), f"{trip['period']:.2f}", *cells, "yes" if trip["bound"]["too_short"] else "no"))
    return lines


def robust(trips: list[Mapping[str, Any]]) -> list[str]:
    """The sheave a tenth lighter and heavier."""
    lines = head("trip", "-10 %: S-curve", "tuned", "+10 %: S-curve", "tuned")
    for trip in trips:
        lines.append(row(name(trip), *(mm(each[key]) for each in trip["robust"] for key in ("s_curve", "tuned"))))
    return lines


def tables(result: Mapping[str, Any]) -> list[str]:
    """All tables."""
    trips, found = result["trips"], sorted(report.errors(result["trips"]))
    lines = [*swings(trips), "", *fronts(trips), "", *quiet(trips), "", *robust(trips), ""]
    middle = found[len(found) // 2]
    lines.append(f"full model over small rope, {len(found)} swings: {found[0]:+.2f}, {middle:+.2f}, {found[-1]:+.2f}")
    lines += [f"servo {key}: {value}" for key, value in result["servo"].items()]
    if common := result["controller"]:
        times = sum(common["times"]) / sum(trip["present"]["time"] for trip in trips)
        lines += ["", f"one controller, {common['kind']}, {times:.3f} of the present travel times", ""]
        pairs = zip(trips, common["full"], strict=True)
        lines += head("trip", "of the present time", "present", "tuned")
        shares = [time / trip["present"]["time"] for trip, time in zip(trips, common["times"], strict=True)]
        lines += [
            row(name(trip), f"{share:.2f}", mm(trip["present"]["full"]), mm(full))
            for share, (trip, full) in zip(shares, pairs, strict=True)
        ]
    return lines


def main() -> None:
    """Tune or read, and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--times", default="1.1,1.3")
    parser.add_argument("--trips", default=",".join(TRIPS))
    parser.add_argument("--out", type=Path, default=Path("results/tuning"))
    parser.add_argument("--read", type=Path, help="result.json of an earlier run: only print its tables")
    options = parser.parse_args()
    if options.read:
        print("\n".join(tables(json.loads(options.read.read_text(encoding="utf-8")))))
        return
    begin = time.perf_counter()
    trips = options.trips.split(",")
    asked = comprope_system.TuningOptions(trips, [float(one) for one in options.times.split(",")])
    found = comprope_system.tune("building200", asked, checkpoint=options.out / "runs.jsonl", jobs=options.jobs)
    found.save_files(options.out)
    result = found.to_json()
    print("\n".join(tables(result)))
    print(f"{(time.perf_counter() - begin) / 60.0 / len(trips):.1f} minutes per trip")


if __name__ == "__main__":
    main()
