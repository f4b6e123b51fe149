"""Whole communication steps with sensitivities: `march` and `travel`, and all directions beside the rope."""

from ..integration.newmark import DEEPEST, HALVED, STEPS, attempt, copy
from ..integration.time_stepping import accept, time_steps, where
from ..mechanics.energy import tally
from ..runtime.jit import kernel
from ..runtime.status import FINE, TOO_LONG
from .newmark import step_directions


@kernel
def march_tangent(
    n, t0, dt, steps, p, path, q0, v0, a0, f0, h0, q, v, a, f, h1, w, A, L, B, Z, r, touch, power, P0, P, E, count,
    state_size, effects, exact, directions, blocks, parameters, at, toward, dp, limit, dpath, guided, way, own, dq, dv, da,
    dc, dh, p1, path1, centre, moves, w1, e0, f1, hp, hi, hb, hd, D, lift,
):  # fmt: skip
    """What `march.march` does, to the same bits, and all directions beside it."""
    for k in range(steps):
        done, size, depth = 0.0, 1.0, 0
        while done < 1.0:
            s = (k + done + size) / steps
            h = size * dt / steps
            if attempt(n, t0 + s * dt, h, p, path, dt, s, q0, v0, a0, f0, h0,
                       q, v, a, f, h1, w, A, L, B, Z, r, touch, power, count):  # fmt: skip
                tally(n, p, h, q0, q, v, a, f, w, touch, power, effects, P0, P, E)
                copy(state_size, h0, hp)
                accept(n, state_size, q, v, a, f, h1, q0, v0, a0, f0, h0)
                step_directions(n, t0 + s * dt, h, dt, s, exact, state_size, directions, blocks, parameters, p, path, q0, v0,
                                a0, hp, q, v, a, f, w, A, L, B, Z, touch, power, at, toward, dp, limit, dpath, guided, way, own,
                                dq, dv, da, dc, dh, p1, path1, centre, moves, w1, e0, f1, hi, hb, hd, D,
                                lift)  # fmt: skip
                done += size
                count[STEPS] += 1
            else:
                count[HALVED] += 1
                size, depth = 0.5 * size, depth + 1
                if depth > DEEPEST:
                    return (k + done) / steps
    return 1.0


@kernel
def travel_tangent(
    n, dt, p, path, q0, v0, a0, f0, h0, q, v, a, f, h1, w, A, L, B, Z, r, touch, power, P0, P, E, count, time,
    state_size, effects, told, exact, directions, blocks, parameters, at, toward, dp, limit, dpath, guided, way, own, dq, dv,
    da, dc, dh, p1, path1, centre, moves, w1, e0, f1, hp, hi, hb, hd, D, lift,
):  # fmt: skip
    """What `travel.travel` does, and all directions beside it."""
    t0, steps = time[0], time_steps(dt, p, path, time, told)
    if steps == 0:
        return TOO_LONG
    reached = march_tangent(n, t0, dt, steps, p, path, q0, v0, a0, f0, h0, q, v, a, f, h1, w, A, L, B, Z, r, touch, power,
                            P0, P, E, count, state_size, effects, exact, directions, blocks, parameters, at, toward, dp, limit,
                            dpath, guided, way, own, dq, dv, da, dc, dh, p1, path1, centre, moves, w1, e0, f1, hp, hi, hb, hd,
                            D, lift)  # fmt: skip
    if reached == 1.0:
        time[0] = t0 + dt
        return FINE
    return where(n, p, t0 + reached * dt, dt / steps / 2.0**DEEPEST, q0, count, told)
