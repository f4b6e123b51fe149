"""Equations (1) and (2) in time: the generalised-alpha method (J. Chung, G. Hulbert, *Journal of Applied Mechanics* 60, 1993)."""

import math

from .arguments import Ambience, Weights
from .equations_of_motion import correction, forces
from .jit import entry, kernel
from .rope import dahl_state

RADIUS = 0.7  # spectral radius at infinite frequency
ALPHA_M = (2.0 * RADIUS - 1.0) / (RADIUS + 1.0)
ALPHA_F = RADIUS / (RADIUS + 1.0)
GAMMA = 0.5 - ALPHA_M + ALPHA_F
BETA = 0.25 * (1.0 - ALPHA_M + ALPHA_F) ** 2
CLOSE = 1e-8  # m, a correction below which a step ends


@kernel
def predict(n, h, ends, old, new):
    """The state after h with the acceleration of now; prescribed `ends` [4, 3]: x and y of car and counterweight."""
    for k in range(2 * n + 2):
        new.a[k] = old.a[k]
        new.q[k] = old.q[k] + h * old.v[k] + 0.5 * h * h * old.a[k]
        new.v[k] = old.v[k] + h * old.a[k]
    for j in range(4):
        k = j if j < 2 else 2 * n - 4 + j
        new.q[k], new.v[k], new.a[k] = ends[j, 0], ends[j, 1], ends[j, 2]


@kernel
def balance(n, p, mass, W, a, a1):
    """W.x = forces less inertia between the old and the new state."""
    for k in range(2 * n):
        W.x[5 + k] = W.f[k] - mass[k >> 1] * ((1.0 - ALPHA_M) * a1[k] + ALPHA_M * a[k])
    k = 2 * n
    W.x[5 + k] = W.f[k] - p.sheave_mass * ((1.0 - ALPHA_M) * a1[k] + ALPHA_M * a[k])
    W.x[6 + k] = W.f[k + 1] - p.inertia * ((1.0 - ALPHA_M) * a1[k + 1] + ALPHA_M * a[k + 1])


@kernel
def step(p, n, h, W, rope, around, states):
    """Newton's iteration from the predicted state, with a new tangent where corrections shrink slowly; their count, 0 in vain.

    `states` are the old one, the new one, and one between them.
    """
    (q, v, a), (q1, v1, a1), (qf, vf, _) = states
    N = 2 * n
    ck, cc = 1.0 - ALPHA_F, (1.0 - ALPHA_F) * GAMMA / (BETA * h)
    cm = (1.0 - ALPHA_M) / (BETA * h * h)
    before, fresh = 1e9, True
    for count in range(1, 81):
        share = 1.0 if count <= 10 else 0.4  # an iteration that goes round in circles ends when it takes smaller steps
        for k in range(N + 2):
            qf[k] = (1.0 - ALPHA_F) * q1[k] + ALPHA_F * q[k]
            vf[k] = (1.0 - ALPHA_F) * v1[k] + ALPHA_F * v[k]
        forces(p, n, W, rope, around, qf, vf, Weights(ck, cc, cm, fresh))
        balance(n, p, rope.mass, W, a, a1)
        largest = correction(n, W, fresh)
        for k in range(N + 2):
            change = share * W.x[5 + k]
            q1[k] += change
            v1[k] += change * GAMMA / (BETA * h)
            a1[k] += change / (BETA * h * h)
        if largest < CLOSE:
            return count
        fresh = largest > 0.1 * before or count > 6
        before = largest
    return 0


@kernel
def keep_history(p, n, q1, rope):
    """Curvature and Dahl's state at the end of a step, from its shape."""
    for i in range(1, n - 1):
        ax, ay = q1[2 * i] - q1[2 * i - 2], q1[2 * i + 1] - q1[2 * i - 1]
        bx, by = q1[2 * i + 2] - q1[2 * i], q1[2 * i + 3] - q1[2 * i + 1]
        size = math.sqrt((ax * ax + ay * ay) * (bx * bx + by * by))
        kappa = 2.0 * (ax * by - ay * bx) / (size + ax * bx + ay * by) / p.element
        rope.z0[i] = dahl_state(p, kappa - rope.kappa0[i], rope.z0[i])
        rope.kappa0[i] = kappa


@kernel
def lateral_displacement(n, q, radius, side, height):
    """Outward distance of the rope from the vertical at a height; NaN where its end has passed."""
    first, way = (0, 1) if side < 0.0 else (n - 1, -1)
    x = -height
    if q[2 * first] > x:
        return math.nan
    i = first
    while q[2 * (i + way)] < x:
        i += way
    share = (x - q[2 * i]) / (q[2 * (i + way)] - q[2 * i])
    y = q[2 * i + 1] + share * (q[2 * (i + way) + 1] - q[2 * i + 1])
    return side * y - radius


@kernel
def keep_row(p, n, W, state, record, row):
    """Fill one row of the record."""
    q = state.q
    row[0], row[1], row[2] = q[2 * n], q[2 * n + 1], state.v[2 * n + 1]
    row[3], row[4], row[5] = W.tensions[0], W.tensions[1], W.tensions[2]
    for s in range(len(record.sensors)):
        row[6 + s] = lateral_displacement(n, q, p.radius, record.sensors[s, 0], record.sensors[s, 1])


@entry
def integrate(p, n, h, W, rope, motion, states, record):
    """Move the ends along a motion, from the first of three states, the others being room; fill the record.

    `motion` is ends [steps + 1, 4, 3] and thermal [steps + 1], the strain by temperature. Columns of the record: axle, angle,
    angular velocity, car's and counterweight's end tension, sheave force, then sensors. Returns the mean number of iterations,
    or less than 0.
    """
    (ends, thermal), (old, new, _) = motion, states
    steps, total = len(ends) - 1, 0
    forces(p, n, W, rope, Ambience(thermal[0], 0.0), old.q, old.v, Weights(0.0, 0.0, 0.0, False))
    for k in range(steps + 1):
        if k > 0:
            predict(n, h, ends[k], old, new)
            count = step(p, n, h, W, rope, Ambience(thermal[k], -ends[k, 0, 1]), states)
            if count == 0:
                return -float(k)
            total += count
            for j in range(2 * n + 2):
                old.q[j], old.v[j], old.a[j] = new.q[j], new.v[j], new.a[j]
            if p.dahl_moment > 0.0:
                keep_history(p, n, old.q, rope)
        if k % record.every == 0:
            keep_row(p, n, W, old, record, record.out[k // record.every])
    return total / steps
