"""What a run has seen at any of its time steps: slack rope, the largest tension, and the sheave's limit switch."""

from ...kernels.jit import kernel
from ..parameters.parameter_vector import EA, PIT, RATIO, SWITCH
from ..runtime.array_layout import SHARE, TENSION
from .axial_law import SLACK_STRAIN

# Entries of State.record: segments that are slack now, time with slack rope [s], largest tension [N], whether the switch has
# tripped, and when [s].
SLACK_NOW, SLACK_TIME, PEAK, TRIPPED, TRIP_TIME = range(5)
RECORD = 5
NOT_TRIPPED = -1.0  # s, what stands for the time of a switch that has not tripped


@kernel
def largest_tension(n, w):
    """The largest force of a segment [N]."""
    largest, b = w[TENSION * (n + 1)], TENSION * (n + 1)
    for e in range(1, n - 1):
        if w[b + e] > largest:
            largest = w[b + e]
    return largest


@kernel
def least_tension(n, w):
    """The least force of a segment [N]."""
    least, b = w[TENSION * (n + 1)], TENSION * (n + 1)
    for e in range(1, n - 1):
        if w[b + e] < least:
            least = w[b + e]
    return least


@kernel
def pushed_segments(n, p, w):
    """How many segments are pushed so much that a rope gives way."""
    count, m, most = 0, n + 1, -0.5 * p[EA] * SLACK_STRAIN
    if w[SHARE * m + n] > 0.0:
        for e in range(n - 1):
            count += 1 if w[TENSION * m + e] < most else 0
    return count


@kernel
def slack_segments(n, p, w):
    """How many segments are slack: pushed, and no rod."""
    return 0 if p[RATIO] == 1.0 else pushed_segments(n, p, w)


@kernel
def record_step(n, t, h, p, q, w, record):
    """Add a time step of length h [s], ended at t with the axle at q[n], to the record; h is 0 at the start."""
    record[SLACK_NOW] = slack_segments(n, p, w)
    if record[SLACK_NOW] > 0.0:
        record[SLACK_TIME] += h
    record[PEAK] = max(record[PEAK], largest_tension(n, w))
    if record[TRIPPED] == 0.0:
        record[TRIP_TIME] = NOT_TRIPPED
        if abs(p[PIT] - q[n]) >= p[SWITCH]:
            record[TRIPPED], record[TRIP_TIME] = 1.0, t
