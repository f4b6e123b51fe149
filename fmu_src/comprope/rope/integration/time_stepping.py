"""One communication step: how many time steps it takes, and what to tell if one of them is lost."""

from math import ceil

from ..mechanics.end_conditions import PATH
from ..mechanics.energy import tally
from ..runtime.jit import kernel
from ..runtime.parameter_vector import ELEMENT, slot
from ..runtime.status import FINE, LOST, LOST_AT_SHEAVE, TOO_LONG
from .newmark import DEEPEST, HALVED, STEPS, WORST, attempt, copy


@kernel
def accept(n, state_size, q, v, a, f, h1, q0, v0, a0, f0, h0):
    """Make the trial state the accepted one."""
    copy(2 * (n + 1), q, q0)
    copy(2 * (n + 1), v, v0)
    copy(2 * (n + 1), a, a0)
    copy(2 * (n + 1), f, f0)
    copy(state_size, h1, h0)


@kernel
def march(
    n, t0, dt, steps, p, path, q0, v0, a0, f0, h0, q, v, a, f, h1, w, A, L, B, Z, r, touch, power, P0, P, E, count,
    state_size, effects,
):  # fmt: skip
    """Advance the accepted state (q0, v0, a0, f0, h0) from t0 to t0 + dt in `steps` equal steps.

    Returns the fraction of dt that was reached: 1 when all went well. Time is always t0 plus a
    fraction of dt, never a running sum.
    """
    for k in range(steps):
        done, size, depth = 0.0, 1.0, 0
        while done < 1.0:
            s = (k + done + size) / steps
            h = size * dt / steps
            if attempt(n, t0 + s * dt, h, p, path, dt, s, q0, v0, a0, f0, h0,
                       q, v, a, f, h1, w, A, L, B, Z, r, touch, power, count):  # fmt: skip
                tally(n, p, h, q0, q, v, a, f, w, touch, power, effects, P0, P, E)
                accept(n, state_size, q, v, a, f, h1, q0, v0, a0, f0, h0)
                done += size
                count[STEPS] += 1
            else:
                count[HALVED] += 1
                size, depth = 0.5 * size, depth + 1
                if depth > DEEPEST:
                    return (k + done) / steps
    return 1.0


STEP = slot("solver.step")
PASSED = 0.6  # of an element may run onto the sheave in one time step: keeps displacements within 0.05 mm at any speed
MOST = 1e6  # time steps in one communication step: minutes of computing, so it is a mistake


@kernel
def travel(
    n, dt, p, path, q0, v0, a0, f0, h0, q, v, a, f, h1, w, A, L, B, Z, r, touch, power, P0, P, E, count, time,
    state_size, effects, told,
):  # fmt: skip
    """Advance the accepted state by dt [s] while the ends follow their path; returns FINE or the kind of failure.

    After a failure the state is that of the last accepted time step, and `time` that of the step's start.
    """
    t0, steps = time[0], time_steps(dt, p, path, time, told)
    if steps == 0:
        return TOO_LONG
    reached = march(n, t0, dt, steps, p, path, q0, v0, a0, f0, h0, q, v, a, f, h1, w, A, L, B, Z, r, touch, power,
                    P0, P, E, count, state_size, effects)  # fmt: skip
    if reached == 1.0:
        time[0] = t0 + dt
        return FINE
    return where(n, p, t0 + reached * dt, dt / steps / 2.0**DEEPEST, q0, count, told)


@kernel
def time_steps(dt, p, path, time, told):
    """How many equal time steps a communication step of dt [s] takes; 0, and what to tell, if they are too many."""
    share, fastest = dt / p[STEP], speed(path)
    passed = dt * fastest / (PASSED * p[ELEMENT])
    if not (share <= MOST and passed <= MOST):
        told[0], told[1], told[2], told[3] = dt, time[0], fastest, MOST
        return 0
    return max(1, ceil(share * (1.0 - 1e-9)), ceil(passed))


@kernel
def speed(path):
    """The larger of both ends' vertical speeds [m/s], at the start and at the close of a path."""
    car, counterweight = 1, 2 * PATH + 1
    fastest = max(abs(path[car]), abs(path[car + 3]))
    return max(fastest, abs(path[counterweight]), abs(path[counterweight + 3]))


@kernel
def where(n, p, t, smallest, q0, count, told):
    """Tell at which time a step was lost, how short it was, and at which node it went wrong."""
    worst = int(count[WORST]) % (n + 1)
    told[0], told[1], told[2], told[3] = t, smallest, worst * p[ELEMENT], -q0[worst]
    if worst < n:
        return LOST
    told[2] = -q0[n]
    return LOST_AT_SHEAVE
