"""Scores of many diagnoses as tables: per cause and size, the totals that count, and how honest probabilities are."""

from collections import defaultdict
from collections.abc import Callable, Sequence
from statistics import median
from typing import Any

Json = dict[str, Any]
VISIBLE = 3.0  # times the noise that a cause must shift some channel by
SIZES = ("barely", "middle", "large")


def table(rows: Sequence[Json]) -> str:
    """All tables, in Markdown."""
    if not rows:
        return "no scores yet"
    return "\n\n".join(("\n".join(part(rows)) for part in (by_cause, totals, honesty)))


def by_cause(rows: Sequence[Json]) -> list[str]:
    """One line per cause and third of its range."""
    groups: dict[tuple[str, str, int], list[Json]] = defaultdict(list)
    for row in rows:
        groups[row["kind"], "two at once" if row["kind"] == "pair" else next(iter(row["causes"])), third(row)].append(row)
    found = [
        "| kind | hidden | size | times noise | campaigns | first | or group | wrongly called | probability "
        "| held out: before, refitted, after | left | seconds |",
        "|---|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for (kind, cause, size), among in sorted(groups.items()):
        called = sorted({row["verdict"] or row["verdict_kind"] for row in among if not row["group"]})
        found.append(
            f"| {kind} | {cause} | {'' if size < 0 else SIZES[size]} | {middle(peak(row) for row in among)} | {len(among)} "
            f"| {count(among, 'first')} | {count(among, 'group')} | {', '.join(called)} | {middle_of(among, 'probability')} "
            f"| {middle_of(among, 'validate_before')}, {middle_of(among, 'validate_refitted')}, {middle_of(among, 'validate_after')} "
            f"| {middle_of(among, 'left')} | {middle_of(among, 'seconds')} |"
        )
    return found


def totals(rows: Sequence[Json]) -> list[str]:
    """What the diagnosis is judged by."""

    def of(kinds: tuple[str, ...], more: Callable[[Json], bool] = lambda row: True) -> list[Json]:
        return [row for row in rows if row["kind"] in kinds and more(row)]

    sound, known, strange = of(("nothing",)), of(("known", "instrument"), visible), of(("outside",), visible)
    return [
        "| judged by | campaigns | share |",
        "|---|---|---|",
        f"| first, one cause of the table that shifts a channel by over 3 times its noise | {len(known)} | {share(known, 'first')} |",
        f"| or group | {len(known)} | {share(known, 'group')} |",
        f"| first or group, two causes | {len(of(('pair',)))} | {share(of(('pair',)), 'group')} |",
        f"| false alarm, nothing hidden | {len(sound)} | {share(sound, 'alarm')} |",
        f"| none of the known, recalled where a channel shifts by over 3 times its noise | {len(strange)} | {share(strange, 'first')} |",
        f"| or called an effect of like nature | {len(strange)} | {share(strange, 'near_hit')} |",
        f"| faults of data survived or told | {len(of(('data',)))} | {share(of(('data',)), 'group')} |",
        f"| commands that failed | {len(rows)} | {share([row | {'failed': row['status'] not in (0, 2)} for row in rows], 'failed')} |",
        f"| median seconds | {len(rows)} | {middle_of(rows, 'seconds')} |",
    ]


def honesty(rows: Sequence[Json]) -> list[str]:
    """Stated probability of the verdict against how often it was right (first or group)."""
    found = ["| stated probability | campaigns | mean stated | right |", "|---|---|---|---|"]
    for low, high in ((0.0, 0.5), (0.5, 0.8), (0.8, 0.95), (0.95, 0.99), (0.99, 1.01)):
        among = [row for row in rows if row["probability"] is not None and low <= row["probability"] < high]
        if among:
            mean = sum(row["probability"] for row in among) / len(among)
            found.append(f"| {low} to {min(high, 1.0)} | {len(among)} | {mean:.3f} | {share(among, 'group')} |")
    return found


def third(row: Json) -> int:
    """In which third of its range a size lies; -1 where there is none."""
    return -1 if row["level"] is None or row["kind"] in ("nothing", "pair") else min(int(3.0 * row["level"]), 2)


def peak(row: Json) -> float:
    """The largest shift of any channel over its noise."""
    return max(row["shift"].values(), default=0.0)


def visible(row: Json) -> bool:
    """Whether the cause shifts some channel enough to be asked for."""
    return peak(row) > VISIBLE


def count(rows: Sequence[Json], key: str) -> int:
    """How many rows have it."""
    return sum(bool(row[key]) for row in rows)


def share(rows: Sequence[Json], key: str) -> str:
    """The share of rows that have it; a false alarm is any verdict but adequate."""
    rows = [row | {"alarm": row["verdict_kind"] != "adequate"} for row in rows]
    return f"{100.0 * count(rows, key) / len(rows):.0f} % ({count(rows, key)})" if rows else "-"


def middle(values: Any) -> str:
    """The median in three digits."""
    known = [value for value in values if value is not None]
    return f"{median(known):.3g}" if known else "-"


def middle_of(rows: Sequence[Json], key: str) -> str:
    """The median of one quantity."""
    return middle(row[key] for row in rows)
