"""Families of trip profiles, each with a few normalised parameters between 0 and 1, and the drive that results from them.

The parameters scale the limits of speed and jerk, the moving average and the period of the shaper; the acceleration follows
from the travel time.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from comprope.drive.parameters import SHORTEST_SMOOTHING, Drive, Profile, Shaper
from comprope.drive.trajectory.reference_trajectory import ReferenceTrajectory, reference_trajectory
from comprope.drive.trajectory.s_curve import plan_s_curve

REST_BEFORE = 0.1  # s at rest before a trip in the search
MIN_ACCELERATION_SHARE = 0.05  # of the largest acceleration: slower trips are not looked for
SHARES = {"speed": (0.1, 1.0), "jerk": (0.06, 1.0), "smoothing": (0.0, 0.5), "period": (0.05, 1.4)}
EI = 0.05  # tolerance of the EI shaper
KINDS: Mapping[str, tuple[int, float, bool]] = {  # impulses, tolerance, smoothing
    "S-curve": (1, 0.0, False), "smooth": (1, 0.0, True), "ZV": (2, 0.0, True), "ZVD": (3, 0.0, True), "EI": (3, EI, True),
}  # fmt: skip


@dataclass(frozen=True)
class Route:
    """A trip between two heights [m], and the rope's natural periods [s] with the car near a landing and at mid-height."""

    origin: float
    destination: float
    periods: tuple[float, float]

    @property
    def distance(self) -> float:
        """Distance [m]."""
        return abs(self.destination - self.origin)


def share_names(kind: str) -> tuple[str, ...]:
    """Names of the parameters of a family."""
    impulses, _, smooth = KINDS[kind]
    return ("speed", "jerk", *(["smoothing"] if smooth else []), *(["period"] if impulses > 1 else []))


def drive_for(drive: Drive, kind: str, shares: Mapping[str, float], periods: tuple[float, float], acceleration: float) -> Drive:
    """The drive with profile and shaper of a family; `shares` of the drive's limits, the average in tenths of a period."""
    impulses, tolerance, _ = KINDS[kind]
    own, factor = drive.profile, shares.get("period", 1.0)
    smoothing = shares.get("smoothing", 0.0) * periods[0]
    profile = Profile(
        speed=own.speed * shares["speed"], acceleration=acceleration, jerk=own.jerk * shares["jerk"],
        smoothing=smoothing if smoothing >= SHORTEST_SMOOTHING else 0.0,
    )  # fmt: skip
    landing, middle = (max(0.1, min(60.0, factor * one)) for one in periods)
    shaper = Shaper(
        impulses=float(impulses), period_landing=landing, period_middle=middle, damping=drive.shaper.damping, tolerance=tolerance
    )
    return drive.model_copy(update={"profile": profile, "shaper": shaper})


def trajectory_of(drive: Drive, route: Route, start: float = REST_BEFORE) -> ReferenceTrajectory:
    """Reference trajectory of a drive on a trip."""
    return reference_trajectory(drive, plan_s_curve(drive.profile, route.origin, route.destination, start))


def drive_in_time(drive: Drive, kind: str, shares: Mapping[str, float], routes: list[Route], time: float) -> Drive | None:
    """The drive with these parameters whose trips take `time` [s] in total; None if it cannot be so fast.

    The acceleration is found by bisection, within the drive's own limit.
    """
    maximum = drive.profile.acceleration

    def made(acceleration: float) -> tuple[Drive, float]:
        one = drive_for(drive, kind, shares, routes[0].periods, acceleration)
        return one, sum(trajectory_of(one, route).duration for route in routes)

    low, high = MIN_ACCELERATION_SHARE * maximum, maximum
    best, fastest = made(high)
    if fastest > time * (1.0 + 1e-9):
        return None
    slowest, needed = made(low)
    if needed <= time:
        return slowest
    for _ in range(30):
        middle = 0.5 * (low + high)
        one, needed = made(middle)
        if needed <= time:
            high, best = middle, one
        else:
            low = middle
    return best
