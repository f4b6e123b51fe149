"""Sensitivities along a run: the linearised time step, with the factor that the step itself has left.

A direction is a change dp of the parameter vector; (dq, dv, da) is how the motion answers. From the same
predictor as the step's own, dq = dq0 + h (dv0 + h/2 da0), dv = dv0 + h da0, one correction r solves

    J r = (1 - alpha) D + alpha df0 - M da0 - dM a,
    da = da0 + r,  dv += gamma h r,  dq += beta h^2 r,

where J is the tangent of the step and D the directional derivative of the forces (see `slope`), which is
exact: that J may be of an earlier iterate errs in the correction alone. df follows from the balance of
the step. What the ends do with dp is read off their paths by differences.

Directions follow each other in dq, dv, da, df and D (2 m numbers each), in dp and `at`.
"""

from math import ceil

from .dynamics import forces, node_mass
from .ends import PATH, PATHS, place_ends
from .jit import contracted, kernel
from .lanes import LANES, interleave, separate, solve_lanes
from .ledger import tally
from .march import accept
from .newmark import DEEPEST, HALVED, STEPS, attempt, copy
from .slope import contact_alone, contact_slope, elongations, forces_on, rope_slope
from .slots import ALPHA, ELEMENT, RHO, J, M, R
from .travel import MOST, STEP, where
from .words import FINE, TOO_LONG
from .work import FORCE_X

MOVE = 1e-7  # m, the largest move by which forces are differenced
PERIOD = 0.1  # s, by which velocities are compared with moves
TURN = 1e-3  # share of the sheave's turn, which matters to forces through an eccentric groove alone
COARSE = 32  # nodes between those that are asked for the largest move
ENDS_STEP = 1e-2  # of `limit`: the difference by which the ends' paths are differentiated

# How forces are differentiated along a direction: by hand but for the contact; by differences, as an effect acts;
# by differences with the change of the history of effects; with the history that its own effect would have had.
BY_HAND, DIFFERENCED, CHANGED, OWN = range(4)


@kernel
def shift(parameters, k, e, at, dp, p1):
    """Set p1 to the parameters of direction k, e along it."""
    for j in range(parameters):
        p1[j] = at[parameters * k + j] + e * dp[parameters * k + j]


@kernel
def gauge(n, k, radius, limit, dq, dv):
    """The step e by which direction k is differenced: a largest move of MOVE, and at most limit[k]."""
    m, b, largest = n + 1, 2 * (n + 1) * k, 0.0
    for i in range(0, n, COARSE):
        largest = max(largest, abs(dq[b + i]), abs(dq[b + m + i]), PERIOD * abs(dv[b + i]), PERIOD * abs(dv[b + m + i]))
    largest = max(largest, abs(dq[b + n]), PERIOD * abs(dv[b + n]))
    largest = max(largest, radius * TURN * abs(dq[b + m + n]), radius * PERIOD * abs(dv[b + m + n]))
    return limit[k] if largest * limit[k] <= MOVE else MOVE / largest


@kernel
def displace(size, b, e, q0, dq, q):
    """q = q0 + e dq, the latter from its entry b on."""
    for i in range(size):
        q[i] = q0[i] + e * dq[b + i]


@kernel
def respond(n, t, k, e, state_size, p, q0, v0, h0, w, e0, way, dq, dv, dh, p1, moves, q, v, hi, h1, w1, f, touch, power, Z):
    """Set f to the forces a step e along direction k from (q0, v0), whose w and e0 are given, and h1 to the history."""
    m = n + 1
    for i in range(2 * m):
        moves[i] = e * dq[2 * m * k + i]
    displace(2 * m, 2 * m * k, e, q0, dq, q)
    displace(2 * m, 2 * m * k, e, v0, dv, v)
    if way[k] == CHANGED:
        displace(state_size, state_size * k, e, h0, dh, hi)
    elif way[k] == OWN:
        for i in range(state_size):
            hi[i] = dh[state_size * k + i]
    forces_on(n, t, p1, p[ELEMENT], w, e0, moves, q, v, w1, f, touch, hi, h1, power, Z)


@kernel
def slope(
    n, t, k, state_size, parameters, p, q0, v0, h0, w, e0, f1, fc, at, dp, limit, way, dq, dv, dh, p1, moves, q, v, hi, hd, w1, f,
    touch, power, Z, D,
):  # fmt: skip
    """Set row k of D to the derivative of the forces along direction k.

    Forces f1, those of the contact fc, w and e0 belong to (q0, v0). Returns the step of differences, which touch is left at.
    """
    m, e = n + 1, gauge(n, k, p[R], limit, dq, dv)
    shift(parameters, k, e, at, dp, p1)
    if way[k] == BY_HAND:
        rope_slope(n, p, v0, w, e0, dp, parameters * k, 2 * m * k, dq, dv, w1, D)
        contact_slope(n, p1, e, 2 * m * k, q0, v0, dq, dv, q, v, f, fc, touch, Z, D)
    else:
        respond(n, t, k, e, state_size, p, q0, v0, h0, w, e0, way, dq, dv, dh, p1, moves, q, v, hi, hd, w1, f, touch, power, Z)
        for i in range(2 * m):
            D[2 * m * k + i] = (f[i] - f1[i]) / e
    return e


