"""One communication step as a loop of time steps, with directional derivatives where they are asked for."""

from math import ceil

from ...kernels.jit import kernel
from ..mechanics.end_conditions import PATH
from ..mechanics.energy import update_balance
from ..mechanics.run_record import SLACK_NOW, pushed_segments, record_step
from ..mechanics.wall_motion import clear_wall_motion, set_wall_motion
from ..parameters.parameter_vector import BASE, BASE_BEFORE, ELEMENT, RATIO, slot
from ..runtime.kernel_arguments import Directions, Ends, Motion, RopeData, State, TimeStep, Workspace
from ..runtime.status import LOST, LOST_AT_SHEAVE, SUCCESS, TOO_MANY_STEPS
from .derivative_hook import advance_directions
from .newmark import HALVED, MOST_HALVINGS, STEPS, WORST, copy, newmark_step

STEP = slot("solver.step")
LARGEST_TRAVEL = 0.6  # of an element may run onto the sheave in one time step: keeps displacements within 0.05 mm at any speed
# s, longest step with slack rope, whose rule is of first order: it damps a sheave at 10 Hz by 0.25 w h, 2 % of critical.
SLACK_STEP = 1.01e-3
MOST_STEPS = 1e6  # time steps in one communication step: minutes of computing, so it is a mistake


@kernel
def advance(
    rope: RopeData, ends: Ends, dt: float, state: State, motion: Motion, work: Workspace, directions: Directions | None
) -> int:
    """Advance the state by dt [s] while the ends follow their path; returns SUCCESS or the kind of failure.

    After a failure the state is that of the last accepted time step, and its time that of the communication step's start.
    Without directions (None) the compiled code has no derivatives in it.
    """
    p, t0 = rope.p, state.time[0]
    steps = number_of_steps(dt, p, ends.path, t0, work.message)
    if steps == 0:
        return TOO_MANY_STEPS
    reached = take_steps(rope, ends, dt, steps, state, motion, work, directions)
    p[BASE], p[BASE_BEFORE] = 0.0, 0.0
    clear_wall_motion(p)
    if reached == 1.0:
        state.time[0] = t0 + dt
        return SUCCESS
    return report_lost_step(rope.n, p, t0 + reached * dt, dt / steps / 2.0**MOST_HALVINGS, state, work.message)


@kernel
def take_steps(rope, ends, dt, steps, state, motion, work, directions):
    """Advance the state by dt in `steps` equal time steps; one that does not converge is halved.

    Returns the fraction of dt that was reached: 1 when all went well. Time is always that of the start plus a
    fraction of dt, never a running sum. The rope is a rod in steps without slack: iterates on the way to a taut rope may push.
    """
    t0, p, path, base = state.time[0], rope.p, ends.path, ends.base
    ratio = p[RATIO]
    for k in range(steps):
        done, depth, slack = 0.0, 0, state.record[SLACK_NOW] > 0.0
        size = slack_share(dt / steps) if slack else 1.0
        while done < 1.0:
            s = (k + done + size) / steps
            step = TimeStep(t0 + s * dt, size * dt / steps, dt, s, slack)
            p[RATIO] = ratio if slack else 1.0
            p[BASE_BEFORE] = base[0] + (k + done) / steps * (base[1] - base[0])
            p[BASE] = base[0] + s * (base[1] - base[0])
            set_wall_motion(p, path, dt, s)
            if newmark_step(rope.n, p, path, step, state, motion, work):
                if not slack and ratio != 1.0 and pushed_segments(rope.n, p, work.w) > 0:
                    slack, size = True, min(size, slack_share(dt / steps))
                    continue  # again, with the rule for slack rope
                update_balance(rope, step, state, motion, work)
                if directions is not None:
                    copy(rope.history_size, state.history, directions.work.history_before)
                record_step(rope.n, step.t, step.h, p, motion.q, work.w, state.record)
                accept(rope, state, motion, work)
                if directions is not None:
                    advance_directions(rope, path, step, state, motion, work, directions)
                done += size
                slack = state.record[SLACK_NOW] > 0.0
                state.counters[STEPS] += 1
            else:
                state.counters[HALVED] += 1
                size, depth = 0.5 * size, depth + 1
                if depth > MOST_HALVINGS:
                    p[RATIO] = ratio
                    return (k + done) / steps
    p[RATIO] = ratio
    return 1.0


@kernel
def slack_share(h):
    """The part of a time step of length h [s] that is taken at a time while some of the rope is slack."""
    share = 1.0
    while share * h > SLACK_STEP:
        share *= 0.5
    return share


@kernel
def accept(rope, state, motion, work):
    """Make the motion that a time step has arrived at the accepted state."""
    size = 2 * (rope.n + 1)
    copy(size, motion.q, state.q)
    copy(size, motion.v, state.v)
    copy(size, motion.a, state.a)
    copy(size, work.f, state.f)
    copy(rope.history_size, work.history, state.history)


@kernel
def number_of_steps(dt, p, path, t0, message):
    """How many equal time steps a communication step of dt [s] takes; 0, and the message's values, if they are too many."""
    share, fastest = dt / p[STEP], largest_speed(path)
    travel = dt * fastest / (LARGEST_TRAVEL * p[ELEMENT])
    if not (share <= MOST_STEPS and travel <= MOST_STEPS):
        message[0], message[1], message[2], message[3] = dt, t0, fastest, MOST_STEPS
        return 0
    return max(1, ceil(share * (1.0 - 1e-9)), ceil(travel))


@kernel
def largest_speed(path):
    """The larger of both ends' vertical speeds [m/s], at the start and at the close of a path."""
    car, counterweight = 1, 2 * PATH + 1
    fastest = max(abs(path[car]), abs(path[car + 3]))
    return max(fastest, abs(path[counterweight]), abs(path[counterweight + 3]))


@kernel
def report_lost_step(n, p, t, smallest, state, message):
    """Set the message's values: at which time a step was lost, how short it was, and at which node it went wrong."""
    worst = int(state.counters[WORST]) % (n + 1)
    message[0], message[1], message[2], message[3] = t, smallest, worst * p[ELEMENT], -state.q[worst]
    if worst < n:
        return LOST
    message[2] = -state.q[n]
    return LOST_AT_SHEAVE
