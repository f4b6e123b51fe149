"""The result of `comprope_system.design`: smallest sheave mass, sensor heights, and natural periods against trips and sway."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from comprope.drive.parameters import Profile
from comprope.rope.effects import RopeModel

from ..report.page import Section, save_page, save_pictures
from ..report.result import Result
from . import report
from .rope_sharing import RopeSharing

PAGE, RESULT = "design.html", "result.json"


@dataclass(frozen=True, repr=False)
class DesignResult(Result):
    """Sheave mass for a limit of the swing, and sensor heights.

    `sheave_mass` [kg] is the least `sheave.mass` on the full model, `reduced_model_mass` that of the reduced model; `scanned` has
    the worst trip and the worst parked floor by mass, `full_model_runs` pairs of mass [kg] and swing [m], `sensors` the heights
    [m] on each side and the share of a large swing that they see. `stops`, if asked for, has for each kind of stop and floor the
    `speed` [m/s], the sheave's `rise` [m], its largest `sheave_force` [N], `peak_tension` of the rope [N] and `slack_duration`
    [s], with a wall the least `clearance` [m]. `sharing` is how ropes that differ share the sheave. `clearances`, if a wall is
    given, have the least `clearance` [m] of each `case`, and where it is.
    `model` is the model as given, `new_model` has the new sheave.
    """

    settings: Mapping[str, Any]
    sheave_mass: float
    reduced_model_mass: float
    scanned: tuple[dict[str, Any], ...]
    full_model_runs: tuple[list[float], ...]
    sensors: Mapping[str, Any]
    stops: tuple[dict[str, Any], ...]
    model: RopeModel
    new_model: RopeModel
    profile: Profile
    clearances: tuple[dict[str, Any], ...] = ()
    sharing: RopeSharing | None = None

    def headline(self) -> str:
        """Smallest sheave mass, and the limit of the swing."""
        return report.summary(self.to_json())[0]

    def summary(self) -> str:
        """Smallest sheave mass and sensor heights."""
        return "\n".join(report.summary(self.to_json()))

    def to_json(self) -> dict[str, Any]:
        """Settings, masses [kg], swings [m], sensors [m above the bottom landing]."""
        return {
            **self.settings, "own_mass": self.model.sheave.mass, "mass_small": self.reduced_model_mass, "mass": self.sheave_mass,
            "scanned": list(self.scanned), "full": list(self.full_model_runs), "sensors": dict(self.sensors),
            "stops": list(self.stops), "clearances": list(self.clearances),
            "sharing": self.sharing.to_json() if self.sharing else None,
        }  # fmt: skip

    def to_dataframe(self) -> pd.DataFrame:
        """One row for each mass scanned on the reduced model: the worst swing [m], its trip, after it, and in the sway."""
        rows = [(s["mass"], s["swing"], *s["trip"], s["after"], s["sway"], s["sway_car"]) for s in self.scanned]
        columns = ["sheave_mass", "swing", "origin", "destination", "swing_after", "sway_swing", "sway_car_position"]
        return pd.DataFrame(rows, columns=columns)

    def save_html(self, path: str | Path) -> None:
        """Write the HTML page, completely or not at all."""
        save_page(path, report.TITLE, report.LEAD, self._sections())

    def save_files(self, folder: str | Path) -> None:
        """Write the result, pictures and the page into a folder."""
        out = Path(folder)
        self.save_json(out / RESULT)
        save_pictures(out, self._sections())
        self.save_html(out / PAGE)

    def _sections(self) -> list[Section]:
        return report.sections(self.to_json(), self.model, self.new_model, self.profile)
