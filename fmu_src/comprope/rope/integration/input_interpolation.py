"""The last samples of the ends' inputs, and the path of the ends that is interpolated from them.

The array `samples` holds the times of the last four samples [s], the samples of each path, where each path has got to
(position, velocity, acceleration), the time put off [s] to the next step, and the last acceleration of the base. All but the
last sample are at least SHORTEST_HORIZON apart. `options` says whether velocities and accelerations are given, and whether inputs
hold for the end of the step. See `simulator.end_motion`.
"""

from ...kernels.jit import kernel
from ..mechanics.end_conditions import PATH, PATHS, follow
from ..parameters.parameter_vector import R
from ..runtime.kernel_arguments import Ends, RopeData, Workspace
from ..runtime.status import SUCCESS, TOO_FAR, TOO_FAST
from .inputs import BASE_A, CAR, CAR_OUT, CAR_V, COUNTERWEIGHT, COUNTERWEIGHT_OUT, COUNTERWEIGHT_V

SAMPLES = 4
NEWEST = SAMPLES - 1
REACHED = SAMPLES + PATHS * SAMPLES
DEFERRED = REACHED + PATHS * 3
BASE_REACHED = DEFERRED + 1
INPUT_MEMORY = BASE_REACHED + 1
DERIVATIVES, AT_END = range(2)  # entries of `options`

# Of each path (car x, car y, counterweight x, counterweight y): its input, and how that becomes x (down) or y.
PLACES = (CAR, CAR_OUT, COUNTERWEIGHT, COUNTERWEIGHT_OUT)
SIGNS = (-1.0, -1.0, -1.0, 1.0)
RADII = (0.0, -1.0, 0.0, 1.0)
SHORTEST_STEP = 1e-6  # s; accelerations are second differences, which rounding spoils below: such a step is put off to the next
# s, less than communication steps in use. A shorter step is a part of the motion to where the end is to be after this time, and
# samples closer to each other are not differenced: else an input off by a micrometre would become an acceleration without bound.
SHORTEST_HORIZON = 4e-4
FASTEST_END = 50.0  # m/s, twice the rated speed of the fastest drive that can be simulated
LARGEST_JUMP = 0.05  # m, between values at the same time: ropes of a hoist settle when their load appears, and sensors have noise
RATES = (CAR_V, -1, COUNTERWEIGHT_V, -1)  # the input with its velocity; its acceleration comes next


@kernel
def sample(p, u, k):
    """Sample of path k from the present inputs."""
    return SIGNS[k] * u[PLACES[k]] + RADII[k] * p[R]


@kernel
def start_inputs(rope: RopeData, ends: Ends, t: float) -> None:
    """Rest before the start: equal samples a second apart, and ends without velocity."""
    p, u, past = rope.p, ends.u, ends.samples
    for j in range(SAMPLES):
        past[j] = t - float(NEWEST - j)
    for k in range(PATHS):
        for j in range(SAMPLES):
            past[SAMPLES + SAMPLES * k + j] = sample(p, u, k)
        past[REACHED + 3 * k] = sample(p, u, k)
        past[REACHED + 3 * k + 1] = 0.0
        past[REACHED + 3 * k + 2] = 0.0
    past[DEFERRED] = 0.0
    past[BASE_REACHED] = u[BASE_A]


@kernel
def parabola(t0, t1, t2, x0, x1, x2, t):
    """Value, slope and curvature at time t of the parabola through three points, by Newton's divided differences."""
    first, second = (x1 - x0) / (t1 - t0), (x2 - x1) / (t2 - t1)
    bow = (second - first) / (t2 - t0)
    value = x2 + (t - t2) * (second + (t - t1) * bow)
    return value, second + bow * (2.0 * t - t1 - t2), 2.0 * bow


@kernel
def extrapolated(past, k, t):
    """Value, slope and curvature of path k at time t from the last sample and the two before it that are not too close to it."""
    i = 1 if past[NEWEST] - past[NEWEST - 1] >= SHORTEST_HORIZON else 0
    b = SAMPLES + SAMPLES * k
    return parabola(past[i], past[i + 1], past[NEWEST], past[b + i], past[b + i + 1], past[b + NEWEST], t)


@kernel
def at_rest(past):
    """Whether all samples of every path are equal."""
    for k in range(PATHS):
        b = SAMPLES + SAMPLES * k
        for j in range(NEWEST):
            if past[b + j] != past[b + NEWEST]:
                return False
    return True


