"""Dynamics of the hoist: traction sheave, car and counterweight on elastic ropes, linearised about any car position.

All quantities are deviations from the initial equilibrium. States, inputs and their units:

    s, x_c, x_w   [m]    displacement of the traction sheave's rim (car up), of the car (up), of the counterweight (up)
    v_s, v_c, v_w [m/s]  their velocities
    T_c, T_w      [N]    elastic tension of the hoist ropes on the car's and on the counterweight's side
    f             [N]    force of the motor at the rim, torque / radius
    F_c, F_w      [N]    pull of the compensation ropes on car and counterweight, down

With L_c = headroom + height - x and L_w = headroom + x the rope lengths, mu the hoist ropes' mass per length,
half of each side's rope moving with its end and half with the sheave, N the tension with its damping part:

    T_c' = EA/L_c (v_s - v_c) - mu g v_s/2      N_c = T_c + D/L_c (v_s - v_c)
    T_w' = -EA/L_w (v_s + v_w) + mu g v_s/2     N_w = T_w - D/L_w (v_s + v_w)
    (J/r^2 + mu (L_c + L_w)/2) v_s' = f - N_c + N_w + mu g s
    (m_c + mu L_c/2) v_c' =  N_c + mu g s/2 - F_c
    (m_w + mu L_w/2) v_w' =  N_w - mu g s/2 - F_w

The states are tensions, not elongations: rope running on or off the sheave keeps its strain (no creep), which exceeds the
mean of its side by mu g L/(2 EA) (the term mu g v_s/2: a slow trip under constant loads moves the car exactly as far as the
rim), and the tensions are continuous when the stiffness is scheduled with the position. Neglected: creep, slip, slack, wave
propagation in the ropes, and the momentum of rope that changes sides. Not validated against measurements of an elevator.
"""

from dataclasses import dataclass

import control
import numpy as np

from ..kernels.arguments import T_C, T_W, V_C, V_S, V_W, X_C, X_W, S
from ..parameters import Drive

STATES = ("s", "x_c", "x_w", "v_s", "v_c", "v_w", "T_c", "T_w")
INPUTS = ("f", "F_c", "F_w")


@dataclass(frozen=True)
class LumpedHoist:
    """Rope lengths [m] on both sides and moving masses [kg] with the car at one position."""

    car_rope: float
    counterweight_rope: float
    sheave: float
    car: float
    counterweight: float


def lumped_hoist(drive: Drive, position: float) -> LumpedHoist:
    """Rope lengths and lumped masses for a car position [m above the bottom landing]."""
    plant, height = drive.plant, drive.shaft.height
    car_rope, counterweight_rope = plant.headroom + height - position, plant.headroom + position
    half = 0.5 * plant.rope_mass_per_length
    return LumpedHoist(
        car_rope,
        counterweight_rope,
        plant.machine_inertia / plant.sheave_radius**2 + half * (car_rope + counterweight_rope),
        plant.car_mass + half * car_rope,
        plant.counterweight_mass + half * counterweight_rope,
    )


def moving_mass(drive: Drive) -> float:
    """Total moving mass [kg], with the inertia of the machine as mass at the rim; independent of the car position."""
    parts = lumped_hoist(drive, 0.0)
    return parts.sheave + parts.car + parts.counterweight


def state_space(drive: Drive, position: float) -> control.StateSpace:
    """State-space model of the hoist linearised about a car position [m]: inputs f, F_c, F_w [N], outputs all states."""
    parts = lumped_hoist(drive, position)
    weight = drive.plant.rope_mass_per_length * drive.shaft.gravity
    a, b = np.zeros((8, 8)), np.zeros((8, 3))
    a[S, V_S] = a[X_C, V_C] = a[X_W, V_W] = 1.0
    car_strain_rate = _row(V_S, 1.0, V_C, -1.0) / parts.car_rope
    counterweight_strain_rate = -_row(V_S, 1.0, V_W, 1.0) / parts.counterweight_rope
    a[T_C] = drive.plant.rope_stiffness * car_strain_rate - _row(V_S, weight / 2.0)
    a[T_W] = drive.plant.rope_stiffness * counterweight_strain_rate + _row(V_S, weight / 2.0)
    n_c = _row(T_C, 1.0) + drive.plant.rope_damping * car_strain_rate
    n_w = _row(T_W, 1.0) + drive.plant.rope_damping * counterweight_strain_rate
    a[V_S] = (n_w - n_c + _row(S, weight)) / parts.sheave
    a[V_C] = (n_c + _row(S, weight / 2.0)) / parts.car
    a[V_W] = (n_w - _row(S, weight / 2.0)) / parts.counterweight
    b[V_S, 0], b[V_C, 1], b[V_W, 2] = 1.0 / parts.sheave, -1.0 / parts.car, -1.0 / parts.counterweight
    return control.ss(a, b, np.eye(8), np.zeros((8, 3)), states=STATES, inputs=INPUTS, outputs=STATES, name="hoist")


def _row(*pairs: float) -> np.ndarray:
    """A matrix row over the states from (index, factor, index, factor, ...)."""
    row = np.zeros(len(STATES))
    for index, factor in zip(pairs[::2], pairs[1::2], strict=True):
        row[int(index)] = factor
    return row
