"""Stability margins of the servo, from its loop opened at the motor torque."""

from dataclasses import dataclass

import control
import numpy as np

from ..kernels.arguments import T_C, T_W, V_C, V_S, V_W, S
from ..parameters import Drive
from .hoist_dynamics import state_space
from .servo_control import sampled_speed_control

_FREQUENCIES = 4000  # from 0.01 rad/s to half the sampling rate: 0.3 % apart, finer than the ropes' resonances


@dataclass(frozen=True)
class Margins:
    """Margins of the loop with the car at one position.

    The loop's gain may rise by the factor `upper_gain_margin` or fall by the factor `lower_gain_margin`, and its phase may lag
    by `phase_margin` [degrees] more at `crossover_frequency` [rad/s]. `modulus_margin` is the least distance of the loop's
    Nyquist plot from -1, the reciprocal of the peak of the sensitivity.
    """

    upper_gain_margin: float
    lower_gain_margin: float
    phase_margin: float
    crossover_frequency: float
    modulus_margin: float


def open_loop(drive: Drive, position: float) -> control.StateSpace:
    """The discrete open loop from motor torque to commanded torque, linearised about a car position [m].

    The displacements of car and counterweight are omitted, since nothing depends on them.
    """
    hoist, keep = state_space(drive, position), [S, V_S, V_C, V_W, T_C, T_W]
    encoder = np.array([[drive.servo.position_bandwidth, 1.0, 0.0, 0.0, 0.0, 0.0]])
    seen = control.ss(hoist.A[np.ix_(keep, keep)], hoist.B[keep, :1], encoder, 0.0)
    return sampled_speed_control(drive) * control.sample_system(seen, drive.servo.sample_period, method="zoh")


def margins(drive: Drive, position: float) -> Margins:
    """Stability margins with the car at `position` [m], from the loop's frequency response."""
    loop = open_loop(drive, position)
    frequencies = np.geomspace(0.01, np.pi / drive.servo.sample_period, _FREQUENCIES)
    response = control.frequency_response(loop, frequencies[:-1])
    gains, phases, distances, _, crossovers, _ = control.stability_margins(response, returnall=True)
    at_half_rate = loop(-1.0).real  # real there, which no crossing of the axis shows
    gains = np.append(gains, -1.0 / at_half_rate if at_half_rate < 0.0 else [])
    nearest = int(np.argmin(np.abs(phases)))
    return Margins(
        float(min(gains[gains > 1.0], default=np.inf)),
        float(min(1.0 / gains[gains < 1.0], default=np.inf)),
        float(phases[nearest]),
        float(crossovers[nearest]),
        float(min(distances)),
    )


def unstable_positions(drive: Drive) -> list[float]:
    """Car positions among bottom, middle and top [m] for which the closed loop has a pole on or outside the unit circle."""
    height = drive.shaft.height
    return [x for x in (0.0, 0.5 * height, height) if max(abs(control.feedback(open_loop(drive, x), 1).poles())) >= 1.0]