@kernel
def present(n, t, p, q0, v0, h0, w, e0, f1, fc, touch, hb, power, Z):
    """Forces, workspace and history at the state reached, from which all directions are differenced."""
    forces(n, t, p, q0, v0, w, f1, touch, h0, hb, power, Z, 0.0, 0.0, False)
    elongations(n, p, v0, w, e0)
    contact_alone(n, p, q0, v0, fc, touch, Z)


@contracted
def predict_direction(n, k, h, dq, dv, da):
    """The acceleration's change stays what it was."""
    b, half = 2 * (n + 1) * k, 0.5 * h
    for i in range(b, b + 2 * (n + 1)):
        dq[i] += h * (dv[i] + half * da[i])
        dv[i] += h * da[i]


@kernel
def place_direction(n, t, k, parameters, path, dt, s, at, dp, limit, dpath, p1, path1, q0, v0, a0, q, v, a, dq, dv, da):
    """Set the ends' part of direction k at fraction s of the path, where (q0, v0, a0) has the ends themselves."""
    m, e = n + 1, ENDS_STEP * limit[k]
    shift(parameters, k, e, at, dp, p1)
    displace(PATHS * PATH, PATHS * PATH * k, e, path, dpath, path1)
    place_ends(n, t, p1, path1, dt, s, q, v, a)
    for i in (0, n - 1, m, m + n - 1):
        dq[2 * m * k + i] = (q[i] - q0[i]) / e
        dv[2 * m * k + i] = (v[i] - v0[i]) / e
        da[2 * m * k + i] = (a[i] - a0[i]) / e


@contracted
def weigh(n, k, parameters, p, dp, a0, df, da, D):
    """Turn row k of D into (1 - alpha) D + alpha df0 - M da0 - dM a; prescribed ends have none."""
    m, b, d, alpha, new = n + 1, 2 * (n + 1) * k, parameters * k, p[ALPHA], 1.0 - p[ALPHA]
    mass, dmass = node_mass(p), dp[d + RHO] * p[ELEMENT] + p[RHO] * dp[d + ELEMENT]
    height = new * D[b + n] + alpha * df[b + n] - p[M] * da[b + n] - dp[d + M] * a0[n]
    turn = new * D[b + m + n] + alpha * df[b + m + n] - p[J] * da[b + m + n] - dp[d + J] * a0[m + n]
    for i in range(2 * m):
        D[b + i] = new * D[b + i] + alpha * df[b + i] - mass * da[b + i] - dmass * a0[i]
    D[b + n], D[b + m + n] = height, turn
    for i in (0, n - 1, m, m + n - 1):
        D[b + i] = 0.0


@contracted
def correct_direction(n, k, parameters, p, dp, h, a0, r, dq, dv, da, df):
    """Add the correction in row k of r, and set df from the balance of the step."""
    m, b, d, alpha = n + 1, 2 * (n + 1) * k, parameters * k, p[ALPHA]
    by_q, by_v = 0.25 * (1.0 + alpha) * (1.0 + alpha) * h * h, (0.5 + alpha) * h
    for i in range(b, b + 2 * m):
        dq[i] += by_q * r[i]
        dv[i] += by_v * r[i]
        da[i] += r[i]
    weight = 1.0 / (1.0 - alpha)
    mass, dmass = node_mass(p), dp[d + RHO] * p[ELEMENT] + p[RHO] * dp[d + ELEMENT]
    height = (p[M] * da[b + n] + dp[d + M] * a0[n] - alpha * df[b + n]) * weight
    turn = (p[J] * da[b + m + n] + dp[d + J] * a0[m + n] - alpha * df[b + m + n]) * weight
    for i in range(2 * m):
        df[b + i] = (mass * da[b + i] + dmass * a0[i] - alpha * df[b + i]) * weight
    df[b + n], df[b + m + n] = height, turn


@kernel
def keep_history(state_size, k, e, way, hb, h1, dh):
    """Keep direction k's history after a step: its change, or its own."""
    for i in range(state_size):
        dh[state_size * k + i] = h1[i] if way[k] == OWN else (h1[i] - hb[i]) / e


