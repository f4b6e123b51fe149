"""The result of `comprope_system.tune`: tuned trips, one controller for all of them, and their parameter files."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
import tomli_w

from comprope.atomic_files import atomic_write
from comprope.drive.parameters import Drive

from ..report.json_output import save_json
from ..report.page import save_page, save_pictures
from ..report.result import Result
from . import report
from .task import TUNED_PARTS

PAGE, RESULT, MODELS, CONTROLLER = "tuning.html", "result.json", "rope_models.json", "controller.drive.toml"


@dataclass(frozen=True, repr=False)
class TuningResult(Result):
    """Result of a tuning: trips with their drives.

    `trips` are the trips as JSON holds them: times in s, swings in m as [during, after] the trip. `servo` has the present and the
    chosen gains, `controller` what is known of the one drive for all trips, None if no kind of trip is so fast. `drives` are the
    tuned drives by the trip's name, such as "0_22", with a heading; `shared_drive` is the one for all. `rope_models` are
    state-space models of the rope by the car's position [m].
    """

    settings: Mapping[str, Any]
    servo: Mapping[str, Any]
    trips: tuple[dict[str, Any], ...]
    controller: Mapping[str, Any] | None
    drives: Mapping[str, tuple[Drive, str]]
    shared_drive: Drive | None
    rope_models: Mapping[str, Any]

    def headline(self) -> str:
        """How many trips were tuned, and whether one controller serves them all."""
        common = f"one controller for all: {self.controller['kind']}" if self.controller else "no controller for all of them"
        return f"{self.settings['model']}: {len(self.trips)} trip{'s' if len(self.trips) != 1 else ''} tuned, {common}"

    def summary(self) -> str:
        """One line for each trip: swing during and after it with the present, the best S-curve and the tuned drive."""
        return "\n".join(report.summary(self.to_json()))

    def to_json(self) -> dict[str, Any]:
        """Settings, servo gains, trips and the shared controller: times in s, swings in m."""
        return {**self.settings, "servo": dict(self.servo), "trips": list(self.trips), "controller": self.controller}

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each trip and travel time: swings [m] of the best S-curve and of the tuned drive on the full model."""
        rows = [
            (
                trip["origin"], trip["destination"], point["factor"], point["time"], *point["s_curve"]["full"],
                *point["tuned"]["full"], point["tuned"]["kind"],
            )
            for trip in self.trips
            for point in trip["points"]
        ]  # fmt: skip
        swings = (f"{kind}_{when}" for kind in ("s_curve", "tuned") for when in ("during", "after"))
        return pd.DataFrame(rows, columns=["origin", "destination", "factor", "travel_time", *swings, "kind"])

    def save_html(self, path: str | Path) -> None:
        """Write the HTML page, completely or not at all."""
        save_page(path, report.TITLE, report.LEAD, report.sections(self.to_json()))

    def save_files(self, folder: str | Path) -> None:
        """Write drive files, the result, models of the rope, pictures and the page into a folder."""
        out = Path(folder)
        for name, (drive, heading) in self.drives.items():
            save_drive(out / f"trip_{name}.drive.toml", drive, heading)
        if self.shared_drive and self.controller:
            save_drive(out / CONTROLLER, self.shared_drive, f"One controller for all trips: {self.controller['kind']}.")
        self.save_json(out / RESULT)
        save_json(out / MODELS, self.rope_models)
        save_pictures(out, report.sections(self.to_json()))
        self.save_html(out / PAGE)


def save_drive(path: Path, drive: Drive, heading: str) -> None:
    """Write profile, curve, shaper and servo of a drive as a parameter file, completely or not at all."""
    table = drive.model_dump(include=TUNED_PARTS)
    if not drive.curve.used:
        del table["curve"]
    with atomic_write(path) as temporary:
        temporary.write_text(f"# {heading}\n\n{tomli_w.dumps(table)}", encoding="utf-8", newline="\n")
