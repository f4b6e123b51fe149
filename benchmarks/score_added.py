"""What `comprope add` makes of a diagnosis's verdict: errors before and after, and whether its intervals hold the truth."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from score_command import command

Json = dict[str, Any]
PLANT = {  # what the truth calls them
    "rope.bending_stiffness": "EI", "rope.bending_damping": "bending_damping", "rope.mass_per_length": "mass_per_length",
    "contact.friction_coefficient": "friction",
}  # fmt: skip
ABSOLUTE = ("phase",)  # the tower's angles are not counted from where the model's are


def added(campaign: Path, said: Json, truth: Json, jobs: int, limit: float) -> Json:
    """Errors with the verdict's effect added, and for each value that is known (value, deviation, low, high, truth)."""
    status, found, errors = command(campaign, "add", [named(said)], jobs, limit)
    if status:
        return {"status": status, "errors": errors}
    keys = ("error_before", "error_after", "validate_error_before", "validate_error_after", "misfit_per_datum")
    return {"status": 0, **{key: found[key] for key in keys}, "intervals": intervals(found, truth)}


def named(said: Json) -> str:
    """The verdict as `comprope add` takes it: an instrument's fault with its channel."""
    verdict = str(said["verdict"])
    return f"{verdict}.{next(iter(said['ranking'][0]['parameters']))}" if said["verdict_kind"] == "instrument" else verdict


def intervals(found: Json, truth: Json) -> dict[str, list[float]]:
    """Fitted values whose truth is known, by key: value, deviation, 95 % interval and truth."""
    hidden = truth.get("effects", truth["causes"])
    known = {f"effects.{name}.{which}": size for name, values in hidden.items() for which, size in values.items()}
    known |= {key: truth["plant"][name] for key, name in PLANT.items()}
    fitted = found["plant"] | found["intervals"]
    return {
        key: [fitted[key][part] for part in ("value", "deviation", "low", "high")] + [value]
        for key, value in known.items()
        if key in fitted and fitted[key]["deviation"] > 0.0 and key.rsplit(".", 1)[-1] not in ABSOLUTE
    }


def table(rows: Sequence[Json]) -> list[str]:
    """By value: how many 95 % intervals hold the truth, and the median distance from it in standard deviations."""
    found: dict[str, list[list[float]]] = {}
    for row in rows:
        for key, value in row.get("added", {}).get("intervals", {}).items():
            found.setdefault("its effect's" if key.startswith("effects.") else key, []).append(value)
    lines = ["| value | intervals | hold the truth | median distance, deviations |", "|---|---|---|---|"]
    for key, values in sorted(found.items()):
        held = sum(low <= true <= high for _, _, low, high, true in values)
        apart = sorted(abs(value - true) / deviation for value, deviation, _, _, true in values)
        lines.append(f"| {key} | {len(values)} | {held} | {apart[len(apart) // 2]:.2g} |")
    return lines if found else []
