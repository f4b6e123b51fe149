"""Status of the drive's kernels, and the message to each; those of parameters are without the component's name."""

from ..errors import InputError, SimulationError
from ..kernels.status import Messages

(
    SMOOTHING_TOO_SHORT, DOES_NOT_STOP, REVERSES, NOT_WHOLE, START_OUTSIDE, DESTINATION_OUTSIDE, BOTH_OUTSIDE, CAR_NOT_FINITE,
    COUNTERWEIGHT_NOT_FINITE, CALL_OUTSIDE, TOO_EARLY, TOO_WEAK, UNSTABLE, UNSTABLE_AT_TWO, UNSTABLE_AT_THREE, LEFT_SHAFT,
    TOO_MANY_PERIODS, BRAKE_OUTSIDE, GEAR_OUTSIDE, TRIPPED_OUTSIDE,
) = range(1, 21)  # fmt: skip
# Nine digits where a value has just passed another one, so that the sentence tells them apart.
_STOPS = "accepted is 0 to shaft.height = %.9g m"
_UNSTABLE = (
    "servo.position_bandwidth = %g rad/s, servo.speed_bandwidth = %g rad/s, servo.speed_damping = %g, servo.sample_period = "
    "%g s: unstable with the car at {}; gains are accepted that keep the loop stable, such as a lower bandwidth and "
    "position_bandwidth at most a quarter of speed_bandwidth"
)
# Of one component, whose name the FMU puts in front; pydantic does likewise.
COMPONENT_TEXTS: dict[int, tuple[str, str, int]] = {
    SMOOTHING_TOO_SHORT: ("profile", "smoothing = %.9g s: accepted is 0 (none) or %.9g to 20 s", 2),
    DOES_NOT_STOP: ("curve", "the sum of a1 to a19 is %.6g: accepted is 0, so that the car stops", 1),
    REVERSES: ("curve", "a1, a1 + a2 and so on: no sum below 0 is accepted, so that the car never reverses", 0),
    NOT_WHOLE: ("shaper", "impulses = %.15g: accepted is 1, 2 or 3", 1),
}
MESSAGES: Messages = {
    status: (InputError, f"{component}: {text}", count) for status, (component, text, count) in COMPONENT_TEXTS.items()
} | {
    START_OUTSIDE: (InputError, f"trip.start_position = %.9g m: {_STOPS}", 2),
    DESTINATION_OUTSIDE: (InputError, f"trip.destination = %.9g m: {_STOPS}", 2),
    BOTH_OUTSIDE: (InputError, f"trip.start_position = %.9g m and trip.destination = %.9g m: {_STOPS}", 3),
    CAR_NOT_FINITE: (InputError, "car_end_tension = %.9g N: a finite number is accepted", 1),
    COUNTERWEIGHT_NOT_FINITE: (InputError, "counterweight_end_tension = %.9g N: a finite number is accepted", 1),
    CALL_OUTSIDE: (InputError, "destination = %.9g m: 0 to shaft.height = %.9g m is accepted", 2),
    TOO_EARLY: (InputError, "trip.start_time = %.9g s: the start of the simulation, %.9g s, or later is accepted", 2),
    TOO_WEAK: (InputError, "servo.torque_limit = %.9g N.m: more than the %.9g N.m that hold the car initially is accepted", 2),
    UNSTABLE: (InputError, _UNSTABLE.format("%g m"), 5),
    UNSTABLE_AT_TWO: (InputError, _UNSTABLE.format("%g m and %g m"), 6),
    UNSTABLE_AT_THREE: (InputError, _UNSTABLE.format("%g m and %g m and %g m"), 7),
    LEFT_SHAFT: (
        SimulationError,
        "car at %.6g m at t = %.6g s has left the shaft of 0 to %g m: servo.torque_limit = %g N.m is too small for this trip "
        "and load",
        4,
    ),
    BRAKE_OUTSIDE: (InputError, "brake = %.9g: 0 (released) to 1 (fully applied) is accepted", 1),
    GEAR_OUTSIDE: (InputError, "safety_gear = %.9g: 0 (released) to 1 (fully applied) is accepted", 1),
    TRIPPED_OUTSIDE: (
        SimulationError,
        "car or counterweight at %.6g m at t = %.6g s has left the shaft of 0 to %g m after a trip: brake, safety gear or buffer "
        "does not stop it",
        3,
    ),
    TOO_MANY_PERIODS: (
        InputError,
        "communication step = %.9g s: at most %.9g s is accepted, a million times servo.sample_period",
        2,
    ),
}
