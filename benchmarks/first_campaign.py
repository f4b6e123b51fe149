"""Minutes from a new environment to the FMUs of an improved model, as a new user gets there with raw logger files.

    python benchmarks/first_campaign.py CAMPAIGN [--keep FOLDER] [--pictures docs/pages]

Builds the wheel, installs it into a new environment outside of the repository with an empty cache, writes the four runs of
CAMPAIGN as loggers of three kinds write them, and calls `comprope new` (answering its questions with what CAMPAIGN states about
each run), `check`, `improve --fmu`; the FMUs are then run by fmpy. --keep writes everything to FOLDER, for a look at it;
--pictures draws the first run beside both models.
"""

import argparse
import os
import pty
import resource
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Sequence
from datetime import datetime, timedelta
from pathlib import Path

import pandas as pd
from PIL import Image

ROOT = Path(__file__).parent.parent
NAMES = {
    "car_position": "Car position", "cw_low": "Laser CW low [mm]", "cw_mid": "Laser CW mid [mm]", "car_low": "Laser car low [mm]",
    "sheave_dx": "Sheave travel [mm]", "sheave_w": "Sheave speed [rad/s]",
}  # fmt: skip
START = datetime(2026, 11, 2, 9, 12, 1, 123000)  # of the record with dates
PIXELS, COLOURS = (1300, 900), 64  # of a picture for the documentation
FMU_RUN = """
import sys
import fmpy
found = fmpy.simulate_fmu(sys.argv[1], stop_time=5.0, output_interval=0.01)
print(f"{len(found)} rows, to {found['time'][-1]:g} s, largest sheave_force {max(abs(found['sheave_force'])):.4g} N")
"""


def raw_files(campaign: Path, folder: Path) -> list[tuple[Path, str]]:
    """Write the runs of a campaign as loggers of three kinds; each file with the answers to questions about its sheave."""
    stated = tomllib.loads((campaign / "campaign.toml").read_text(encoding="utf-8"))
    sheave = tomllib.loads((campaign / stated["model"]).read_text(encoding="utf-8"))["sheave"]
    writers, found = (_semicolons, _workbook, _dates), []
    for place, run in enumerate(stated["runs"]):
        table = pd.read_csv(campaign / run["file"]).rename(columns=NAMES)
        path = writers[place % len(writers)](table, folder / Path(run["file"]).stem)
        mass, inertia = (run.get("set", {}).get(f"sheave.{key}", sheave[key]) for key in ("mass", "inertia"))
        found.append((path, f"{mass:g}\n" if mass == sheave["mass"] else f"{mass:g}\n{inertia:g}\n"))
    return found


def _semicolons(table: pd.DataFrame, stem: Path) -> Path:
    """Semicolons, decimal commas, Windows-1252 and lines above the header."""
    named = table.rename(columns={"time": "Time [s]", "Car position": "Car position [m]"})
    text = named.to_csv(index=False, sep=";", decimal=",")
    path = stem.with_suffix(".csv")
    path.write_bytes(f"Recorder;7\nOperator;Müller\nTemperature;21,5 °C\n\n{text}".encode("cp1252"))
    return path


def _workbook(table: pd.DataFrame, stem: Path) -> Path:
    """An Excel workbook, with times in milliseconds."""
    named = table.assign(time=(1e3 * table["time"]).round(3))
    named = named.rename(columns={"time": "Time [ms]", "Car position": "Car position [m]"})
    named.to_excel(stem.with_suffix(".xlsx"), index=False)
    return stem.with_suffix(".xlsx")


def _dates(table: pd.DataFrame, stem: Path) -> Path:
    """Date and time of each sample, the position of the car in millimetres, tabs."""
    dates = [(START + timedelta(seconds=one)).isoformat(timespec="milliseconds") for one in table["time"]]
    named = table.assign(time=dates, **{"Car position": (1e3 * table["Car position"]).round(2)})
    named = named.rename(columns={"time": "Timestamp", "Car position": "Car position [mm]"})
    named.to_csv(stem.with_suffix(".txt"), index=False, sep="\t")
    return stem.with_suffix(".txt")


