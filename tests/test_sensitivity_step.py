"""Derivatives of a rope's motion over a few time steps, on few nodes: quick, where test_sensitivity takes trips."""

from functools import cache

import numpy as np
import pytest

from comprope.drive.trajectory.s_curve import TrajectoryPoint
from comprope.rope.model_file import with_changes
from comprope.rope.parameters import Sensor
from comprope.rope.simulator.rope import CompensationRope, values_of
from comprope.rope.simulator.sensitive_rope import SensitiveRope

from .rope_tower import STUB, way

H, STEPS = 0.004, 12
SENSORS = (Sensor(name="car", side="car", height=0.1), Sensor(name="counterweight", side="counterweight", height=0.2))
MODEL = with_changes(
    STUB,
    {
        "solver.step": H,
        "solver.numerical_damping": 0.1,
        "rope.external_damping": 2.0,
        "sheave.mass": 40.0,
    },
).model_copy(update={"sensors": SENSORS})
# Each direction is one parameter; its share is that of the parameter by which whole runs are differenced.
DIRECTIONS = {
    "rope.bending_stiffness": 1e-4,
    "rope.bending_damping": 1e-2,
    "rope.axial_stiffness": 1e-4,
    "rope.axial_damping": 1e-2,
    "rope.external_damping": 1e-2,
    "rope.mass_per_length": 1e-4,
    "sheave.mass": 1e-4,
    "sheave.inertia": 1e-3,
    "shaft.gravity": 1e-4,
    "contact.friction_coefficient": 1e-3,
    "contact.slip_velocity": 1e-3,
    "contact.stiffness": 1e-4,
    "contact.damping": 1e-3,
}


def motion(time: float) -> TrajectoryPoint:
    w = 12.0
    return TrajectoryPoint(0.5 + 0.02 * (1.0 - np.cos(w * time)), 0.02 * w * np.sin(w * time), 0.02 * w * w * np.cos(w * time))


def carried(rope: CompensationRope | SensitiveRope) -> None:
    """Settle the rope and carry it through the car's swing."""
    rope.solve_equilibrium(0.5, 0.5)
    for k in range(STEPS):
        rope.step(H, way(STUB.sheave.radius, STUB.shaft.height, motion(k * H), motion((k + 1) * H)))


@cache
def derivatives() -> SensitiveRope:
    found = SensitiveRope(MODEL, {key: {key: 1.0} for key in DIRECTIONS}, exact=True)
    carried(found)
    return found


@cache
def differences(key: str) -> dict[str, float]:
    """Central differences of whole runs by a parameter."""
    step = DIRECTIONS[key] * values_of(MODEL)[key]
    sides = []
    for change in (step, -step):
        rope = CompensationRope(with_changes(MODEL, {key: values_of(MODEL)[key] + change}))
        carried(rope)
        lateral = {one.name: rope.lateral_displacement(one.side, one.height)[0] for one in SENSORS}
        sides.append(lateral | rope.sheave() | rope.outputs())
    return {name: (sides[0][name] - sides[1][name]) / (2.0 * step) for name in sides[0]}


# What is compared, and what the differences leave of it for a change of a parameter by its whole: steps converged to 1e-8 m
# and, once more, to some 1e-11 m, of a rope whose answer is differenced over 1e-4 to 1e-2 of the parameter.
FLOORS = {
    "car": 5e-9, "counterweight": 5e-9, "sheave_displacement": 1e-10, "sheave_velocity": 1e-8,
    "sheave_angle": 1e-9, "sheave_angular_velocity": 2e-8,
    "sheave_force": 0.02, "car_end_tension": 0.03, "counterweight_end_tension": 0.03,
}  # fmt: skip


@pytest.mark.parametrize("key", DIRECTIONS)
def test_derivatives_are_those_of_whole_runs(key: str) -> None:
    rope, k, expected, whole = derivatives(), list(DIRECTIONS).index(key), differences(key), values_of(MODEL)[key]
    lateral = dict(zip(("car", "counterweight"), rope.lateral_displacement()[:, k].tolist(), strict=True))
    found = lateral | {name: float(value[k]) for name, value in (rope.sheave() | rope.forces()).items()}
    seen = [name for name, floor in FLOORS.items() if abs(expected[name] * whole) > 10.0 * floor]
    assert len(seen) >= 3  # else nothing would be compared
    for name, floor in FLOORS.items():
        # Half a per cent: quadrature points of the contact that begin to touch within the difference.
        assert found[name] * whole == pytest.approx(expected[name] * whole, rel=5e-3, abs=floor), name
