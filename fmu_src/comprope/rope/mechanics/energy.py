"""Energy balance: what is stored, work of the ends and of effects, and what each damping takes out.

    residual = stored energy - its value at the start - work of ends and effects + losses

vanishes for an exact integration. Works are summed by the trapezoidal rule over the accepted steps, and with the forces at the
end of steps with slack rope, which take those. What segments lose in such a step is counted with the axial damping: catching
slack rope starts waves that are shorter than the step, which is to the balance as if they had died at once.
"""

from math import sqrt

from ...kernels.jit import kernel
from ..parameters.parameter_vector import BASE, BASE_BEFORE, CA, CB, CE, EA, EI, ELEMENT, RHO, G, J, M
from ..runtime.array_layout import BEND_RATE, CURVATURE, ELASTIC, FRICTION_LOSS, INVERSE, NORMAL_LOSS, SHARE, TENSION, TX, TY
from .axial_law import elastic_energy, slack_balance
from .base_motion import base_work

STORED = ("kinetic", "gravity", "tension", "bending", "contact", "sheave")
SPENT = ("axial_damping", "bending_damping", "external_damping", "contact_damping", "friction")

KINETIC, GRAVITY, STRAIN, BENT, CONTACT_ENERGY, SHEAVE = range(6)
ENDS_WORK = 6
LOSSES = 7
EFFECTS = LOSSES + len(SPENT)  # works of the effects follow, one each
END_FORCES = 4  # at the start of the array of powers, before losses and effects


@kernel
def stored_energies(n, p, q, v, w, contact, E):
    """Set the stored energies in E [J]: kinetic, gravity, tension, bending, contact, sheave."""
    m, l, kinetic, low, strain, bent = n + 1, p[ELEMENT], 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        share = 0.5 if i == 0 or i == n - 1 else 1.0
        kinetic += share * (v[i] * v[i] + v[m + i] * v[m + i])
        low += share * q[i]
    for e in range(n - 1):
        stretch = 1.0 / w[INVERSE * m + e] - l
        strain += stretch * stretch
    for i in range(1, n - 1):
        bent += w[CURVATURE * m + i] * w[CURVATURE * m + i]
    E[KINETIC] = 0.5 * p[RHO] * l * kinetic
    E[GRAVITY] = -p[RHO] * l * p[G] * low - p[M] * p[G] * q[n]
    E[STRAIN] = 0.5 * p[EA] / l * strain
    if w[SHARE * m + n] > 0.0:
        E[STRAIN] += slack_balance(n, p, v, w)[0]
    E[BENT] = 0.5 * p[EI] * l * bent
    E[CONTACT_ENERGY] = contact[ELASTIC]
    E[SHEAVE] = 0.5 * (p[M] * v[n] * v[n] + p[J] * v[m + n] * v[m + n])


@kernel
def powers(n, p, v, w, contact, power, effects, P):
    """Set P: forces that hold the ends come first, then the losses and effects' powers [W]."""
    m, l, axial, bending, drag = n + 1, p[ELEMENT], 0.0, 0.0, 0.0
    for e in range(n - 1):
        rate = w[TX * m + e] * (v[e + 1] - v[e]) + w[TY * m + e] * (v[m + e + 1] - v[m + e])
        axial += rate * rate
    for i in range(1, n - 1):
        bending += w[BEND_RATE * m + i] * w[BEND_RATE * m + i]
        drag += v[i] * v[i] + v[m + i] * v[m + i]
    P[END_FORCES] = p[CA] / l * axial
    if w[SHARE * m + n] > 0.0:
        P[END_FORCES] += slack_balance(n, p, v, w)[1]
    P[END_FORCES + 1] = p[CB] * l * bending
    P[END_FORCES + 2] = p[CE] * l * drag
    P[END_FORCES + 3] = contact[NORMAL_LOSS]
    P[END_FORCES + 4] = contact[FRICTION_LOSS]
    for k in range(effects):
        P[END_FORCES + 5 + k] = power[k]


@kernel
def hold_forces(n, p, a, f, P):
    """Set the first entries of P to the forces [N] that hold the ends."""
    m, half = n + 1, 0.5 * p[RHO] * p[ELEMENT]
    P[0] = half * a[0] - f[0]
    P[1] = half * a[m] - f[m]
    P[2] = half * a[n - 1] - f[n - 1]
    P[3] = half * a[m + n - 1] - f[m + n - 1]


@kernel
def begin_balance(rope, state, work):
    """Set stored energies and powers of a state at the start, where the forces are work.f; state.start becomes what is stored."""
    n, p, E = rope.n, rope.p, state.energy
    stored_energies(n, p, state.q, state.v, work.w, work.contact, E)
    powers(n, p, state.v, work.w, work.contact, work.power, rope.effects, state.powers)
    hold_forces(n, p, state.a, work.f, state.powers)
    state.start[0] = E[KINETIC] + E[GRAVITY] + E[STRAIN] + E[BENT] + E[CONTACT_ENERGY] + E[SHEAVE]


@kernel
def slack_loss(n, p, q0, q, w):
    """What segments lose over a step that takes the forces at its end, from q0 to q: T dL less the energy they gain [J]."""
    m, l, lost = n + 1, p[ELEMENT], 0.0
    for e in range(n - 1):
        dx, dy = q0[e + 1] - q0[e], q0[m + e + 1] - q0[m + e]
        before, now = sqrt(dx * dx + dy * dy), 1.0 / w[INVERSE * m + e]
        gained = elastic_energy(p, p[EA] * (now - l) / l) - elastic_energy(p, p[EA] * (before - l) / l)
        lost += w[TENSION * m + e] * (now - before) - l * gained
    return lost


@kernel
def update_balance(rope, step, state, motion, work):
    """Bring the energy balance up to date with a time step that goes from `state` to `motion`."""
    n, p, effects, P0, P, E = rope.n, rope.p, rope.effects, state.powers, work.powers, state.energy
    m, h, q0, q = n + 1, step.h, state.q, motion.q
    stored_energies(n, p, q, motion.v, work.w, work.contact, E)
    powers(n, p, motion.v, work.w, work.contact, work.power, effects, P)
    hold_forces(n, p, motion.a, work.f, P)
    if step.slack:  # its forces are those at its end
        for k in range(END_FORCES + 5 + effects):
            P0[k] = P[k]
    moved = 0.5 * (P0[0] + P[0]) * (q[0] - q0[0]) + 0.5 * (P0[1] + P[1]) * (q[m] - q0[m])
    moved += 0.5 * (P0[2] + P[2]) * (q[n - 1] - q0[n - 1])
    moved += 0.5 * (P0[3] + P[3]) * (q[m + n - 1] - q0[m + n - 1])
    if p[BASE] != 0.0 or p[BASE_BEFORE] != 0.0:
        moved += base_work(n, p, p[BASE] if step.slack else 0.5 * (p[BASE_BEFORE] + p[BASE]), q0, q)
    E[ENDS_WORK] += moved
    for k in range(5 + effects):
        E[LOSSES + k] += 0.5 * h * (P0[END_FORCES + k] + P[END_FORCES + k])
    if step.slack:
        E[LOSSES] += slack_loss(n, p, q0, q, work.w) - h * P[END_FORCES]
    for k in range(END_FORCES + 5 + effects):
        P0[k] = P[k]