class Steps:
    """Calls commands in a folder outside of the repository and records how long each took."""

    def __init__(self, folder: Path) -> None:
        """`folder` receives a log of each command."""
        self.folder = folder
        self.environment = os.environ | {"COMPROPE_CACHE": str(folder / "cache")}
        self.environment.pop("PYTHONPATH", None)
        self.rows: list[tuple[str, float, float]] = []

    def call(self, title: str, words: Sequence[str | Path], answers: str | None = None) -> str:
        """Call a command, which must succeed; `answers` are typed on its terminal. Returns its output."""
        begin, used, terminal = time.perf_counter(), _processor(), None
        if answers is not None:
            parent, terminal = pty.openpty()
            os.write(parent, answers.encode())
        with (self.folder / f"{len(self.rows)}.log").open("w+", encoding="utf-8") as log:
            status = subprocess.run(
                list(map(str, words)), cwd=self.folder, env=self.environment, stdin=terminal or subprocess.DEVNULL, stdout=log,
                stderr=subprocess.STDOUT, check=False,
            ).returncode  # fmt: skip
            log.seek(0)
            said = log.read()
        if status:
            sys.exit(f"{title}: exit status {status}\n{said}")
        self.rows.append((title, (time.perf_counter() - begin) / 60.0, _processor() - used))
        print(f"{title}: {self.rows[-1][1]:.2f} min, {self.rows[-1][2]:.0f} s of processors", flush=True)
        return said

    def table(self) -> str:
        """Minutes and processor seconds of each step and of all."""
        rows = [f"| {title} | {minutes:.2f} | {used:.0f} |" for title, minutes, used in self.rows]
        minutes, used = (sum(row[k] for row in self.rows) for k in (1, 2))
        head = ["| step | minutes | processor s |", "|---|---|---|"]
        return "\n".join([*head, *rows, f"| together | {minutes:.2f} | {used:.0f} |"])


def _processor() -> float:
    """Processor seconds of all commands that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def journey(campaign: Path, folder: Path) -> None:
    """All steps in an empty folder; prints what the commands say and the table."""
    steps = Steps(folder)
    sources, raw, bin_ = folder / "sources", folder / "raw", folder / "environment" / "bin"
    ignored = shutil.ignore_patterns("__pycache__", "*.egg-info", "build")
    for name in ("fmu_src", "system"):
        shutil.copytree(ROOT / name, sources / name, ignore=ignored)
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, sources)
    raw.mkdir()
    runs = raw_files(campaign, raw)
    model = shutil.copy(campaign / tomllib.loads((campaign / "campaign.toml").read_text("utf-8"))["model"], raw)
    steps.call("new environment", [sys.executable, "-m", "venv", "environment"])
    steps.call("build the wheel", [bin_ / "pip", "wheel", "-q", "--no-deps", "-w", "wheel", sources])
    wheel = next((folder / "wheel").glob("comprope-*.whl"))
    steps.call("pip install", [bin_ / "pip", "install", "-q", f"{wheel}[formats]"])
    answers = "".join(one[1] for one in runs)
    print(steps.call("comprope new", [bin_ / "comprope", "new", "tower", *(one[0] for one in runs), "--model", model], answers))
    print(steps.call("comprope check", [bin_ / "comprope", "check", "tower"]))
    words = ["improve", "tower", "--out", "better.toml", "--report", "improve.html", "--fmu", "fmus"]
    print(steps.call("comprope improve --fmu", [bin_ / "comprope", *words]))
    print(steps.call("5 s of the rope's FMU in fmpy", [bin_ / "python", "-c", FMU_RUN, "fmus/CompensationRope.fmu"]))
    print(steps.table())


def draw(folder: Path, pictures: Path) -> None:
    """Plots of the first run beside the model as it was and the improved one, as small PNG files."""
    command, campaign = folder / "environment" / "bin" / "comprope", folder / "tower"
    stated = tomllib.loads((campaign / "campaign.toml").read_text(encoding="utf-8"))
    run = campaign / stated["runs"][0]["file"]
    for name, path in (("before", campaign / stated["model"]), ("after", folder / "better.toml")):
        plot = folder / f"{name}.png"
        subprocess.run([command, "simulate", path, "--car", run, "--plot", plot], cwd=folder, check=True, capture_output=True)
        small = Image.open(plot).convert("RGB").resize(PIXELS, Image.Resampling.LANCZOS)
        small.quantize(COLOURS, method=Image.Quantize.FASTOCTREE).save(pictures / f"first_{name}.png", optimize=True)


def main() -> None:
    """Run in a temporary folder, or in one that is kept."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("campaign", type=Path)
    parser.add_argument("--keep", type=Path, metavar="FOLDER")
    parser.add_argument("--pictures", type=Path, metavar="FOLDER")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep.resolve() if options.keep else Path(temporary)
        folder.mkdir(parents=True, exist_ok=not options.keep)
        journey(options.campaign.resolve(), folder)
        if options.pictures:
            draw(folder, options.pictures)


if __name__ == "__main__":
    main()
