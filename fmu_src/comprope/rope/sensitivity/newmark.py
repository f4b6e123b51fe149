"""Sensitivities along a run: the linearised time step, with the factor that the step itself has left.

A direction is a change dp of the parameter vector; (dq, dv, da) is how the motion answers. From the same
predictor as the step's own, dq = dq0 + h (dv0 + h/2 da0), dv = dv0 + h da0, one correction r solves

    J r = (1 - alpha) D + dc - dM a,        dc = alpha df0 - M da0,
    da = da0 + r,  dv += gamma h r,  dq += beta h^2 r,

where J is the tangent of the step and D the directional derivative of the forces (see `slope`, `groove` and
`acting`), which is exact. J may be that of the iterate which was factored, with the contact's share renewed: that errs in the
correction alone; or it is renewed as a whole (`exact`). The next dc follows from the balance of the step.
What the ends do with dp is read off their paths by differences. How directions are kept is told in `direction`.
"""

from ..integration.newmark import renew
from ..linalg.bordered_band import factor_zone, fill
from ..linalg.multi_rhs import solve_lanes
from ..mechanics.end_conditions import PATH, PATHS, place_ends
from ..mechanics.equations_of_motion import forces, node_mass
from ..mechanics.sheave_contact import clear
from ..runtime.array_layout import FIRST, LAST
from ..runtime.jit import kernel
from ..runtime.parameter_vector import ALPHA, J, M, R
from ..runtime.simd import LANES, put, take
from .directions import entry, gauge, shift
from .effects import BY_HAND, DIFFERENCED, add_lane, changing, effect_forces, effects_along, histories, keep_history
from .internal_forces import ahead, contact_alone, elongations, mass_slope, rope_slope
from .sheave_contact import centre_slope, groove_slope

GROUP = 3  # blocks that are carried on at once: enough to fill each other's waiting, few enough to stay at hand
ENDS_STEP = 1e-2  # of `limit`: the difference by which the ends' paths are differentiated


@kernel
def renew_zone(n, h, p, q, v, f, touch, A, L, B, Z):
    """Factor the contact's tangent in the state reached anew in the factor's zone; f is free for use.

    The contact changes most between the iterate that was factored and the state reached; the rope's share in A
    stays as it was.
    """
    first, last, alpha = int(L[n]), int(L[2 * n + 1]), p[ALPHA]
    touch[FIRST], touch[LAST] = first + 1.0, last - 1.0
    clear(n, Z, first + 1, last - 1)
    ck, cc = (1.0 - alpha) * 0.25 * (1.0 + alpha) * (1.0 + alpha) * h * h, (1.0 - alpha) * (0.5 + alpha) * h
    contact_alone(n, p, q, v, f, touch, Z, ck, cc, True)
    fill(n, A, Z, B, first, last)
    factor_zone(2 * (last - first + 1), B)


@kernel
def renew_all(n, t, h, p, q, v, h0, f, touch, w, A, L, B, Z, r, hb, power):
    """Factor the whole tangent in the state reached, where the forces are f."""
    alpha = p[ALPHA]
    ck, cc = (1.0 - alpha) * 0.25 * (1.0 + alpha) * (1.0 + alpha) * h * h, (1.0 - alpha) * (0.5 + alpha) * h
    forces(n, t, p, q, v, w, f, touch, h0, hb, power, Z, ck, cc, True)
    renew(n, t, p, h, q, v, w, A, L, B, Z, r, touch)


@kernel
def arrive(
    n, t, h, exact, directions, p, q0, v0, hp, w, e0, f, f1, way, touch, A, L, B, Z, moves, hb, power,
):  # fmt: skip
    """What all directions start from in the state reached: forces f1 of effects if any change, elongations e0, J."""
    acting = changing(directions, way)
    if exact:
        renew_all(n, t, h, p, q0, v0, hp, f, touch, w, A, L, B, Z, moves, hb, power)
    else:
        if acting:
            forces(n, t, p, q0, v0, w, f, touch, hp, hb, power, Z, 0.0, 0.0, False)
        renew_zone(n, h, p, q0, v0, f, touch, A, L, B, Z)
    elongations(n, p, v0, w, e0)
    if acting:
        effect_forces(n, t, p, q0, v0, w, w, f1, hp, hb, power)


