"""Scores of many diagnoses as tables: by cause and size, totals, and calibration of the stated probabilities."""

from collections import defaultdict
from collections.abc import Sequence
from statistics import median
from typing import Any

from score_added import table as intervals

Json = dict[str, Any]
VISIBLE = 3.0  # times the noise that a cause must shift some channel by
TAKEN_OUT = "taken out"  # kind of a cause that the library has but was told to rule out
SIZES = ("small", "medium", "large")


def table(rows: Sequence[Json]) -> str:
    """All tables, in Markdown."""
    if not rows:
        return "no scores yet"
    return "\n\n".join("\n".join(part(rows)) for part in (by_cause, totals, honesty, intervals))


COLUMNS = (
    "kind", "true cause", "size", "shift / noise", "campaigns", "ranked first", "or indistinguishable", "wrong verdict",
    "probability", "validation: before, plant refitted, with effect", "reduced chi-square", "seconds",
)  # fmt: skip


def by_cause(rows: Sequence[Json]) -> list[str]:
    """One line per cause and third of its range."""
    groups: dict[tuple[str, str, int], list[Json]] = defaultdict(list)
    for row in rows:
        groups[row["kind"], "two at once" if row["kind"] == "pair" else next(iter(row["causes"])), third(row)].append(row)
    lines = ["| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    for (kind, cause, size), among in sorted(groups.items()):
        lines.append("| " + " | ".join([kind, cause, "" if size < 0 else SIZES[size], *cells(among)]) + " |")
    return lines


def cells(among: Sequence[Json]) -> list[str]:
    """What a group of scores says, from the shift over noise on."""
    called = sorted({row["verdict"] or row["verdict_kind"] for row in among if not row["group"]})
    held = ", ".join(middle_of(among, f"validate_{key}") for key in ("before", "refitted", "after"))
    return [
        middle(peak(row) for row in among), str(len(among)), str(count(among, "first")), str(count(among, "group")),
        ", ".join(called), middle_of(among, "probability"), held, middle_of(among, "left"), middle_of(among, "seconds"),
    ]  # fmt: skip


def totals(rows: Sequence[Json]) -> list[str]:
    """Totals by criterion."""
    rows = [row | {"alarm": row["verdict_kind"] != "adequate", "failed": row["status"] not in (0, 2)} for row in rows]
    seen = [row for row in rows if visible(row)]
    one, strange = of(seen, "known", "instrument"), of(seen, "outside")
    asked = [
        ("one known cause that shifts a channel by more than 3 times its noise, ranked first", one, "first"),
        ("the same, ranked first or indistinguishable from the first", one, "group"),
        ("two causes at once, one of them ranked first", of(rows, "pair"), "group"),
        ("no cause, verdict other than adequate", of(rows, "nothing"), "alarm"),
        ("cause not among the known effects, over 3 times the noise, verdict unknown effect", strange, "first"),
        ("the same, verdict a similar known effect", strange, "near_hit"),
        ("true cause excluded (`--blind`), verdict unknown effect", of(seen, TAKEN_OUT), "first"),
        ("fault of the data, tolerated or reported", of(rows, "data"), "group"),
        ("commands that failed", rows, "failed"),
    ]
    lines = [f"| {text} | {len(among)} | {share(among, key)} |" for text, among, key in asked]
    return ["| criterion | campaigns | share |", "|---|---|---|", *lines]


def of(rows: Sequence[Json], *kinds: str) -> list[Json]:
    """The rows of some kinds of cause."""
    return [row for row in rows if row["kind"] in kinds]


def honesty(rows: Sequence[Json]) -> list[str]:
    """Stated probability of the verdict against how often it was right (first or group)."""
    found = ["| stated probability | campaigns | mean stated | correct |", "|---|---|---|---|"]
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
    """The share of rows that have it."""
    return f"{100.0 * count(rows, key) / len(rows):.0f} % ({count(rows, key)})" if rows else "-"


def middle(values: Any) -> str:
    """The median in three digits."""
    known = [value for value in values if value is not None]
    return f"{median(known):.3g}" if known else "-"


def middle_of(rows: Sequence[Json], key: str) -> str:
    """The median of one quantity."""
    return middle(row[key] for row in rows)
