"""The hoist and its servo: statics, resonances, margins, and the sampled design."""

import control
import numpy as np
import pytest

from comprope.drive.control.hoist_dynamics import lumped_hoist, moving_mass, state_space
from comprope.drive.control.scheduled_plant import scheduled_plant
from comprope.drive.control.servo_control import continuous_speed_control, sampled_speed_control
from comprope.drive.control.stability_margins import margins, open_loop, unstable_positions
from comprope.drive.kernels import design, hoist, matrices, stepping
from comprope.drive.kernels.arguments import (
    INPUT_GAIN,
    INTEGRAL,
    MATRIX,
    ROW,
    SERVO,
    T_C,
    T_W,
    V_C,
    V_S,
    V_W,
    X_C,
    X_W,
    S,
)
from comprope.drive.kernels.parameter_vector import vector
from comprope.drive.parameters import Drive, Plant, Servo, Shaft
from comprope.drive.simulator import python_control_design
from comprope.kernels.kernel_linking import uncompiled

DRIVE = Drive()
POSITIONS = [0.0, 10.0, 25.0, 50.0]
KERNELS = uncompiled(hoist, matrices, design, stepping)


def gains() -> np.ndarray:
    return python_control_design(DRIVE).gains


def force_at_rest(position: float, car_pull: float = 0.0, counterweight_pull: float = 0.0) -> float:
    return KERNELS.force_at_rest(vector(DRIVE), position, car_pull, counterweight_pull)


@pytest.mark.parametrize("position", POSITIONS)
def test_moving_mass_is_the_same_everywhere(position: float) -> None:
    parts = lumped_hoist(DRIVE, position)
    assert parts.sheave + parts.car + parts.counterweight == pytest.approx(moving_mass(DRIVE), rel=1e-14)
    rope = DRIVE.plant.rope_mass_per_length * (2 * DRIVE.plant.headroom + DRIVE.shaft.height)
    bodies = DRIVE.plant.car_mass + DRIVE.plant.counterweight_mass + DRIVE.plant.machine_inertia / DRIVE.plant.sheave_radius**2
    assert moving_mass(DRIVE) == pytest.approx(bodies + rope, rel=1e-14)


@pytest.mark.parametrize("position", [0.0, 10.0, 25.0])
def test_the_model_rests_wherever_the_holding_force_holds_it(position: float) -> None:
    way, hoist = 3.0, state_space(DRIVE, position)
    x = np.zeros(8)
    x[S] = x[X_C] = way
    x[X_W] = -way
    half = 0.5 * DRIVE.plant.rope_mass_per_length * DRIVE.shaft.gravity * way  # what each side's mean tension has lost, gained
    x[T_C], x[T_W] = -half, half
    force = force_at_rest(position + way) - force_at_rest(position)
    assert hoist.A @ x + hoist.B @ [force, 0.0, 0.0] == pytest.approx(np.zeros(8), abs=1e-12)


@pytest.mark.parametrize("position", [0.0, 10.0, 25.0])
def test_a_steady_trip_shifts_the_weight_of_the_rope_that_runs_over(position: float) -> None:
    """4.8 kg/s of hoist rope change sides at 2 m/s: the car's mean tension loses half of their weight, the other's gains it."""
    speed, hoist = 2.0, state_space(DRIVE, position)
    x = np.zeros(8)
    x[[V_S, V_C, V_W]] = speed, speed, -speed
    expected = np.zeros(8)
    expected[[S, X_C, X_W]] = speed, speed, -speed
    expected[[T_C, T_W]] = -0.5 * 4.8 * 9.81, 0.5 * 4.8 * 9.81  # N/s
    # Strain rates of 4e6 N/s cancel on each side, which leaves up to 1e-9 N/s of rounding.
    assert hoist.A @ x == pytest.approx(expected, rel=1e-12, abs=1e-8)


def test_holding_force_weighs_all_that_hangs() -> None:
    ropes = 2.4 * 9.81 * (54.0 - 4.0)
    assert force_at_rest(0.0, 1000.0, 700.0) == pytest.approx((2000.0 - 2300.0) * 9.81 + ropes + 300.0)


def test_car_swings_on_its_rope_at_the_frequency_of_spring_and_mass() -> None:
    drive = Drive(plant=Plant(rope_mass_per_length=0.0, rope_damping=0.0))
    hoist = state_space(drive, 0.0)
    keep = [V_C, T_C]  # the sheave held
    frequencies = np.abs(np.linalg.eigvals(hoist.A[np.ix_(keep, keep)]))
    assert frequencies == pytest.approx([np.sqrt(3e7 / 54.0 / 2000.0)] * 2, rel=1e-12)


@pytest.mark.parametrize(("keep", "mass", "length"), [([V_C, T_C], 2000.0, 44.0), ([V_W, T_W], 2300.0, 14.0)])
def test_each_side_swings_and_dies_away_as_spring_and_damper_have_it(keep: list[int], mass: float, length: float) -> None:
    """Stiffness EA / L and damping D / L of the rope's length there, the sheave held and the car 10 m up."""
    plant = Plant(rope_mass_per_length=0.0)
    found = np.linalg.eigvals(state_space(Drive(plant=plant), 10.0).A[np.ix_(keep, keep)])
    assert np.abs(found) == pytest.approx([np.sqrt(plant.rope_stiffness / length / mass)] * 2, rel=1e-9)
    assert found.real == pytest.approx([-plant.rope_damping / length / (2.0 * mass)] * 2, rel=1e-9)