@kernel
def block_slope(
    n, h, new, keep, directions, block, parameters, p, q0, v0, a0, w, e0, at, toward, dp, limit, dq, dv, da, dc, p1, centre,
    touch, D, lift,
):  # fmt: skip
    """Set a block of D to the rope's and the contact's part, and its part of lift (see `slopes`)."""
    m, d, base = n + 1, parameters * LANES * block, 2 * (n + 1) * LANES * block
    rope_slope(n, p, v0, a0, w, e0, dp, d, base, h, new, keep, dq, dv, da, dc, D)
    for k in range(block * LANES, min(block * LANES + LANES, directions)):
        b = entry(m, k) + (2 * n + 1) * LANES
        e = gauge(n, entry(m, k), p[R], limit[k], dq, dv)
        shift(parameters, k, e, at, toward, p1)
        centre_slope(m, e, p, p1, q0[m + n], dq[b] + h * (dv[b] + 0.5 * h * da[b]), k % LANES, centre)
    groove_slope(n, p, q0, v0, dp, d, base, h, new, centre, dq, dv, da, touch, D, lift, block * LANES)


@kernel
def place_direction(n, t, k, h, parameters, path, dt, s, at, toward, limit, dpath, p1, path1, q0, v0, a0, q, v, a, dq, dv, da):
    """Set the ends' part of direction k at fraction s of the path, where (q0, v0, a0) has the ends themselves.

    What is set is what the predictor, h ahead, turns into that.
    """
    m, e = n + 1, ENDS_STEP * limit[k]
    shift(parameters, k, e, at, toward, p1)
    for j in range(PATHS * PATH):
        path1[j] = path[j] + e * dpath[PATHS * PATH * k + j]
    place_ends(n, t, p1, path1, dt, s, q, v, a)
    for i in (0, n - 1):
        for c in range(2):
            j, b = c * m + i, entry(m, k) + (2 * i + c) * LANES
            da[b] = (a[j] - a0[j]) / e
            dv[b] = (v[j] - v0[j]) / e - h * da[b]
            dq[b] = (q[j] - q0[j]) / e - h * dv[b] - 0.5 * h * h * da[b]


@kernel
def correct_number(k, h, half, by_q, by_v, gain, mass, inertia, D, dq, dv, da, dc):
    """Add the correction at entry k; `inertia` is dM a there. The balance of the step gives the next dc."""
    r = take(D, k)
    x, v = ahead(k, h, half, dq, dv, da)
    a = take(da, k) + r
    put(dq, k, x + by_q * r)
    put(dv, k, v + by_v * r)
    put(da, k, a)
    put(dc, k, gain * (mass * r + inertia - take(dc, k)) - mass * a)


@kernel
def correct_block(n, p, dp, d, base, h, a0, D, dq, dv, da, dc):
    """Add the corrections in a block of D."""
    m, alpha, mass, dmass = n + 1, p[ALPHA], node_mass(p), mass_slope(p, dp, d)
    by_q, by_v, half, gain = 0.25 * (1.0 + alpha) * (1.0 + alpha) * h * h, (0.5 + alpha) * h, 0.5 * h * h, alpha / (1.0 - alpha)
    for i in range(n):
        k = base + 2 * LANES * i
        correct_number(k, h, half, by_q, by_v, gain, mass, a0[i] * dmass, D, dq, dv, da, dc)
        correct_number(k + LANES, h, half, by_q, by_v, gain, mass, a0[m + i] * dmass, D, dq, dv, da, dc)
    k = base + 2 * LANES * n
    correct_number(k, h, half, by_q, by_v, gain, p[M], a0[n] * take(dp, d + M * LANES), D, dq, dv, da, dc)
    correct_number(k + LANES, h, half, by_q, by_v, gain, p[J], a0[m + n] * take(dp, d + J * LANES), D, dq, dv, da, dc)


@kernel
def guide(
    n, t, h, dt, s, directions, parameters, path, at, toward, limit, dpath, guided, p1, path1, q0, v0, a0, q, v, a, dq, dv, da,
):  # fmt: skip
    """Place the ends of all directions that move them."""
    for k in range(directions):
        if guided[k] != 0.0:
            place_direction(n, t, k, h, parameters, path, dt, s, at, toward, limit, dpath, p1, path1, q0, v0, a0, q, v, a,
                            dq, dv, da)  # fmt: skip


@kernel
def solve_blocks(n, h, parameters, begin, end, p, dp, a0, L, B, D, dq, dv, da, dc):
    """Solve for the corrections of some blocks, whose right-hand sides are in D, and add them; prescribed ends have none."""
    size = 2 * (n + 1) * LANES
    for block in range(begin, end):
        for k in range(2 * LANES):
            D[size * block + k], D[size * block + 2 * LANES * (n - 1) + k] = 0.0, 0.0
    solve_lanes(n, L, B, D, begin, end, int(L[n]), int(L[2 * n + 1]))
    for block in range(begin, end):
        correct_block(n, p, dp, parameters * LANES * block, size * block, h, a0, D, dq, dv, da, dc)


