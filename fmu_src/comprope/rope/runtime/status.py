"""What a kernel tells when it must refuse or give up: a number for the kind, numbers to fill in, and here the words.

The texts have C's and Python's common form of `%`, so that a program without Python fills in the same.
"""

from collections.abc import Iterable

from ...errors import CompropeError, InputError, SimulationError

FINE, OUT_OF_REACH, NO_REST, LOST, LOST_AT_SHEAVE, TOO_LONG, TOO_COARSE = range(7)
TOLD = 6  # numbers at most

# For each kind: whether it is the user's values or the computation that went wrong, the text, how many numbers it takes.
WORDS: dict[int, tuple[type[CompropeError], str, int]] = {
    OUT_OF_REACH: (
        InputError,
        "car_position = %g m with counterweight_position = %g m at t = %g s: the rope of %g m would hang the axle at %g m; "
        "both ends at least sheave.radius = %g m above it are accepted",
        6,
    ),
    NO_REST: (
        SimulationError,
        "no shape at rest was found with car end at %g m, counterweight end at %g m and sheave.mass = %g kg",
        3,
    ),
    LOST: (
        SimulationError,
        "the time step at t = %.6f s did not converge even when halved to %.1e s; worst at %.2f m along the rope from the car, "
        "height %.3f m",
        4,
    ),
    LOST_AT_SHEAVE: (
        SimulationError,
        "the time step at t = %.6f s did not converge even when halved to %.1e s; worst at the sheave, height %.3f m",
        3,
    ),
    TOO_LONG: (
        InputError,
        "communication step = %g s from t = %g s with rope ends of up to %g m/s: more than %g time steps, which is not accepted",
        4,
    ),
    TOO_COARSE: (
        InputError,
        "rope.element_length = %g m is too coarse for the sheave; at most half of sheave.radius = %g m is accepted",
        2,
    ),
}


def require_fine(status: float, told: Iterable[float]) -> None:
    """Raise what a kernel's status other than FINE stands for, with the numbers it told."""
    if status != FINE:
        error, text, count = WORDS[int(status)]
        raise error(text % tuple(list(told)[:count]))
