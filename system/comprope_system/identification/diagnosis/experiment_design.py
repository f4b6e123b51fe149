"""Experiment design: the run in which the two best fits differ most, each as fitted to the measured runs.

The criterion is the whitened distance of their predictions, as in discrimination between models (Hunter and Reiner 1965).
"""

from concurrent.futures import Executor
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comprope.errors import CompropeError
from comprope.rope.simulator.rope import values_of

from ...measurements import Trip
from ...measurements.motion.jerk_limited_profile import jerk_limited
from ..data.campaign import Campaign
from ..data.runs import Run
from ..data.whitening import whiten_channel
from ..estimation.gauss_newton import FitResult
from ..prediction.parameter_point import collect_predictions, submit_replays
from ..prediction.replay import coarsening_factor
from ..settings import EXPERIMENTS
from .diagnose import Diagnosis

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ProposedRun:
    """Run to measure: factor of the sheave's mass, trip [m, m/s], and rms distance of both fits in standard deviations."""

    weight: float
    start: float
    end: float
    speed: float
    distance: float

    def sentence(self) -> str:
        """The run in one line."""
        way = "up" if self.end > self.start else "down"
        trip = f"{way} from {self.start:.3g} m to {self.end:.3g} m at {self.speed:.3g} m/s"
        return f"{trip} with {self.weight:g} times the sheave's weight"

    def to_json(self) -> dict[str, Any]:
        """Everything, in SI units."""
        return {
            "sheave_weight_factor": self.weight, "start": self.start, "end": self.end, "speed": self.speed,
            "distance": self.distance,
        }  # fmt: skip


def is_inconclusive(diagnosis: Diagnosis) -> bool:
    """Whether another run could change the verdict: it is doubtful, or the effect is unknown."""
    return (
        diagnosis.kind != "adequate" and max(diagnosis.probabilities.values()) < EXPERIMENTS.conclusive_probability
    ) or diagnosis.kind == "unknown_effect"


def best_two_fits(diagnosis: Diagnosis) -> tuple[tuple[str, FitResult], tuple[str, FitResult]] | None:
    """The two best fits on the full model with their names, the plant alone among them; None if there is only that."""
    fitted = [(one.hypothesis.effect, one.fitted) for one in diagnosis.ranking if one.refined]
    found = sorted([*fitted, ("nothing missing", diagnosis.baseline)], key=lambda one: one[1].chi_square)
    return (found[0], found[1]) if len(found) > 1 else None


def rank_candidate_runs(diagnosis: Diagnosis, executor: Executor) -> list[ProposedRun]:
    """Candidate runs by the distance of the two best fits, largest first; the fits are not repeated with the new run.

    Both are predicted on the coarse mesh, whose error is nearly the same in both.
    """
    pair = best_two_fits(diagnosis)
    if pair is None:
        return []
    tried, coarse = list(candidate_runs(diagnosis.campaign)), coarsening_factor(diagnosis.campaign.model)
    jobs = [
        (one, run, [submit_replays(diagnosis.campaign, [run], fitted.point, executor, coarse) for _, fitted in pair])
        for one, run in tried
    ]
    found = []
    for one, run, both in jobs:
        try:
            a, b = (collect_predictions([run], some) for some in both)
        except CompropeError:  # a mass or a trip that the model does not accept
            continue
        found.append(replace(one, distance=_distance(diagnosis.campaign, run, a, b)))
    return sorted(found, key=lambda one: -one.distance)


def candidate_runs(campaign: Campaign) -> list[tuple[ProposedRun, Run]]:
    """All combinations of sheave mass, distance, speed and direction, within the positions that measured runs have covered."""
    height = campaign.model.shaft.height
    lowest = min(float(run.trip.position(run.time).min()) for run in campaign.runs)
    highest = max(float(run.trip.position(run.time).max()) for run in campaign.runs)
    top = max(float(np.abs(run.trip.velocity(run.time)).max()) for run in campaign.runs)
    acceleration = max(float(np.abs(run.trip.acceleration(run.time)).max()) for run in campaign.runs)
    found = []
    for weight, share, speed, up in product(EXPERIMENTS.weights, EXPERIMENTS.distances, EXPERIMENTS.speeds, (True, False)):
        reach = min(share * height, highest - lowest)
        ends = (lowest, lowest + reach) if up else (highest, highest - reach)
        one = ProposedRun(weight, *ends, min(speed * top, (EXPERIMENTS.acceleration_share * acceleration * reach) ** 0.5), 0.0)
        found.append((one, _run(campaign, one, acceleration)))
    return found


def _run(campaign: Campaign, one: ProposedRun, acceleration: float) -> Run:
    """Trip with trapezoidal acceleration of the given maximum [m/s2], sampled with rests before and after."""
    ramp, way = one.speed / acceleration, abs(one.end - one.start)
    cruise = way / one.speed - 1.5 * ramp
    phases = np.array([0.5 * ramp, 0.5 * ramp, 0.5 * ramp, cruise, 0.5 * ramp, 0.5 * ramp, 0.5 * ramp])
    trip = Trip((jerk_limited(one.start, one.end - one.start, EXPERIMENTS.rest_before, phases),), 0.0, "profile")
    time = np.arange(0.0, trip.rest_after + EXPERIMENTS.rest_after, EXPERIMENTS.sampling_interval)
    base = values_of(campaign.model)
    changes: dict[str, Any] = {"sheave.mass": one.weight * base["sheave.mass"]}
    if any("sheave.inertia" in run.changes for run in campaign.runs):
        changes["sheave.inertia"] = one.weight * base["sheave.inertia"]
    return Run("proposal", "fit", changes, time, trip.position(time), trip, trip.mirrored(campaign.model.shaft.height), {})


def _distance(campaign: Campaign, run: Run, a: dict[tuple[str, str], Floats], b: dict[tuple[str, str], Floats]) -> float:
    """Root mean square of the whitened difference of two predictions of a run."""
    total, count = 0.0, 0
    for column, channel in campaign.channels.items():
        one, other = a[run.file, column], b[run.file, column]
        weighed = whiten_channel(run, channel, one, np.isfinite(one) & np.isfinite(other), campaign.noise[column])
        if weighed:
            apart = weighed.whiten(weighed.means(one) - weighed.means(other))
            total, count = total + float(apart @ apart), count + len(apart)
    return float((total / max(count, 1)) ** 0.5)

