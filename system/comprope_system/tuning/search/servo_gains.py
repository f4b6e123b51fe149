"""Servo gains that maximise the damping of the car's vertical vibration subject to stability margins."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import product

import numpy as np

from comprope.drive.control.stability_margins import Margins, margins, unstable_positions
from comprope.drive.parameters import Drive, Servo

from ...vibration.reduced_model.hoist_bounce import hoist_bounce

MIN_GAIN_MARGIN, MIN_PHASE_MARGIN, MIN_DELAY_MARGIN = 2.0, 45.0, 0.02  # factor, degrees, s
POSITION = (0.5, 1.0, 1.5)  # of the present position bandwidth
SPEED = (0.3, 0.45, 0.7, 1.0, 1.5)  # of the present speed bandwidth
DAMPING = (0.7, 1.2)


@dataclass(frozen=True)
class Gains:
    """A servo with its worst margins over car positions, and the mean damping ratio of the slower vibration."""

    servo: Servo
    gain: float
    phase: float
    delay: float
    bounce: float

    @property
    def margins_met(self) -> bool:
        """Whether the required margins are met."""
        return self.gain >= MIN_GAIN_MARGIN and self.phase >= MIN_PHASE_MARGIN and self.delay >= MIN_DELAY_MARGIN

    def to_json(self) -> dict[str, float]:
        """As JSON holds it."""
        own = {key: getattr(self.servo, key) for key in ("position_bandwidth", "speed_bandwidth", "speed_damping")}
        return own | {key: value for key, value in asdict(self).items() if key != "servo"}


def loop_margins(drive: Drive) -> Gains:
    """Margins of a drive's servo: worst gain margin up or down, phase [degrees], delay [s]."""
    places = (0.0, 0.5 * drive.shaft.height, drive.shaft.height)
    found: Sequence[Margins] = [margins(drive, place) for place in places]
    gain = min(min(one.upper_gain_margin, one.lower_gain_margin) for one in found)
    delay = min(np.radians(one.phase_margin) / one.crossover_frequency for one in found)
    return Gains(drive.servo, gain, min(one.phase_margin for one in found), float(delay), float(_bounce_damping(drive)))


def best_gains(drive: Drive) -> Gains:
    """The gains with the highest damping within the margins, near the present ones; the present ones if none are better."""
    present = loop_margins(drive)
    for one in sorted(_candidates(drive), key=_bounce_damping, reverse=True):
        if present.margins_met and _bounce_damping(one) <= present.bounce:
            return present
        if not unstable_positions(one) and (made := loop_margins(one)).margins_met:
            return made
    return present


def _candidates(drive: Drive) -> list[Drive]:
    """The drive with other gains, position control well below speed control."""
    own, found = drive.servo, []
    for position, speed, damping in product(POSITION, SPEED, DAMPING):
        gains = {"position_bandwidth": position * own.position_bandwidth, "speed_bandwidth": speed * own.speed_bandwidth}
        if gains["position_bandwidth"] <= 0.25 * gains["speed_bandwidth"]:
            servo = own.model_copy(update=gains | {"speed_damping": damping})
            found.append(drive.without_trips.model_copy(update={"servo": servo}))
    return found


def _bounce_damping(drive: Drive) -> float:
    """Mean damping ratio of the slower vibration over car positions."""
    hoist = hoist_bounce(drive)
    slower = np.argmin(hoist.frequency, axis=0)
    return float(hoist.damping[slower, np.arange(len(slower))].mean())
