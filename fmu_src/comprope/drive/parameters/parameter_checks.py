"""Checks of parameters that belong together. Each returns a status; they know no other kernels, since pydantic calls them too."""

from ...kernels.jit import kernel
from ...kernels.status import SUCCESS
from ..status import BOTH_OUTSIDE, DESTINATION_OUTSIDE, DOES_NOT_STOP, NOT_WHOLE, REVERSES, SMOOTHING_TOO_SHORT, START_OUTSIDE

INTERVALS = 20  # intervals of the travel time, for free-form trips
SHORTEST_SMOOTHING = 0.01  # s, shortest moving average; below it rounding errors dominate
FINAL_SPEED_TOLERANCE = 1e-9  # accepted final speed of a free-form trip, relative to largest acceleration times travel time


@kernel
def check_smoothing(smoothing, message):
    """The moving average is not too short."""
    message[0], message[1] = smoothing, SHORTEST_SMOOTHING
    return SMOOTHING_TOO_SHORT if 0.0 < smoothing < SHORTEST_SMOOTHING else SUCCESS


@kernel
def check_curve(shares, at, message):
    """A free-form trip moves forward and stops; its shares begin at an index, and all zero is none."""
    tolerance = FINAL_SPEED_TOLERANCE * INTERVALS
    speed, lowest, highest, used = 0.0, 0.0, 0.0, False
    for k in range(at, at + INTERVALS - 1):
        speed += shares[k]
        lowest, highest = min(lowest, speed), max(highest, speed)
        used = used or shares[k] != 0.0
    message[0] = speed
    if used and abs(speed) > tolerance:
        return DOES_NOT_STOP
    return REVERSES if used and (lowest < -tolerance or highest <= 0.0) else SUCCESS


@kernel
def check_impulses(count, message):
    """The number of impulses is whole."""
    message[0] = count
    return SUCCESS if count == 1.0 or count == 2.0 or count == 3.0 else NOT_WHOLE


@kernel
def check_stops(start, destination, height, message):
    """The first trip is within the shaft."""
    message[0], message[1], message[2] = start, height, height
    if start > height and destination > height:
        message[1] = destination
        return BOTH_OUTSIDE
    if destination > height:
        message[0] = destination
        return DESTINATION_OUTSIDE
    return START_OUTSIDE if start > height else SUCCESS
