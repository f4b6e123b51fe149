"""Whole communication steps: equal time steps, each halved where it must be, with the ledger."""

from .jit import kernel
from .ledger import tally
from .newmark import DEEPEST, HALVED, STEPS, attempt, copy


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
