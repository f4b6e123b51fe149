"""Where an unknown force may act, how its course over time is expanded, and what every channel would show of it.

A course is a sum of cubic B-splines, c(t) = sum_k c_k B((t - t_k) / w), constant before the record begins. The response to each
spline comes from the tangent-linear run about the refitted model; the splines are those of an instrument in the form of an
effect, which no model has but the one that is asked here.
"""

from collections.abc import Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.interpolate import BSpline

from comprope.rope.effects import RopeModel, model_type, user_effects

from ..data.campaign import Channel, Run
from ..estimation.weighted_least_squares import LeastSquaresProblem
from ..prediction.parameter_point import ParameterPoint, run_at_point
from ..prediction.replay import Floats, coarsening_factor
from ..prediction.replay_sensitivities import replay_with_sensitivities
from ..settings import FORCE_LOCATIONS, REPLAY

PROBE = Path(__file__).with_name("force_probe_effect.py")
KEY = "effects.residual_force."

Shown = list[dict[str, Floats]]  # for each pulse every channel (n,)


@dataclass(frozen=True)
class ForceLocation:
    """One place: its name for a person, its quantity in the instrument, its unit, and the band of heights of a push."""

    name: str
    quantity: str
    unit: str
    height: float = 0.0
    reach: float = 1.0


def force_locations(model: RopeModel) -> list[ForceLocation]:
    """Every place at which an unknown force or motion is looked for."""
    sides = {"car": "under the car", "counterweight": "under the counterweight"}
    reach = model.shaft.height / FORCE_LOCATIONS.height_bands
    bands = [
        ForceLocation(f"a sideways push on the {side}'s side about {height:.3g} m up", f"{side}_side", "N/m", height, reach)
        for side in sides
        for height in reach * (np.arange(FORCE_LOCATIONS.height_bands) + 0.5)
    ]
    ends = [
        ForceLocation(f"{'a sideways' if way == 'out' else 'an up-and-down'} motion of the end {where}", f"{side}_end_{way}", "m")
        for way in ("out", "up")
        for side, where in sides.items()
    ]
    sheave = [
        ForceLocation("a force on the sheave", "sheave_force", "N"),
        ForceLocation("a torque on the sheave", "sheave_torque", "N.m"),
    ]
    return [*sheave, *bands, *ends]


@dataclass(frozen=True)
class Splines:
    """The splines of one run: their distance [s] and how many coefficients they have."""

    begin: float
    spacing: float
    count: int

    @property
    def centres(self) -> Floats:
        """Times at which the splines are largest: (count + FORCE_LOCATIONS.tied_splines - 1,) [s]."""
        return np.asarray(self.begin + self.spacing * np.arange(-1, self.count + FORCE_LOCATIONS.tied_splines - 2))

    def tied(self, columns: Floats) -> Floats:
        """Columns (n, count) by coefficients, from those by splines: the first ones go together."""
        return np.column_stack([columns[:, : FORCE_LOCATIONS.tied_splines].sum(1), columns[:, FORCE_LOCATIONS.tied_splines :]])

    def at(self, time: Floats) -> Floats:
        """Values (n, count) of what each coefficient stands for."""
        one = BSpline.basis_element(np.arange(-2.0, 3.0), extrapolate=False)
        return self.tied(np.nan_to_num(one((time[:, None] - self.centres) / self.spacing)))


def splines_of(run: Run) -> Splines:
    """Splines over a record."""
    length = float(run.time[-1] - run.time[0])
    spacing = max(FORCE_LOCATIONS.min_spacing, length / FORCE_LOCATIONS.max_splines)
    return Splines(float(run.time[0]), spacing, int(np.ceil(length / spacing)))


def probed(model: RopeModel) -> RopeModel:
    """The model with the probe effect, which is registered temporarily."""
    table = model.model_dump(exclude_none=True)
    table["own_effects"] = (*model.own_effects, str(PROBE))
    return model_type(table["own_effects"]).model_validate(table)


def responses(problem: LeastSquaresProblem, point: ParameterPoint, looked: Sequence[ForceLocation]) -> list[list[Floats]]:
    """What the data show of each coefficient, whitened: for each place and run a matrix (data of the run, coefficients).

    Elements and steps are those of a first look. Raises `SimulationError` where a run cannot be simulated with them.
    """
    with user_effects.temporarily_registered(str(PROBE), PROBE.read_text(encoding="utf-8")):
        jobs = [_begun(problem, point, run, looked) for run in problem.runs]
        by_run = [_gathered(problem, run, looked, one) for run, one in zip(problem.runs, jobs, strict=True)]
    return [[matrices[k] for matrices in by_run] for k in range(len(looked))]


def _begun(problem: LeastSquaresProblem, point: ParameterPoint, run: Run, looked: Sequence[ForceLocation]) -> list[Future[Shown]]:
    """Start the tangent-linear runs of one record, a group of pulses each."""
    campaign, coarse, splines = problem.campaign, coarsening_factor(problem.campaign.model), splines_of(run)
    pulses = [(location, float(time), splines.spacing) for location in looked for time in splines.centres]
    groups = [pulses[first : first + FORCE_LOCATIONS.group_size] for first in range(0, len(pulses), FORCE_LOCATIONS.group_size)]
    model, there = probed(campaign.model), run_at_point(campaign.model, run, problem.with_held_fixed(point), coarse)
    return [problem.executor.submit(answers, model, there, campaign.channels, some, coarse) for some in groups]


def _gathered(
    problem: LeastSquaresProblem, run: Run, looked: Sequence[ForceLocation], jobs: Sequence[Future[Shown]]
) -> list[Floats]:
    """The whitened matrix of each place for one record."""
    shown = [one for job in jobs for one in job.result()]
    whitened_channels = [one for one in problem.whitened_channels if one.run == run.file]
    whole = np.vstack([one.whiten(np.column_stack([one.means(by[one.column]) for by in shown])) for one in whitened_channels])
    return [splines_of(run).tied(columns) for columns in np.split(whole, len(looked), axis=1)]


def answers(
    model: RopeModel,
    run: Run,
    channels: Mapping[str, Channel],
    pulses: Sequence[tuple[ForceLocation, float, float]],
    coarse: float,
) -> Shown:
    """Each channel of a run by the size of each pulse (place, time, width)."""
    directions = {str(k): {KEY + location.quantity: 1.0} for k, (location, _, _) in enumerate(pulses)}
    at = {
        str(k): {KEY + "height": location.height, KEY + "reach": location.reach, KEY + "time": time, KEY + "width": width}
        for k, (location, time, width) in enumerate(pulses)
    }
    by = replay_with_sensitivities(model, run, channels, directions, coarse * REPLAY.time_step, at)[1]
    return [by[name] for name in directions]
