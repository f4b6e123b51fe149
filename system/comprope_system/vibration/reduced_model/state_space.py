"""State-space models of the rope (python-control) for car positions: the reduced model at standstill, in its lowest modes.

States are amplitudes and velocities of the modes, of the car side and then of the counterweight side. Inputs are speed and
acceleration of the car, which change the rope's offset at the sheave; the velocity of the offset is a state, so that inputs need
not be differentiated. Outputs are outward displacements relative to rest at fractions of the length of each side.
"""

from typing import Any

import control
import numpy as np
from numpy.typing import NDArray

from .finite_elements import band_times, interpolation_matrix, matrices, nodes
from .string_dynamics import standstill_modes
from .swing import SIDES, ReducedModel

Floats = NDArray[np.float64]

MODES = 4
OUTPUTS = (0.25, 0.5, 0.75)  # of a side's length, from the axle
FILTER = 20.0  # 1/s: the offset follows speed and acceleration through this lag, so that it has a rate


def rope_state_space(reduced: ReducedModel, car: float) -> control.StateSpace:
    """Both sides with the car at `car` [m]: inputs car_speed, car_acceleration; outputs displacements [m]; see the module."""
    parts = [_side(reduced, side, car) for side in SIDES]
    joined = control.append(*parts)
    both = control.StateSpace(joined.A, joined.B @ np.vstack([np.eye(2), np.eye(2)]), joined.C, np.zeros((len(joined.C), 2)))
    outputs = [f"{side}_{100 * share:.0f}_percent" for side in SIDES for share in OUTPUTS]
    states = [f"{side}_{name}" for side in SIDES for name in _states()]
    return control.ss(
        both.A, both.B, both.C, both.D, inputs=["car_speed", "car_acceleration"], outputs=outputs, states=states, name="rope"
    )


def _states() -> list[str]:
    return [f"{what}{k}" for what in ("amplitude", "rate") for k in range(1, MODES + 1)] + ["offset", "offset_rate"]


def _side(reduced: ReducedModel, side: str, car: float) -> control.StateSpace:
    """One side about rest: q'' + c q' + W^2 q = -(m b'' + c m b' + k b), b through two lags of speed and acceleration."""
    rope, M, sign, end_share = reduced.rope, matrices(), SIDES[side], 1.0 - nodes()
    length = float(reduced.length(side, np.array([car]))[0])
    squares, V, stiffness = standstill_modes(rope, length)
    squares, V = squares[:MODES], V[:, :MODES]
    m, k = (V.T @ band_times(one, end_share) for one in (M.mass, stiffness))
    offset = rope.offset
    by_speed = sign * rope.bending_stiffness / (2.0 * rope.radius * rope.weight) * rope.offset_coefficients[1]
    by_acceleration = -sign * offset * rope.rotating_mass / rope.weight
    n, F = MODES, FILTER
    A, B = np.zeros((2 * n + 2, 2 * n + 2)), np.zeros((2 * n + 2, 2))
    A[:n, n : 2 * n] = np.eye(n)
    A[n : 2 * n, :n], A[n : 2 * n, n : 2 * n] = -np.diag(squares), -rope.damping * np.eye(n)
    A[2 * n, 2 * n + 1], A[2 * n + 1, 2 * n :] = 1.0, [-(F**2), -2.0 * F]
    B[2 * n + 1] = F**2 * np.array([by_speed, by_acceleration])
    A[n : 2 * n] -= np.outer(m, A[2 * n + 1])
    A[n : 2 * n, 2 * n] -= k
    A[n : 2 * n, 2 * n + 1] -= rope.damping * m
    B[n : 2 * n] = -np.outer(m, B[2 * n + 1])
    share = np.array(OUTPUTS)
    C = np.hstack(
        [interpolation_matrix(share)[:, 1:-1] @ V, np.zeros((len(share), n)), (1.0 - share)[:, None], np.zeros((len(share), 1))]
    )
    return control.ss(A, B, C, np.zeros((len(share), 2)))


def as_json(model: control.StateSpace) -> dict[str, Any]:
    """Matrices and names, as `control.ss(A, B, C, D, states=..., inputs=..., outputs=...)` takes them."""
    matrices_ = {name: np.asarray(getattr(model, name)).tolist() for name in "ABCD"}
    return matrices_ | {"states": model.state_labels, "inputs": model.input_labels, "outputs": model.output_labels}