@kernel
def store_sample(p, u, time, past):
    """Store the inputs as the sample at a time [s]; one at the last sample's time, or close to the one before, replaces it."""
    if time > past[NEWEST]:
        step = max(time - past[NEWEST], SHORTEST_HORIZON)
        # While nothing has moved, rest is assumed up to the last sample.
        if at_rest(past):
            for j in range(NEWEST):
                past[j] = time - (NEWEST - j) * step
        elif past[NEWEST] - past[NEWEST - 1] >= SHORTEST_HORIZON:
            for b in range(0, REACHED, SAMPLES):
                for j in range(NEWEST):
                    past[b + j] = past[b + j + 1]
        past[NEWEST] = time
    for k in range(PATHS):
        past[SAMPLES + SAMPLES * k + NEWEST] = sample(p, u, k)


@kernel
def target(u, options, past, k, t):
    """Position, velocity and acceleration that path k shall have at time t."""
    if options[DERIVATIVES] == 0.0 or RATES[k] < 0:
        return extrapolated(past, k, t)
    v, a = SIGNS[k] * u[RATES[k]], SIGNS[k] * u[RATES[k] + 1]
    ahead = t - past[NEWEST]
    return past[SAMPLES + SAMPLES * k + NEWEST] + ahead * (v + 0.5 * ahead * a), v + ahead * a, a


@kernel
def check_motion(rope: RopeData, ends: Ends, work: Workspace, t: float, dt: float) -> int:
    """Refuse inputs of a step by which an end would jump or move too fast; returns SUCCESS or the kind of refusal."""
    p, u, options, past, message = rope.p, ends.u, ends.options, ends.samples, work.message
    time = t + dt if options[AT_END] != 0.0 else t
    since = max(time - past[NEWEST], 0.0)
    for k in range(PATHS):
        moved = abs(sample(p, u, k) - past[SAMPLES + SAMPLES * k + NEWEST])
        if not moved <= FASTEST_END * since + LARGEST_JUMP:
            message[0], message[1], message[2], message[3] = u[PLACES[k]], time, moved, since
            message[4], message[5] = FASTEST_END, LARGEST_JUMP
            return TOO_FAR + k
        if options[DERIVATIVES] != 0.0 and RATES[k] >= 0:
            v, a = u[RATES[k]], u[RATES[k] + 1]
            if not abs(v) + abs(a) * (t + dt - time) <= FASTEST_END:
                message[0], message[1], message[2], message[3] = v, a, time, FASTEST_END
                return TOO_FAST + k
    return SUCCESS


@kernel
def interpolate_base(ends):
    """Set the base's acceleration at both ends of the path: linear to an input of its end; one of its start is held."""
    now = ends.u[BASE_A]
    ends.base[0] = ends.samples[BASE_REACHED] if ends.options[AT_END] != 0.0 else now
    ends.base[1] = now
    ends.samples[BASE_REACHED] = now


@kernel
def interpolate_inputs(rope: RopeData, ends: Ends, t: float, dt: float) -> float:
    """Set the path of the ends up to t + dt [s]; they are at its end afterwards.

    Returns the duration of the path [s]: dt, and what earlier steps put off; 0 if this one is put off too.
    """
    p, u, options, past, path = rope.p, ends.u, ends.options, ends.samples, ends.path
    duration = dt + past[DEFERRED]
    if duration < SHORTEST_STEP:
        past[DEFERRED] = duration
        return 0.0
    past[DEFERRED] = 0.0
    store_sample(p, u, t + dt if options[AT_END] != 0.0 else t, past)
    interpolate_base(ends)
    horizon = max(duration, SHORTEST_HORIZON)
    for k in range(PATHS):
        for j in range(3):
            path[PATH * k + j] = past[REACHED + 3 * k + j]
        x, v, a = target(u, options, past, k, t + dt if horizon == duration else t + dt + (horizon - duration))
        path[PATH * k + 3], path[PATH * k + 4], path[PATH * k + 5] = x, v, a
        if duration < horizon:
            x, v, a = follow(path, k, horizon, duration / horizon)
            path[PATH * k + 3], path[PATH * k + 4], path[PATH * k + 5] = x, v, a
        b = REACHED + 3 * k
        past[b], past[b + 1], past[b + 2] = x, v, a
    return duration
