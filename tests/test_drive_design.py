"""The drive's own design, which the native FMU has, against that of python-control."""

import random

import control
import numpy as np
import pytest
from scipy.linalg import expm

from comprope.drive.control.hoist_dynamics import state_space
from comprope.drive.control.stability_margins import open_loop
from comprope.drive.kernels import design, hoist, matrices
from comprope.drive.kernels.arguments import MATRIX, ROW, Design, Inputs, Parameters
from comprope.drive.kernels.checks import GAIN_CHECK
from comprope.drive.kernels.entry_points import compiled
from comprope.drive.kernels.parameter_vector import NAMES, vector
from comprope.drive.parameters import Drive, FirstTrip, Plant, Servo, Shaft
from comprope.drive.simulator import empty_design, empty_workspace, gain_problems, python_control_design
from comprope.drive.status import MESSAGES
from comprope.kernels.kernel_linking import uncompiled
from comprope.kernels.status import SUCCESS, sentence
from comprope.quantities import quantities

KERNELS = uncompiled(matrices, hoist, design)
DRIVES = [
    Drive(),
    Drive(shaft=Shaft(height=500.0), plant=Plant(rope_mass_per_length=12.0), servo=Servo(sample_period=0.01)),
    Drive(
        shaft=Shaft(height=4.0),
        trip=FirstTrip(destination=4.0),
        plant=Plant(rope_mass_per_length=0.0, rope_damping=0.0, headroom=1.0),
    ),
    Drive(plant=Plant(rope_stiffness=1e9, rope_damping=1e6, car_mass=500.0, machine_inertia=0.5)),
]


def own_design(drive: Drive) -> Design:
    parameters, work = Parameters(np.array(vector(drive))), empty_workspace()
    found = empty_design(compiled()["count_points"].bind(parameters)())
    compiled()["design_drive"].bind(parameters, found, work)()
    return found


@pytest.mark.parametrize("drive", DRIVES)
def test_gains_operating_points_and_sampled_matrices_are_those_of_python_control(drive: Drive) -> None:
    own, other = own_design(drive), python_control_design(drive)
    assert own.points == other.points
    assert own.gains == pytest.approx(other.gains, rel=1e-10)
    assert own.boundaries[:-1] == pytest.approx(other.boundaries[:-1], rel=1e-10, abs=1e-10)
    assert own.rates == pytest.approx(other.rates, rel=1e-10, abs=1e-10)
    # Of each state: relative to the largest effect of any other state or input on it.
    for ours, theirs in zip(own.steps.reshape(-1, ROW), other.steps.reshape(-1, ROW), strict=True):
        assert ours == pytest.approx(theirs, abs=1e-10 * np.abs(theirs).max())


def random_drive(generator: random.Random) -> Drive:
    """Plant and servo from anywhere in their ranges, evenly by the logarithm."""

    def part(kind: type) -> dict[str, float]:
        found = {}
        for one in quantities(kind):
            low = max(one.minimum, 1e-3 * one.maximum, 1e-9)
            found[one.name] = float(np.exp(generator.uniform(np.log(low), np.log(one.maximum))))
        return found

    servo = part(Servo) | {"sample_period": generator.choice([1e-4, 1e-3, 0.01])}
    return Drive(plant=Plant(**part(Plant)), servo=Servo(**servo))


def test_poles_are_those_of_python_control() -> None:
    """The largest one decides on stability; wherever it is clearly on one side, both say the same."""
    generator, unstable, radius = random.Random(5), 0, compiled()["check"]
    for _ in range(60):
        drive, work = random_drive(generator), empty_workspace()
        poles = [max(abs(np.linalg.eigvals(closed_loop(drive, x)))) for x in (0.0, 0.5 * drive.shaft.height, drive.shaft.height)]
        if min(abs(pole - 1.0) for pole in poles) < 1e-9:
            continue
        status = radius.bind(Parameters(np.array(vector(drive))), Inputs(np.zeros(3)), work)(number=GAIN_CHECK, t=0.0)
        found = [] if status == SUCCESS else [sentence(MESSAGES, status, work.message)]
        assert found == gain_problems(drive)
        unstable += bool(found)
    assert 5 < unstable < 55


@pytest.mark.parametrize("drive", DRIVES)
def test_the_largest_pole_is_that_of_python_control(drive: Drive) -> None:
    found = KERNELS.closed_loop_radius(vector(drive), 0.0, np.zeros(4 * MATRIX + ROW))
    assert found == pytest.approx(max(abs(control.feedback(open_loop(drive, 0.0), 1).poles())), rel=1e-10)


def closed_loop(drive: Drive, position: float) -> np.ndarray:
    loop = open_loop(drive, position)
    return np.asarray(loop.A - loop.B @ loop.C)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 300.0])
def test_the_exponential_is_scipys(scale: float) -> None:
    made = np.random.default_rng(3).normal(size=(ROW, ROW)) * scale / 6.0
    made -= scale * np.eye(ROW)
    units = np.logspace(-4, 5, ROW)
    matrix, work = units[:, None] * made / units[None, :], np.zeros(4 * MATRIX + ROW)
    work[:MATRIX] = matrix.ravel()
    KERNELS.exponential(ROW, work, 0, work, MATRIX, 2 * MATRIX, 4 * MATRIX)
    found = work[MATRIX : 2 * MATRIX].reshape(ROW, ROW) * units[None, :] / units[:, None]
    expected = expm(made)
    assert found == pytest.approx(expected, abs=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("seed", range(5))
def test_the_spectral_radius_is_that_of_the_eigenvalues(seed: int) -> None:
    generator = np.random.default_rng(seed)
    units = np.logspace(-3, 4, 7)
    matrix = generator.normal(size=(7, 7))
    work = np.zeros(4 * MATRIX + ROW)
    work[:49] = (units[:, None] * matrix / units[None, :]).ravel()
    found = KERNELS.spectral_radius(7, work, 0, MATRIX, 4 * MATRIX)
    assert found == pytest.approx(max(abs(np.linalg.eigvals(matrix))), rel=1e-10)


def test_a_matrix_without_powers_has_no_radius() -> None:
    work = np.zeros(4 * MATRIX + ROW)
    work[1] = 3.0
    assert KERNELS.spectral_radius(2, work, 0, MATRIX, 4 * MATRIX) == 0.0


def test_parameters_are_in_the_order_of_their_declaration() -> None:
    drive = Drive(servo=Servo(torque_limit=4321.0))
    assert vector(drive)[NAMES.index("servo.torque_limit")] == 4321.0
    assert state_space(drive, 0.0).nstates == 8
