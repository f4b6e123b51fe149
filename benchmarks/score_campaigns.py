"""How `comprope diagnose` does on campaigns whose truth is known: one JSON line each, then a table per cause and size.

    python benchmarks/score_campaigns.py FOLDER... [--out results/scores.jsonl] [--jobs 2]
    python benchmarks/score_campaigns.py FOLDER... --blind                   (the effects that are hidden are ruled out)
    python benchmarks/score_campaigns.py --out results/scores.jsonl          (the table of what is there)

A FOLDER is a campaign, or holds campaigns. The command runs as a user would run it and does not see the truth: the files are
copied without it. Campaigns that the output already holds are not run again.

"first": the verdict is the cause, or one of two. "group": or the two are said to be indistinguishable. Right verdicts are, where
nothing is hidden, adequate; for causes outside the library, unknown; for faults of data, nothing physical (a refusal with a
reason counts) and, for a wrong sign or unit, the channel named.
"""

import argparse
import json
import shutil
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from score_added import added
from score_command import command
from score_table import TAKEN_OUT, table

Json = dict[str, Any]
NAMED = ("wrong_sign", "wrong_unit")  # faults of data that must be told, not only survived


def main() -> None:
    """Diagnose and score what is given, then print the table of all."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("folders", nargs="*", type=Path)
    options.add_argument("--out", type=Path, default=Path("results/scores.jsonl"))
    options.add_argument("--jobs", type=int, default=2)
    options.add_argument("--blind", action="store_true", help="leave the hidden effects out of the library: unknown is right")
    options.add_argument("--add", action="store_true", help="add the effect that the verdict names, if it is right")
    options.add_argument("--minutes", type=float, default=30.0, help="after which a diagnosis counts as failed")
    chosen = options.parse_args()
    rows = read(chosen.out)
    done = {row["campaign"] for row in rows}
    chosen.out.parent.mkdir(parents=True, exist_ok=True)
    for folder in campaigns(chosen.folders):
        if str(folder) in done:
            continue
        rows.append(score(folder, chosen.jobs, 60.0 * chosen.minutes, chosen.blind, chosen.add))
        with chosen.out.open("a", encoding="utf-8") as file:
            file.write(json.dumps(rows[-1]) + "\n")
        print(line(rows[-1]), flush=True)
    print(table(rows))


def read(path: Path) -> list[Json]:
    """The rows of a result file, if there is one."""
    return [json.loads(text) for text in path.read_text(encoding="utf-8").splitlines()] if path.exists() else []


def campaigns(folders: Iterable[Path]) -> list[Path]:
    """The campaigns among folders and right below them."""
    return [
        truth.parent.resolve()
        for folder in folders
        for truth in sorted([*folder.glob("truth.json"), *folder.glob("*/truth.json")])
    ]


def score(folder: Path, jobs: int, limit: float, blind: bool, add: bool) -> Json:
    """Diagnose one campaign and hold what was said against the truth; `blind` to what is hidden. `add` what is found."""
    truth = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
    truth |= {"kind": TAKEN_OUT} if blind else {}
    with tempfile.TemporaryDirectory() as room:
        copy = Path(room) / "campaign"
        shutil.copytree(folder, copy, ignore=shutil.ignore_patterns("truth.json"))
        began = time.perf_counter()
        ruled_out = [word for name in hidden_effects(truth) for word in ("--without", name)] if blind else []
        status, said, errors = command(copy, "diagnose", ruled_out, jobs, limit)
        seconds = time.perf_counter() - began
        row = scored(folder, truth, status, said, errors) | {"seconds": seconds}
        if add and said.get("verdict") and first(truth, said):
            row["added"] = added(copy, said, truth, jobs, limit)
        return row


def scored(folder: Path, truth: Json, status: int, said: Json, errors: str) -> Json:
    """What was said, held against the truth."""
    top = (said.get("ranking") or [{}])[0]
    was = said.get("errors", {})
    kind = said.get("verdict_kind", "none")
    physical = kind in ("known_effect", "instrument") and bool(said.get("verdict"))
    return {
        "campaign": str(folder), **{key: truth[key] for key in ("kind", "causes", "column", "level", "near", "shift", "plant")},
        "status": status, "errors": errors, "verdict": said.get("verdict"), "verdict_kind": kind,
        "probability": stated(said), "probabilities": said.get("probabilities", {}),
        "first": first(truth, said), "group": first(truth, said) or grouped(truth, said) or told(truth, said, errors),
        "near_hit": said.get("verdict") in truth["near"],
        "parameters": top.get("parameters", {}), "together_with": top.get("together_with", {}),
        "left": top.get("misfit_per_datum") if physical else said.get("misfit_per_datum", {}).get("plant_refitted"),
        "validate_before": was.get("as_it_stands", {}).get("validate"),
        "validate_refitted": was.get("plant_refitted", {}).get("validate"),
        "validate_after": top.get("validate_error_after") if physical else was.get("plant_refitted", {}).get("validate"),
        "ranking": [(one["effect"], one["probability"], one.get("misfit_per_datum")) for one in said.get("ranking", [])[:4]],
        "indistinguishable": said.get("indistinguishable", []), "remarks": said.get("remarks", []),
    }  # fmt: skip


def first(truth: Json, said: Json) -> bool:
    """Whether the verdict itself is right."""
    kind, hidden = said.get("verdict_kind"), truth["kind"]
    if hidden in ("nothing", "data"):
        return kind == "adequate" and not set(NAMED) & set(truth["causes"])
    if hidden in ("outside", TAKEN_OUT):
        return kind == "unknown_effect"
    return said.get("verdict") in hidden_effects(truth)


def grouped(truth: Json, said: Json) -> bool:
    """Whether the verdict is said to be indistinguishable from a hidden cause."""
    hidden = set(hidden_effects(truth))
    return any(said.get("verdict") in pair and set(pair) & hidden for pair in said.get("indistinguishable", []))


def hidden_effects(truth: Json) -> list[str]:
    """The hidden causes as the library calls them."""
    return list(truth.get("effects", truth["causes"]))


def told(truth: Json, said: Json, errors: str) -> bool:
    """Whether a fault of data is blamed on the data: the instrument, a remark on the channel, or a refusal with a reason."""
    if truth["kind"] != "data" or said.get("verdict_kind") in ("known_effect", "unknown_effect"):
        return False
    if not set(NAMED) & set(truth["causes"]):
        return bool(said) or bool(errors)
    return any(str(truth["column"]) in text for text in [*said.get("remarks", []), errors])


def stated(said: Json) -> float | None:
    """The probability that goes with the verdict: its effect's share, or that of `adequate` or `unknown`."""
    shares = said.get("probabilities", {})
    verdict = said.get("verdict")
    if verdict and said.get("ranking"):
        return next((one["probability"] for one in said["ranking"] if one["effect"] == verdict), None)
    return shares.get(said.get("verdict_kind", "").removesuffix("_effect"))


def line(row: Json) -> str:
    """One campaign in one line."""
    said = row["verdict"] or row["verdict_kind"]
    mark = "right" if row["first"] else "in group" if row["group"] else "near" if row["near_hit"] else "WRONG"
    level = "" if row["level"] is None else f" at {row['level']:.2f}"
    peak = max(row["shift"].values(), default=0.0)
    held = f"{digits(row['validate_before'])} -> {digits(row['validate_after'])}"
    return (
        f"{Path(row['campaign']).name} {row['kind']} {' + '.join(row['causes'])}{level}, {peak:.1f} times noise -> {said} "
        f"({digits(row['probability'])}): {mark}; held out {held}, left {digits(row['left'])}, {row['seconds']:.0f} s "
        f"{row['errors'][:200]}"
    )


def digits(value: float | None) -> str:
    """A number in three digits, if there is one."""
    return "-" if value is None else f"{value:.3g}"


if __name__ == "__main__":
    main()
