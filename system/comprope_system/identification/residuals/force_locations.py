"""Locations at which an unknown force may act, and the responses of all channels to it.

The time history is a sum of cubic B-splines, c(t) = sum_k c_k B((t - t_k) / w), constant before the record begins. The response
to each spline is a derivative of the replay about the fitted plant; the splines are parameters of a probe in the form of a
user's effect, which only this analysis registers.
"""

from collections.abc import Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.interpolate import BSpline

from comprope.rope.effects import RopeModel, model_type, user_effects

from ..data.runs import Channel, Run
from ..estimation.weighted_least_squares import LeastSquaresProblem
from ..prediction.parameter_point import ParameterPoint, run_at_point
from ..prediction.replay import Floats, coarsening_factor
from ..prediction.replay_sensitivities import replay_with_sensitivities
from ..settings import FORCE_LOCATIONS, REPLAY

PROBE = Path(__file__).with_name("force_probe_effect.py")
KEY = "effects.residual_force."


@dataclass(frozen=True)
class ForceLocation:
    """Location of a force: name, quantity of the probe, unit, and the band of heights [m] of a lateral force."""

    name: str
    quantity: str
    unit: str
    height: float = 0.0
    reach: float = 1.0


Pulse = tuple[ForceLocation, float, float]  # location, time of the maximum [s], width [s]
Responses = list[dict[str, Floats]]  # of each pulse: every channel (n,) [SI per unit of the location]


def force_locations(model: RopeModel) -> list[ForceLocation]:
    """All locations at which an unknown force or motion of the ends is estimated."""
    sides = {"car": "under the car", "counterweight": "under the counterweight"}
    reach = model.shaft.height / FORCE_LOCATIONS.height_bands
    bands = [
        ForceLocation(f"a lateral force on the {side}'s side about {height:.3g} m up", f"{side}_side", "N/m", height, reach)
        for side in sides
        for height in reach * (np.arange(FORCE_LOCATIONS.height_bands) + 0.5)
    ]
    ends = [
        ForceLocation(f"{'a lateral' if way == 'out' else 'a vertical'} motion of the end {where}", f"{side}_end_{way}", "m")
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
    """Splines of one run: first time [s], distance [s], and number of coefficients."""

    begin: float
    spacing: float
    count: int

    @property
    def centres(self) -> Floats:
        """Times [s] of the maxima of all splines: (count + tied splines - 1,)."""
        return np.asarray(self.begin + self.spacing * np.arange(-1, self.count + FORCE_LOCATIONS.tied_splines - 2))

    def tied(self, columns: Floats) -> Floats:
        """Columns (n, count) by coefficients from those by splines, of which the first ones share a coefficient."""
        return np.column_stack([columns[:, : FORCE_LOCATIONS.tied_splines].sum(1), columns[:, FORCE_LOCATIONS.tied_splines :]])

    def at(self, time: Floats) -> Floats:
        """Value (n, count) of the function of each coefficient at `time` (n,) [s]."""
        one = BSpline.basis_element(np.arange(-2.0, 3.0), extrapolate=False)
        return self.tied(np.nan_to_num(one((time[:, None] - self.centres) / self.spacing)))


def splines_of(run: Run) -> Splines:
    """Splines over the record of a run."""
    length = float(run.time[-1] - run.time[0])
    spacing = max(FORCE_LOCATIONS.min_spacing, length / FORCE_LOCATIONS.max_splines)
    return Splines(float(run.time[0]), spacing, int(np.ceil(length / spacing)))


def with_probe(model: RopeModel) -> RopeModel:
    """The model with the probe among its effects; the probe must be registered."""
    table = model.model_dump(exclude_none=True)
    table["own_effects"] = (*model.own_effects, str(PROBE))
    return model_type(table["own_effects"]).model_validate(table)


def responses(problem: LeastSquaresProblem, point: ParameterPoint, locations: Sequence[ForceLocation]) -> list[list[Floats]]:
    """Whitened responses to each coefficient: for each location and run a matrix (data of the run, coefficients).

    Elements and time steps are those of screening. Raises `SimulationError` where a run cannot be simulated with them.
    """
    with user_effects.temporarily_registered(str(PROBE), PROBE.read_text(encoding="utf-8")):
        jobs = [_submit_responses(problem, point, run, locations) for run in problem.runs]
        by_run = [_whitened_matrices(problem, run, locations, one) for run, one in zip(problem.runs, jobs, strict=True)]
    return [[matrices[k] for matrices in by_run] for k in range(len(locations))]


def _submit_responses(
    problem: LeastSquaresProblem, point: ParameterPoint, run: Run, locations: Sequence[ForceLocation]
) -> list[Future[Responses]]:
    """Start the replays of one run with derivatives, each for a group of pulses."""
    campaign, coarse, splines = problem.campaign, coarsening_factor(problem.campaign.model), splines_of(run)
    pulses = [(location, float(time), splines.spacing) for location in locations for time in splines.centres]
    groups = [pulses[first : first + FORCE_LOCATIONS.group_size] for first in range(0, len(pulses), FORCE_LOCATIONS.group_size)]
    model, there = with_probe(campaign.model), run_at_point(campaign.model, run, problem.with_held_fixed(point), coarse)
    return [problem.executor.submit(pulse_responses, model, there, campaign.channels, some, coarse) for some in groups]


def _whitened_matrices(
    problem: LeastSquaresProblem, run: Run, locations: Sequence[ForceLocation], jobs: Sequence[Future[Responses]]
) -> list[Floats]:
    """Whitened matrix of each location for one run."""
    responses_found = [one for job in jobs for one in job.result()]
    whitened_channels = [one for one in problem.whitened_channels if one.run == run.file]
    whole = np.vstack(
        [one.whiten(np.column_stack([one.means(by[one.column]) for by in responses_found])) for one in whitened_channels]
    )
    return [splines_of(run).tied(columns) for columns in np.split(whole, len(locations), axis=1)]


def pulse_responses(
    model: RopeModel,
    run: Run,
    channels: Mapping[str, Channel],
    pulses: Sequence[Pulse],
    coarse: float,
) -> Responses:
    """Derivatives of each channel of a run by the size of each pulse."""
    directions = {str(k): {KEY + location.quantity: 1.0} for k, (location, _, _) in enumerate(pulses)}
    at = {
        str(k): {KEY + "height": location.height, KEY + "reach": location.reach, KEY + "time": time, KEY + "width": width}
        for k, (location, time, width) in enumerate(pulses)
    }
    by = replay_with_sensitivities(model, run, channels, directions, coarse * REPLAY.time_step, at)[1]
    return [by[name] for name in directions]