def test_a_slow_pull_at_the_rim_moves_all_masses_alike() -> None:
    hoist = state_space(Drive(plant=Plant(rope_mass_per_length=0.0)), 25.0)
    mass = moving_mass(Drive(plant=Plant(rope_mass_per_length=0.0)))
    slow = 1e-3j
    response = hoist(slow)[:, 0] * mass * slow  # velocities over those of a rigid hoist
    assert response[V_S] == pytest.approx(1.0, abs=1e-6)
    assert response[V_C] == pytest.approx(1.0, abs=1e-6)


def test_speed_control_places_the_poles_on_rigid_ropes() -> None:
    servo = Servo(speed_bandwidth=9.0, speed_damping=0.6)
    drive = Drive(servo=servo)
    rigid = control.tf([1.0], [moving_mass(drive), 0.0])
    poles = control.feedback(continuous_speed_control(drive) * rigid, 1).poles()
    assert np.abs(poles) == pytest.approx([9.0, 9.0], rel=1e-9)
    assert -poles.real / np.abs(poles) == pytest.approx([0.6, 0.6], rel=1e-9)


def test_the_law_is_the_sampled_speed_control() -> None:
    errors, servo = [0.1, -0.02, 0.05, 0.0, 0.3], [0.0] * SERVO
    forces = [KERNELS.servo_force(servo, gains(), error, 0.0, -1e9, 1e9) for error in errors]
    response = control.forced_response(sampled_speed_control(DRIVE), None, errors)
    assert forces == pytest.approx(list(response.outputs), rel=1e-12)


def test_the_integral_waits_while_the_motor_is_at_its_limit() -> None:
    servo = [0.5, *[0.0] * (SERVO - 1)]
    assert KERNELS.servo_force(servo, gains(), 1.0, 0.0, -10.0, 10.0) == 10.0
    assert servo[INTEGRAL] == 0.5
    KERNELS.servo_force(servo, gains(), -1.0, 0.0, -1e9, 1e9)
    assert servo[INTEGRAL] < 0.5


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_an_error_that_takes_the_motor_off_its_limit_is_integrated(sense: float) -> None:
    """Else the integral that holds the motor at its limit would stay where it is, and the car would run past its landing."""
    error, wound_up = -0.01, 1e3
    servo = [sense * wound_up, *[0.0] * (SERVO - 1)]
    assert KERNELS.servo_force(servo, gains(), sense * error, 0.0, -10.0, 10.0) == sense * 10.0
    assert servo[INTEGRAL] == pytest.approx(sense * (wound_up + gains()[INPUT_GAIN] * error), rel=1e-15)


@pytest.mark.parametrize("position", POSITIONS)
def test_margins_are_ample(position: float) -> None:
    found = margins(DRIVE, position)
    assert found.upper_gain_margin > 4.0
    assert found.lower_gain_margin > 4.0
    assert found.phase_margin > 45.0
    assert found.modulus_margin > 0.8


@pytest.mark.parametrize("position", [0.0, 25.0])
def test_gain_margins_are_where_stability_ends(position: float) -> None:
    found, loop = margins(DRIVE, position), open_loop(DRIVE, position)
    for factor, stable in ((found.upper_gain_margin, 1.01), (1.0 / found.lower_gain_margin, 0.99)):
        inside, outside = factor / stable, factor * stable
        assert max(abs(control.feedback(inside * loop, 1).poles())) < 1.0
        assert max(abs(control.feedback(outside * loop, 1).poles())) > 1.0


def test_phase_margin_is_the_delay_that_stability_bears() -> None:
    found, period = margins(DRIVE, 25.0), DRIVE.servo.sample_period
    bears = np.deg2rad(found.phase_margin) / found.crossover_frequency / period  # samples
    z = control.tf([1.0], [1.0, 0.0], period)
    loop = open_loop(DRIVE, 25.0)
    assert bears > 2.0
    assert max(abs(control.feedback(loop * z * z, 1).poles())) < 1.0


def test_wild_gains_are_found_out() -> None:
    assert unstable_positions(DRIVE) == []
    assert unstable_positions(Drive(servo=Servo(speed_bandwidth=150.0))) == [0.0, 25.0, 50.0]


def test_cells_step_like_python_control_and_divide_exactly() -> None:
    plant, work = scheduled_plant(DRIVE), np.zeros(4 * MATRIX + ROW)
    sampled = control.sample_system(state_space(DRIVE, 0.0), DRIVE.servo.sample_period, method="zoh")
    full = np.concatenate([np.random.default_rng(1).normal(size=8), [100.0, 20.0, -30.0]])
    whole, parts = full.copy(), full.copy()
    KERNELS.apply_matrix(plant.step_matrices[0].ravel(), 0, whole, work)
    for share in (0.3, 0.0001, 0.6999):
        KERNELS.advance_matrix(plant.rate_matrices[0].ravel(), 0, share * DRIVE.servo.sample_period, work)
        KERNELS.apply_matrix(work, MATRIX, parts, work)
    assert whole[:8] == pytest.approx(sampled.A @ full[:8] + sampled.B @ full[8:], rel=1e-9)
    assert parts == pytest.approx(whole, rel=1e-9)


def test_neighbouring_cells_differ_little() -> None:
    tall = Drive(shaft=Shaft(height=500.0))
    stiffness = np.array([rate[T_C, V_C] for rate in scheduled_plant(tall).rate_matrices])
    assert np.max(np.abs(np.diff(np.log(np.abs(stiffness))))) < 0.0101
