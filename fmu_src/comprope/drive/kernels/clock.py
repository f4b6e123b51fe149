"""The drive's time: whole sample periods since the start, and the part of the present one."""

from ...kernels.jit import kernel
from .arguments import ELAPSED, PERIODS, START_TIME
from .parameter_vector import SAMPLE_PERIOD


@kernel
def now(p, clock):
    """The time reached [s]."""
    return clock[START_TIME] + (clock[PERIODS] * p[SAMPLE_PERIOD] + clock[ELAPSED])