@kernel
def slopes(
    n, t, h, new, keep, recorded, state_size, directions, begin, end, parameters, p, q0, v0, a0, hp, w, e0, f1, at, toward, dp,
    limit, way, own, dq, dv, da, dc, dh, p1, centre, moves, q, v, hi, hb, hd, w1, f, touch, power, D, lift,
):  # fmt: skip
    """Set D to new D + keep (dc - dM a) for the directions of blocks `begin` .. `end` - 1.

    On the right D is the derivative of the forces h ahead of (dq, dv, da). With `recorded`, histories of effects that begin
    with their direction are kept. `lift` are the derivatives of the vertical force on the sheave.
    """
    for block in range(begin, end):
        block_slope(n, h, new, keep, directions, block, parameters, p, q0, v0, a0, w, e0, at, toward, dp, limit, dq, dv, da,
                    dc, p1, centre, touch, D, lift)  # fmt: skip
    for k in range(begin * LANES, min(end * LANES, directions)):
        if way[k] != BY_HAND:
            b = entry(n + 1, k)
            e = effects_along(n, t, k, h, state_size, parameters, p, q0, v0, hp, w, e0, at, toward, limit, way, own, dq, dv, da,
                              dh, p1, moves, q, v, hi, hd, w1, f, power)  # fmt: skip
            add_lane(n, new / e, f, b, D)
            if way[k] >= DIFFERENCED:
                add_lane(n, -new / e, f1, b, D)
            if recorded and own[k] != 0.0:
                keep_history(state_size, k, e, own, hb, hd, dh)


@kernel
def step_directions(
    n, t, h, dt, s, exact, state_size, directions, blocks, parameters, p, path, q0, v0, a0, hp, q, v, a, f, w, A, L, B, Z,
    touch, power, at, toward, dp, limit, dpath, guided, way, own, dq, dv, da, dc, dh, p1, path1, centre, moves, w1, e0, f1, hi,
    hb, hd, D, lift,
):  # fmt: skip
    """Carry all directions over an accepted step of length h that has ended at (q0, v0, a0); hp is the history before it.

    q, v, a, f are free for use; the workspace w is of that state, or within the step's tolerance of it.
    """
    if directions == 0:
        return
    arrive(n, t, h, exact, directions, p, q0, v0, hp, w, e0, f, f1, way, touch, A, L, B, Z, moves, hb, power)
    guide(n, t, h, dt, s, directions, parameters, path, at, toward, limit, dpath, guided, p1, path1, q0, v0, a0, q, v, a,
          dq, dv, da)  # fmt: skip
    for begin in range(0, blocks, GROUP):
        end = min(begin + GROUP, blocks)
        slopes(n, t, h, 1.0 - p[ALPHA], 1.0, True, state_size, directions, begin, end, parameters, p, q0, v0, a0, hp, w, e0, f1,
               at, toward, dp, limit, way, own, dq, dv, da, dc, dh, p1, centre, moves, q, v, hi, hb, hd, w1, f, touch, power, D,
               lift)  # fmt: skip
        solve_blocks(n, h, parameters, begin, end, p, dp, a0, L, B, D, dq, dv, da, dc)
    histories(n, t, state_size, directions, parameters, p, q0, v0, hp, w, e0, at, toward, limit, way, own, dq, dv, da, dh, p1,
              moves, q, v, hi, hb, hd, w1, f, power)  # fmt: skip


@kernel
def differentiate(
    n, t, state_size, directions, blocks, parameters, p, q0, v0, a0, h0, q, v, f, w, Z, touch, power, at, toward, dp, limit,
    way, own, dq, dv, da, dc, dh, p1, centre, moves, w1, e0, f1, hi, hb, hd, D, lift,
):  # fmt: skip
    """Set D to the derivative of the forces along all directions, and lift to that of the vertical force on the sheave."""
    forces(n, t, p, q0, v0, w, f, touch, h0, hb, power, Z, 0.0, 0.0, False)
    elongations(n, p, v0, w, e0)
    if changing(directions, way):
        effect_forces(n, t, p, q0, v0, w, w, f1, h0, hb, power)
    slopes(n, t, 0.0, 1.0, 0.0, False, state_size, directions, 0, blocks, parameters, p, q0, v0, a0, h0, w, e0, f1, at,
           toward, dp, limit, way, own, dq, dv, da, dc, dh, p1, centre, moves, q, v, hi, hb, hd, w1, f, touch, power, D,
           lift)  # fmt: skip
