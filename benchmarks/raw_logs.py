"""Every raw log of a folder, and variants generated from its plain.csv: read right, refused, or told; none may be silently wrong.

    python benchmarks/raw_logs.py FOLDER [--campaign DIR] [--variants-only]

FOLDER holds one run in many formats, plain.csv being the truth; DIR its campaign, by default `stiff_bearing` beside FOLDER. Each
file is checked by `comprope_system.check` in a campaign of its own, and what was read is compared with the truth: times within
1 us, the recovered position of the car within 5 mm, channels exactly. Exit status 1 if a file is silently wrong.
"""

import argparse
import shutil
import sys
import tempfile
import tomllib
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from raw_log_variants import Variant, variants

import comprope_system
from comprope.errors import CompropeError
from comprope_system.identification.data.runs import Run

TIME, CAR, CHANNEL = 1e-6, 5e-3, 1e-9  # s, m, SI: how far what was read may be from the truth
MOTION = 1.5e-3  # m, the same of a motion recovered from noise of a third of it
RENAMED = {  # of bracketed_units.csv
    "cw_low": "Laser CW low", "cw_mid": "Laser CW mid", "car_low": "Laser car", "sheave_dx": "Sheave", "sheave_w": "Sheave speed",
}  # fmt: skip


@dataclass(frozen=True)
class Outcome:
    """How the reading of a file ended: "right", "told", "refused" or "WRONG", and what was said."""

    name: str
    verdict: str
    said: str


def run_of(file: Path, campaign: Path, extra: str = "", run_extra: str = "") -> tuple[Run | None, str]:
    """The run of a file in a campaign of its own, and what was said about it; `extra` stands above the first channel."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copy(file, folder / file.name)
        text = (campaign / "campaign.toml").read_text("utf-8")
        shutil.copy(campaign / tomllib.loads(text)["model"], folder)
        head, _, rest = text.partition("[[channels]]")
        channels = rest.partition("[[runs]]")[0]
        run = f'[[runs]]\nfile = "{file.name}"\nset = {{ "sheave.mass" = 120.0, "sheave.inertia" = 9.6 }}\n{run_extra}\n'
        (folder / "campaign.toml").write_text(f"{head}{extra}\n[[channels]]{channels}{run}", "utf-8")
        try:
            found = comprope_system.check(folder)
        except CompropeError as error:
            return None, str(error)
        said = "; ".join((*found.problems, *(one for run in found.runs for one in run.remarks)))
        run_found = found.runs[0].run if found.runs else None
        return run_found, said.replace(f"{folder}/", "")


def difference(run: Run, truth: Run, asked: str = "") -> str:
    """Where a run differs from the truth; empty if nowhere. Samples of the channel `asked` were to be left out."""
    if len(run.time) != len(truth.time) or np.max(np.abs(run.time - truth.time)) > TIME:
        return "time"
    if np.max(np.abs(run.trip.position(truth.time) - truth.trip.position(truth.time))) > CAR:
        return "car"
    for column, value in truth.values.items():
        own = run.values[column]
        if np.nanmax(np.abs(own - value), initial=0.0) > CHANNEL:
            return column
        if column != asked and np.any(np.isnan(own) != np.isnan(value)):
            return column
    return ""


def judge(variant: Variant, file: Path, campaign: Path, truth: Run) -> Outcome:
    """The outcome of one file."""
    run, said = run_of(file, campaign, variant.extra, variant.run_extra)
    if run is None:
        return Outcome(variant.name, "refused", said)
    if variant.motion is not None:
        return _motion_outcome(variant, run, said)
    if variant.truth is not None:
        truth = _true_run(variant.truth, campaign)
    other = difference(run, truth, variant.asked)
    return Outcome(variant.name, "right" if not other else "told" if said else "WRONG", said or other)


def _motion_outcome(variant: Variant, run: Run, said: str) -> Outcome:
    """The outcome of a recovered motion, beside the true one: within MOTION, or told with the size by which it is uncertain."""
    error = np.abs(run.trip.position(run.time) - variant.motion)
    size = f"off by {1e3 * float(error.max()):.2g} mm at most"
    told = any(word in said for word in ("misses the measured position", "extrapolated", "an impact"))
    return Outcome(variant.name, "right" if error.max() <= MOTION else "told" if told else "WRONG", f"{size}; {said}")


def _true_run(table: pd.DataFrame, campaign: Path) -> Run:
    """The run of a table in its plain form."""
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "run.csv"
        table.to_csv(path, index=False)
        run, said = run_of(path, campaign)
    if run is None:
        raise SystemExit(said)
    return run


def outcomes(folder: Path, campaign: Path, raw: bool = True, generated: bool = True, only: str = "") -> list[Outcome]:
    """The outcomes of all raw files of a folder, and of the variants generated from its plain.csv."""
    truth, said = run_of(folder / "plain.csv", campaign)
    if truth is None:
        raise SystemExit(f"plain.csv: {said}")
    found = []
    if raw:
        names = ", ".join(f'{key} = "{value}"' for key, value in RENAMED.items())
        for file in sorted(one for one in folder.iterdir() if one.is_file()):
            renamed = f"columns = {{ {names} }}" if file.name == "bracketed_units.csv" else ""
            found.append(judge(Variant(file.name, file.name, lambda path: None, run_extra=renamed), file, campaign, truth))
    if generated:
        with tempfile.TemporaryDirectory() as name:
            for variant in (one for one in variants(folder / "plain.csv") if only in one.name):
                path = Path(name) / variant.file
                variant.write(path)
                found.append(judge(variant, path, campaign, truth))
    return found


def main() -> None:
    """Print the table of outcomes and how many there are of each."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("folder", type=Path)
    options.add_argument("--campaign", type=Path)
    options.add_argument("--variants-only", action="store_true")
    options.add_argument("--only", default="", help="variants whose names contain this")
    chosen = options.parse_args()
    campaign = chosen.campaign or chosen.folder.parent / "stiff_bearing"
    found = outcomes(chosen.folder, campaign, raw=not (chosen.variants_only or chosen.only), only=chosen.only)
    print("| file | outcome | said |\n|---|---|---|")
    for one in found:
        print(f"| {one.name} | {one.verdict} | {one.said.replace('|', '/')} |")
    print(dict(Counter(one.verdict for one in found)))
    sys.exit(any(one.verdict == "WRONG" for one in found))


if __name__ == "__main__":
    main()
