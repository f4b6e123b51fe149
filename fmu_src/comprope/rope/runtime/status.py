"""Status of the rope's kernels, and the message to each."""

from collections.abc import Iterable

from ...errors import CompropeError, InputError, SimulationError
from ...kernels import status as kernel_status

SUCCESS, OUT_OF_REACH, NO_EQUILIBRIUM, LOST, LOST_AT_SHEAVE, TOO_MANY_STEPS, TOO_COARSE, OUT_OF_PLACE = range(8)
# An end that moves too far, and one that is too fast, for each path of `end_conditions`.
TOO_FAR, TOO_FAST = 8, 12
NOT_WHOLE = 16
_PATHS = ("car_position", "car_lateral_displacement", "counterweight_position", "counterweight_lateral_displacement")
_TOO_FAR = (
    "%s = %%g m at t = %%g s: %%g m from its last value, %%g s earlier; at most %%g m/s, and jumps of at most %%g m, are "
    "accepted; values at initialization must be those of the first step"
)
_TOO_FAST = "%s = %%g m/s with %%g m/s2 at t = %%g s: a velocity of at most %%g m/s is accepted throughout the step"

MESSAGES: dict[int, tuple[type[CompropeError], str, int]] = {
    OUT_OF_REACH: (
        InputError,
        "car_position = %g m with counterweight_position = %g m at t = %g s: the rope of %g m would hang the axle at %g m; "
        "both ends at least sheave.radius = %g m above it are accepted",
        6,
    ),
    NO_EQUILIBRIUM: (
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
    TOO_MANY_STEPS: (
        InputError,
        "communication step = %g s from t = %g s with rope ends of up to %g m/s: more than %g time steps, which is not accepted",
        4,
    ),
    TOO_COARSE: (
        InputError,
        "rope.element_length = %g m is too coarse for the sheave; at most half of sheave.radius = %g m is accepted",
        2,
    ),
    NOT_WHOLE: (InputError, "sheave.ropes: %g ropes; a whole number is accepted", 1),
    OUT_OF_PLACE: (
        InputError,
        "car_position = %g m with counterweight_position = %g m at the start: the axle would hang at %g m, and is built at %g m; "
        "at most %g m from there is accepted, as with counterweight_position = shaft.height - car_position",
        5,
    ),
}
MESSAGES |= {TOO_FAR + k: (InputError, _TOO_FAR % name, 6) for k, name in enumerate(_PATHS)}
MESSAGES |= {TOO_FAST + k: (InputError, _TOO_FAST % name.replace("position", "velocity"), 4) for k, name in enumerate(_PATHS)}


def require_success(status: float, values: Iterable[float]) -> None:
    """Raise the error that a kernel's status other than SUCCESS stands for, its message with these values."""
    kernel_status.require_success(MESSAGES, status, values)