@kernel
def step_directions(
    n, t, h, dt, s, state_size, directions, parameters, p, path, q0, v0, a0, hp, q, v, a, f, w, L, B, Z, touch, power, at, dp, limit,
    dpath, way, dq, dv, da, df, dh, p1, path1, moves, w1, e0, f1, fc, hi, hb, hd, D, rows,
):  # fmt: skip
    """Carry all directions over an accepted step of length h that has ended at (q0, v0, a0); hp is the history before it.

    q, v, a, f are free for use.
    """
    m, first, last = n + 1, int(L[n]), int(L[2 * n + 1])
    present(n, t, p, q0, v0, hp, w, e0, f1, fc, touch, hb, power, Z)
    for k in range(directions):
        predict_direction(n, k, h, dq, dv, da)
        place_direction(n, t, k, parameters, path, dt, s, at, dp, limit, dpath, p1, path1, q0, v0, a0, q, v, a, dq, dv, da)
        slope(n, t, k, state_size, parameters, p, q0, v0, hp, w, e0, f1, fc, at, dp, limit, way, dq, dv, dh, p1, moves, q, v, hi, hd,
              w1, f, touch, power, Z, D)  # fmt: skip
        weigh(n, k, parameters, p, dp, a0, df, da, D)
    for row in range(0, directions, LANES):
        interleave(m, D, row, rows, 2 * m * row)
        solve_lanes(n, L, B, rows, 2 * m * row, first, last)
        separate(m, rows, 2 * m * row, D, row)
    for k in range(directions):
        correct_direction(n, k, parameters, p, dp, h, a0, D, dq, dv, da, df)
        if way[k] >= CHANGED:
            e = gauge(n, k, p[R], limit, dq, dv)
            shift(parameters, k, e, at, dp, p1)
            respond(n, t, k, e, state_size, p, q0, v0, hp, w, e0, way, dq, dv, dh, p1, moves, q, v, hi, hd, w1, f, touch, power, Z)
            keep_history(state_size, k, e, way, hb, hd, dh)


@kernel
def march_tangent(
    n, t0, dt, steps, p, path, q0, v0, a0, f0, h0, q, v, a, f, h1, w, A, L, B, Z, r, touch, power, P0, P, E, count,
    state_size, effects, directions, parameters, at, dp, limit, dpath, way, dq, dv, da, df, dh, p1, path1, moves, w1, e0, f1, fc, hp,
    hi, hb, hd, D, rows,
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
                step_directions(n, t0 + s * dt, h, dt, s, state_size, directions, parameters, p, path, q0, v0, a0, hp, q, v, a, f,
                                w, L, B, Z, touch, power, at, dp, limit, dpath, way, dq, dv, da, df, dh, p1, path1, moves, w1, e0,
                                f1, fc, hi, hb, hd, D, rows)  # fmt: skip
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
    n, dt, p, path, q0, v0, a0, f0, h0, q, v, a, f, h1, w, A, L, B, Z, r, touch, power, P0, P, E, count, time, state_size, effects,
    told, directions, parameters, at, dp, limit, dpath, way, dq, dv, da, df, dh, p1, path1, moves, w1, e0, f1, fc, hp, hi, hb, hd, D,
    rows,
):  # fmt: skip
    """What `travel.travel` does, and all directions beside it."""
    t0, share = time[0], dt / p[STEP]
    if not share <= MOST:
        told[0], told[1], told[2] = dt, MOST, p[STEP]
        return TOO_LONG
    steps = max(1, ceil(share * (1.0 - 1e-9)))
    reached = march_tangent(n, t0, dt, steps, p, path, q0, v0, a0, f0, h0, q, v, a, f, h1, w, A, L, B, Z, r, touch, power, P0, P, E,
                            count, state_size, effects, directions, parameters, at, dp, limit, dpath, way, dq, dv, da, df, dh, p1,
                            path1, moves, w1, e0, f1, fc, hp, hi, hb, hd, D, rows)  # fmt: skip
    if reached == 1.0:
        time[0] = t0 + dt
        return FINE
    return where(n, p, t0 + reached * dt, dt / steps / 2.0**DEEPEST, q0, count, told)


@kernel
def differentiate(
    n, t, state_size, directions, parameters, p, q0, v0, h0, q, v, f, w, Z, touch, power, at, dp, limit, way, dq, dv, dh, p1, moves,
    w1, e0, f1, fc, hi, hb, hd, D, lift,
):  # fmt: skip
    """Set row k of D to the derivative of the forces along direction k, lift[k] to that of the vertical force on the sheave."""
    present(n, t, p, q0, v0, h0, w, e0, f1, fc, touch, hb, power, Z)
    force = touch[FORCE_X]
    for k in range(directions):
        e = slope(n, t, k, state_size, parameters, p, q0, v0, h0, w, e0, f1, fc, at, dp, limit, way, dq, dv, dh, p1, moves, q, v, hi,
                  hd, w1, f, touch, power, Z, D)  # fmt: skip
        lift[k] = (touch[FORCE_X] - force) / e
