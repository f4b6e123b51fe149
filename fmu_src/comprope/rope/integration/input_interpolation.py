"""The last samples of the ends' inputs, and the path of the ends that is interpolated from them.

The array `samples` holds the times of the last three samples [s], the samples of each path, and where each path has got to
(position, velocity, acceleration). `options` says whether velocities and accelerations are given, and
whether inputs hold for the end of the step. See `simulator.end_motion`.
"""

from ..mechanics.end_conditions import PATH, PATHS
from ..runtime.jit import kernel
from ..runtime.kernel_arguments import Ends, RopeData
from ..runtime.parameter_vector import R
from .inputs import CAR, CAR_OUT, CAR_V, COUNTERWEIGHT, COUNTERWEIGHT_OUT, COUNTERWEIGHT_V

SAMPLES = 3
REACHED = SAMPLES + PATHS * SAMPLES
INPUT_MEMORY = REACHED + PATHS * 3
DERIVATIVES, AT_END = range(2)  # entries of `options`

# Of each path (car x, car y, counterweight x, counterweight y): its input, and how that becomes x (down) or y.
PLACES = (CAR, CAR_OUT, COUNTERWEIGHT, COUNTERWEIGHT_OUT)
SIGNS = (-1.0, -1.0, -1.0, 1.0)
RADII = (0.0, -1.0, 0.0, 1.0)
RATES = (CAR_V, -1, COUNTERWEIGHT_V, -1)  # the input with its velocity; its acceleration comes next


@kernel
def sample(p, u, k):
    """Sample of path k from the present inputs."""
    return SIGNS[k] * u[PLACES[k]] + RADII[k] * p[R]


@kernel
def start_inputs(rope: RopeData, ends: Ends, t: float) -> None:
    """Rest before the start: three equal samples a second apart, and ends without velocity."""
    p, u, past = rope.p, ends.u, ends.samples
    past[0], past[1], past[2] = t - 2.0, t - 1.0, t
    for k in range(PATHS):
        for j in range(SAMPLES):
            past[SAMPLES + SAMPLES * k + j] = sample(p, u, k)
        past[REACHED + 3 * k] = sample(p, u, k)
        past[REACHED + 3 * k + 1] = 0.0
        past[REACHED + 3 * k + 2] = 0.0


@kernel
def parabola(times, values, base, t):
    """Value, slope and curvature at time t of the parabola through three points, by Newton's divided differences."""
    t0, t1, t2 = times[0], times[1], times[2]
    x0, x1, x2 = values[base], values[base + 1], values[base + 2]
    first, second = (x1 - x0) / (t1 - t0), (x2 - x1) / (t2 - t1)
    bow = (second - first) / (t2 - t0)
    value = x2 + (t - t2) * (second + (t - t1) * bow)
    return value, second + bow * (2.0 * t - t1 - t2), 2.0 * bow


@kernel
def at_rest(past):
    """Whether all samples of every path are equal."""
    for k in range(PATHS):
        b = SAMPLES + SAMPLES * k
        if past[b] != past[b + 1] or past[b] != past[b + 2]:
            return False
    return True


@kernel
def store_sample(p, u, time, past):
    """Store the inputs as the sample at a time [s]; at the last sample's time they replace it."""
    if time > past[2]:
        step = time - past[2]
        # While nothing has moved, rest is assumed up to the last sample.
        if at_rest(past):
            past[0], past[1] = time - 2.0 * step, time - step
        else:
            past[0], past[1] = past[1], past[2]
        past[2] = time
        for b in range(SAMPLES, REACHED, SAMPLES):
            past[b], past[b + 1] = past[b + 1], past[b + 2]
    for k in range(PATHS):
        past[SAMPLES + SAMPLES * k + 2] = sample(p, u, k)


@kernel
def target(u, options, past, k, t):
    """Position, velocity and acceleration that path k shall have at time t."""
    if options[DERIVATIVES] == 0.0 or RATES[k] < 0:
        return parabola(past, past, SAMPLES + SAMPLES * k, t)
    v, a = SIGNS[k] * u[RATES[k]], SIGNS[k] * u[RATES[k] + 1]
    ahead = t - past[2]
    return past[SAMPLES + SAMPLES * k + 2] + ahead * (v + 0.5 * ahead * a), v + ahead * a, a


@kernel
def interpolate_inputs(rope: RopeData, ends: Ends, t: float, dt: float) -> None:
    """Set the path of the ends from t to t + dt [s]; they are at its end afterwards."""
    p, u, options, past, path = rope.p, ends.u, ends.options, ends.samples, ends.path
    store_sample(p, u, t + dt if options[AT_END] != 0.0 else t, past)
    for k in range(PATHS):
        for j in range(3):
            path[PATH * k + j] = past[REACHED + 3 * k + j]
        x, v, a = target(u, options, past, k, t + dt)
        b = REACHED + 3 * k
        past[b], past[b + 1], past[b + 2] = x, v, a
        path[PATH * k + 3], path[PATH * k + 4], path[PATH * k + 5] = x, v, a
