"""Servo control: cascade of position and speed control on the motor encoder, designed and discretised with python-control.

    v* = K_x (x_ref - s) + k_v v_ref                     position loop, K_x = position_bandwidth
    f  = K_p (v* - v_s) + K_i int (v* - v_s) dt + k_a M a_ref

On rigid ropes the hoist is the mass M (`moving_mass`), and the gains place the speed loop's poles at
p^2 + 2 damping bandwidth p + bandwidth^2. The encoder is on the sheave driven by the motor
(collocated), so that each resonance of the ropes comes with an antiresonance and no phase is lost; the car follows the rim
up to the elongation of its rope, m_c a L_c / EA.
"""

from dataclasses import dataclass

import control

from ..parameters import Drive
from .hoist_dynamics import moving_mass


@dataclass(frozen=True)
class SpeedController:
    """Discrete proportional-integral controller of the speed error e [m/s].

    force [N] = gain e + output_gain z, next z = z + input_gain e
    """

    gain: float
    input_gain: float
    output_gain: float


@dataclass(frozen=True)
class ServoController:
    """The discrete controller; forces at the rim [N]."""

    speed: SpeedController
    position_gain: float
    velocity_feedforward: float
    acceleration_feedforward: float  # N per m/s2


def continuous_speed_control(drive: Drive) -> control.StateSpace:
    """K_p + K_i/p from speed error [m/s] to force at the rim [N], by pole placement on rigid ropes."""
    mass, bandwidth = moving_mass(drive), drive.servo.speed_bandwidth
    proportional = 2.0 * drive.servo.speed_damping * bandwidth * mass
    return control.ss(0.0, 1.0, bandwidth**2 * mass, proportional, inputs="e", outputs="f", states="z", name="speed control")


def sampled_speed_control(drive: Drive) -> control.StateSpace:
    """The speed controller discretised by Tustin's rule."""
    return control.sample_system(continuous_speed_control(drive), drive.servo.sample_period, method="tustin")


def design_servo(drive: Drive) -> ServoController:
    """Design of the discrete controller of a drive."""
    pi, servo = sampled_speed_control(drive), drive.servo
    return ServoController(
        SpeedController(pi.D.item(), pi.B.item(), pi.C.item()),
        servo.position_bandwidth,
        servo.velocity_feedforward,
        servo.acceleration_feedforward * moving_mass(drive),
    )
