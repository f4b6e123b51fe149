"""The rope of the 50 m test tower, and trips of its ends, as the tests of the rope use them."""

import numpy as np

from comprope.drive.trajectory.s_curve import SCurve, TrajectoryPoint
from comprope.rope.model_file import RopeModel, validated, with_changes
from comprope.rope.simulator.rope import CompensationRope

TOWER = validated(
    {
        "shaft": {"height": 50.0, "pit": 1.5},
        "rope": {
            "mass_per_length": 1.2,
            "diameter": 0.018,
            "axial_stiffness": 8.0e6,
            "bending_stiffness": 20.0,
            "axial_damping": 2.0e3,
            "bending_damping": 0.1,
        },
        "sheave": {"mass": 120.0, "radius": 0.4, "inertia": 9.6},
        "contact": {"stiffness": 1.2e7, "damping": 8.0e3, "friction_coefficient": 0.3, "slip_velocity": 0.02},
    },
    "tower",
)
# A shaft of one metre: 70 nodes, few enough for dense matrices, round the same sheave.
STUB = with_changes(TOWER, {"shaft.height": 1.0, "shaft.pit": 0.6})


def rope(changes: dict[str, float] | None = None, model: RopeModel = TOWER) -> CompensationRope:
    """A rope of the model with some values changed, not yet at rest anywhere."""
    return CompensationRope(with_changes(model, changes or {}))


def way(radius: float, shaft: float, start: TrajectoryPoint, end: TrajectoryPoint) -> np.ndarray:
    """The path of the ends for `CompensationRope.step` while the car goes from one motion to the next."""
    path = np.zeros((4, 6))
    path[1], path[3] = [-radius, 0, 0] * 2, [radius, 0, 0] * 2
    for at, car in ((0, start), (3, end)):
        path[0, at : at + 3] = -car.position, -car.velocity, -car.acceleration
        path[2, at : at + 3] = car.position - shaft, car.velocity, car.acceleration
    return path.ravel()


def ride(rope: CompensationRope, trip: SCurve, dt: float) -> None:
    """Carry the rope's ends along a trip for one communication step; the counterweight mirrors the car."""
    time, model = float(rope.state.time[0]), rope.model
    rope.step(dt, way(model.sheave.radius, model.shaft.height, trip.at(time), trip.at(time + dt)))
