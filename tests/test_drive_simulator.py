"""The drive as a model for co-simulation."""

import re
from collections.abc import Iterable, Mapping
from typing import Any

import control
import numpy as np
import pytest
from scipy.integrate import trapezoid

from comprope.drive.control.hoist_dynamics import INPUTS, state_space
from comprope.drive.control.scheduled_plant import scheduled_plant
from comprope.drive.control.servo_control import design_servo, sampled_speed_control
from comprope.drive.cosimulation import create, drive_from_parameters, interface
from comprope.drive.parameters import Drive, FirstTrip, Servo
from comprope.drive.simulator import DriveSimulator
from comprope.drive.trajectory.s_curve import plan_s_curve
from comprope.errors import InputError, SimulationError
from comprope.fmi.validation import interface_problems

STILL = {"destination": 50.0, "car_end_tension": 0.0, "counterweight_end_tension": 0.0, "brake": 0.0, "safety_gear": 0.0}
ROPES = {"destination": 50.0, "car_end_tension": 1250.0, "counterweight_end_tension": 660.0, "brake": 0.0, "safety_gear": 0.0}


def simulator(inputs: Mapping[str, Any] = STILL, start_time: float = 0.0, **parameters: float) -> DriveSimulator:
    names = {name.replace("__", "."): value for name, value in parameters.items()}
    return create(names, inputs, start_time)


def run(
    drive: DriveSimulator, steps: Iterable[float], inputs: Mapping[str, Any] = STILL, time: float = 0.0
) -> list[dict[str, Any]]:
    found = []
    for step in steps:
        drive.step(time, step, inputs)
        time += step
        found.append(drive.outputs())
    return found


def column(outputs: list[dict[str, Any]], name: str) -> np.ndarray:
    return np.array([one[name] for one in outputs])


@pytest.fixture(scope="module")
def up() -> list[dict[str, Any]]:
    return run(simulator(), [0.005] * 6200)


def test_declaration_has_no_problems_and_makes_a_simulator() -> None:
    model = interface()
    assert interface_problems(model) == []
    started = {one.name: one.start for one in model.variables if one.role != "output"}
    inputs = {one.name: started.pop(one.name) for one in model.of_role("input")}
    made = model.create(started, inputs, 0.0)
    assert list(made.outputs()) == [one.name for one in model.of_role("output")]
    assert all(type(made.outputs()[one.name]) is {"real": float, "boolean": bool}[one.kind] for one in model.of_role("output"))


def test_start_values_are_those_of_the_drive_given() -> None:
    model = interface(Drive(trip=FirstTrip(destination=22.0), servo=Servo(torque_limit=7000.0)))
    starts = {one.name: one.start for one in model.variables}
    assert starts["trip.destination"] == starts["destination"] == 22.0
    assert starts["servo.torque_limit"] == 7000.0


@pytest.mark.parametrize("inputs", [STILL, ROPES])
def test_nothing_moves_before_the_trip(inputs: dict[str, float]) -> None:
    drive = simulator(inputs, trip__start_position=20.0)
    first = drive.outputs()
    assert (first["car_position"], first["counterweight_position"]) == (20.0, 30.0)
    assert run(drive, [0.01] * 99, inputs) == [first] * 99
    assert not first["moving"]
    assert not first["trip_finished"]


def test_holding_torque_counts_every_compensation_rope() -> None:
    two, none = (simulator(ROPES, rope__count=count).outputs()["motor_torque"] for count in (2.0, 0.0))
    assert two - none == pytest.approx(2 * (1250.0 - 660.0) * 0.25)


def test_car_follows_within_millimetres(up: list[dict[str, Any]]) -> None:
    error = column(up, "car_position") - column(up, "reference_position")
    stretch = 0.8 * (2000.0 + 2.4 * 54.0 / 2.0) * 54.0 / 3e7  # of the car's rope by its acceleration at the bottom
    assert np.abs(error).max() < 1.2 * stretch  # a little more than that: the jerk sets the rope ringing
    assert np.abs(error).max() > 0.5 * stretch  # elasticity is to be seen
    assert np.abs(column(up, "encoder_position") - column(up, "reference_position")).max() < 2e-4


def test_car_lands_where_it_should(up: list[dict[str, Any]]) -> None:
    last = up[-1]
    assert last["trip_finished"]
    assert last["car_position"] == pytest.approx(50.0, abs=5e-5)
    assert last["counterweight_position"] == pytest.approx(0.0, abs=5e-5)
    assert abs(last["car_velocity"]) < 1e-4


def test_velocity_and_acceleration_belong_to_the_position(up: list[dict[str, Any]]) -> None:
    for body in ("car", "counterweight"):
        position, velocity, acceleration = (column(up, f"{body}_{name}") for name in ("position", "velocity", "acceleration"))
        assert np.gradient(position, 0.005)[1:-1] == pytest.approx(velocity[1:-1], abs=2e-4)  # h^2/6 times the ringing's jerk
        assert np.gradient(velocity, 0.005)[1:-1] == pytest.approx(acceleration[1:-1], abs=2e-2)


def test_power_of_the_motor_is_what_the_masses_and_weights_take(up: list[dict[str, Any]]) -> None:
    work = trapezoid(column(up, "motor_torque") * np.gradient(column(up, "encoder_position"), 0.005) / 0.25, dx=0.005)
    lifted = (2000.0 - 2300.0) * 9.81 * 50.0  # the hoist ropes end as they began, mirrored
    assert work == pytest.approx(lifted, rel=2e-3)  # beside what the ropes' damping took


def small_trip(load: float) -> tuple[list[dict[str, Any]], np.ndarray]:
    """A trip of 15 mm, within one cell, with a pull of `load` N on the car from the start; and python-control's answer."""
    drive = Drive(trip=FirstTrip(destination=0.015, start_time=0.0))
    assert scheduled_plant(drive).boundaries[0] > 0.015
    period, n = drive.servo.sample_period, 1500
    hoist = control.sample_system(state_space(drive, 0.0), period, method="zoh")
    hoist.name = "hoist"
    law, speed = design_servo(drive), sampled_speed_control(drive)
    speed.name, speed.output_labels = "speed", ["f_pi"]
    position = control.ss(
        [], [], [], [[3.0, 1.0, -3.0, -1.0]], period, inputs=["x", "v", "s", "v_s"], outputs=["e"], name="position"
    )
    force = control.ss(
        [], [], [], [[law.acceleration_feedforward, 1.0]], period, inputs=["a", "f_pi"], outputs=["f"], name="force"
    )
    loop = control.interconnect(
        [position, speed, force, hoist], inputs=["x", "v", "a", *INPUTS[1:]], outputs=["x_c", "s", "v_s"], check_unused=False
    )
    trip = plan_s_curve(drive.profile, 0.0, 0.015, 0.0)
    references = [trip.at(k * period) for k in range(n + 1)]
    u = np.array([[one.position, one.velocity, one.acceleration, load, 0.0] for one in references]).T
    expected = control.forced_response(loop, None, u).outputs
    inputs = {**ROPES, "car_end_tension": ROPES["car_end_tension"] + load / drive.rope.count}
    own = create({"trip.destination": 0.015, "trip.start_time": 0.0}, ROPES, 0.0)
    return run(own, [period] * n, inputs), expected


@pytest.mark.parametrize("load", [0.0, 100.0])
def test_the_simulator_answers_like_python_controls_closed_loop(load: float) -> None:
    own, expected = small_trip(load)
    assert column(own, "car_position") == pytest.approx(expected[0, 1:], abs=1e-11)
    assert column(own, "encoder_position") == pytest.approx(expected[1, 1:], abs=1e-11)


@pytest.mark.parametrize("late", [0, 1, 7])
def test_tensions_that_come_with_the_first_steps_belong_to_the_equilibrium(late: int) -> None:
    """Whether an importer propagates them at initialization, in the first step or a little later: the same trip, bit for bit."""
    known, unknown = simulator(ROPES), simulator(STILL)
    expected = run(known, [0.02] * 300, ROPES)
    found = run(unknown, [0.02] * late, STILL) + run(unknown, [0.02] * (300 - late), ROPES, 0.02 * late)
    assert found[late:] == expected[late:]
    assert unknown.get_state() == known.get_state()


def test_tensions_may_come_when_the_car_has_left() -> None:
    """Master and rope begin with the trip: the car does not fall by what the missing pull would have stretched its ropes."""
    known, unknown = simulator(ROPES, trip__start_time=0.0), simulator(STILL, trip__start_time=0.0)
    run(unknown, [0.02], STILL)
    run(known, [0.02], ROPES)
    assert run(unknown, [0.02] * 100, ROPES, 0.02) == run(known, [0.02] * 100, ROPES, 0.02)


def test_tensions_that_change_later_are_a_load() -> None:
    assert run(simulator(ROPES), [0.5], {**ROPES, "car_end_tension": 0.0})[-1]["car_position"] > 1e-4


def test_a_motor_too_weak_for_the_first_tensions_is_refused() -> None:
    with pytest.raises(InputError, match=r"servo\.torque_limit = 2000 N\.m: more than the"):
        simulator(STILL, servo__torque_limit=2000.0).step(0.0, 0.01, {**STILL, "car_end_tension": 50000.0})


def test_a_load_stretches_the_rope_and_the_encoder_stays() -> None:
    drive = simulator(ROPES, trip__destination=0.0)
    last = run(drive, [0.02] * 1000, {**ROPES, "car_end_tension": 1750.0})[-1]
    assert last["encoder_position"] == pytest.approx(0.0, abs=1e-7)
    assert last["car_position"] == pytest.approx(-2 * 500.0 * 54.0 / 3e7, rel=1e-4)
    assert last["motor_torque"] - simulator(ROPES).outputs()["motor_torque"] == pytest.approx(2 * 500.0 * 0.25, rel=1e-4)


STEPS = {
    "1 ms": [0.001] * 3000,
    "5 ms": [0.005] * 600,
    "20 ms": [0.02] * 150,
    "0.7 ms and a bit": [0.0007, 0.0003] * 300 + [0.0277, 0.0123] * 67 + [0.02],
    "uneven": [0.0101, 0.0199, 0.0333333, 0.0366667] * 30,
}


@pytest.mark.parametrize("name", list(STEPS)[1:])
def test_the_communication_step_does_not_matter(name: str) -> None:
    assert sum(STEPS[name]) == pytest.approx(3.0)
    finest, other = (run(simulator(), STEPS[which])[-1] for which in ("1 ms", name))
    assert other == pytest.approx(finest, rel=1e-9, abs=1e-9)


def test_a_controller_that_samples_slower_gives_nearly_the_same() -> None:
    fast, slow = (run(simulator(servo__sample_period=period), [0.02] * 250)[-1] for period in (0.001, 0.004))
    assert slow["car_position"] == pytest.approx(fast["car_position"], abs=1e-3)


@pytest.mark.parametrize("step", [0.001, 0.0007])
def test_a_restored_state_goes_on_bit_for_bit(step: float) -> None:
    drive, other = simulator(), simulator(ROPES)
    run(drive, [step] * 2000)
    saved, time = drive.get_state(), 2000 * step
    on = run(drive, [step] * 200, ROPES, time)
    other.set_state(saved)
    assert other.get_state() == saved
    assert run(other, [step] * 200, ROPES, time) == on
    assert other.get_state() == drive.get_state()


def test_only_its_own_states_are_accepted() -> None:
    with pytest.raises(InputError, match="state of 3 bytes: only a state saved by this version"):
        simulator().set_state(b"abc")


def drive_to(drive: DriveSimulator, calls: Mapping[float, float], stop: float) -> list[dict[str, Any]]:
    """Outputs every 0.1 s; from each time in `calls` on the input `destination` is the value given there."""
    inputs, found = dict(STILL), []
    for k in range(round(stop / 0.1)):
        inputs["destination"] = calls.get(round(k * 0.1, 1), inputs["destination"])
        drive.step(k * 0.1, 0.1, inputs)
        found.append(drive.outputs())
    return found


def test_a_call_while_standing_begins_a_trip() -> None:
    found = drive_to(simulator(trip__destination=3.0), {10.0: 8.0}, 20.0)
    assert found[98]["trip_finished"]
    assert found[98]["reference_position"] == 3.0
    assert found[101]["moving"]
    assert found[-1]["trip_finished"]
    assert found[-1]["car_position"] == pytest.approx(8.0, abs=1e-4)


def test_the_latest_call_during_a_trip_is_answered_after_it() -> None:
    found = drive_to(simulator(trip__destination=3.0), {2.0: 20.0, 3.0: 1.0}, 20.0)
    assert max(column(found, "reference_position")) <= 3.0
    assert max(column(found, "reference_position")) > 2.99
    assert found[-1]["reference_position"] == 1.0


def test_a_call_taken_back_during_the_trip_is_forgotten() -> None:
    found = drive_to(simulator(trip__destination=3.0), {2.0: 20.0, 3.0: 50.0}, 20.0)
    assert found[-1]["reference_position"] == 3.0


def test_calls_do_not_depend_on_the_communication_step() -> None:
    inputs = {**STILL, "destination": 1.0}
    ends = [run(simulator(trip__destination=3.0), [step] * round(12 / step), inputs)[-1] for step in (0.004, 0.02)]
    assert ends[0]["reference_position"] == 1.0
    assert ends[1] == pytest.approx(ends[0], abs=1e-9)


def test_a_run_may_start_at_any_time() -> None:
    early = run(simulator(trip__start_time=1.0), [0.02] * 200)[-1]
    late = run(simulator(start_time=1024.0, trip__start_time=1025.0), [0.02] * 200, time=1024.0)[-1]
    assert late == pytest.approx(early, rel=1e-9, abs=1e-9)


def test_a_motor_at_its_limit_arrives_later_without_swinging() -> None:
    found = run(simulator(servo__torque_limit=1900.0, plant__car_mass=2600.0, servo__position_bandwidth=2.0), [0.02] * 2000)
    torque, position = column(found, "motor_torque"), column(found, "car_position")
    assert np.abs(torque).max() == pytest.approx(1900.0, rel=1e-12)
    assert position.max() < 50.001
    assert position[-1] == pytest.approx(50.0, abs=1e-3)


def test_a_motor_too_weak_is_an_error() -> None:
    text = r"car at .* m at t = .* s has left the shaft of 0 to 50 m: servo.torque_limit = 500 N.m"
    with pytest.raises(SimulationError, match=text):
        run(simulator(servo__torque_limit=500.0), [0.02] * 3000)


def test_impossible_parameters_are_named_all_at_once() -> None:
    with pytest.raises(InputError) as caught:
        drive_from_parameters({"profile.speed": -1.0, "plant.car_mass": 1.0, "servo.colour": 3.0, "trip.destination": 20.0})
    text = str(caught.value)
    assert "profile.speed = -1.0: a number from 0.01 to 25 m/s is accepted" in text
    assert "plant.car_mass = 1.0: a number from 50 to 100000 kg is accepted" in text
    assert "servo.colour = 3.0: unknown key" in text
    assert text.count("; ") >= 2


REFUSED: list[tuple[dict[str, float], dict[str, float], str]] = [
    ({"trip.destination": 60.0}, {}, "trip.destination = 60 m: accepted is 0 to shaft.height = 50 m"),
    (
        {"trip.start_position": 51.0, "trip.destination": 60.0},
        {},
        "trip.start_position = 51 m and trip.destination = 60 m: accepted is 0 to",
    ),
    ({"servo.torque_limit": 100.0}, {}, "servo.torque_limit = 100 N.m: more than the 441.45 N.m that hold the car"),
    ({"servo.speed_bandwidth": 190.0}, {}, "unstable with the car at 0 m and 25 m and 50 m; gains are accepted that"),
    (
        {},
        {"destination": -0.1, "car_end_tension": float("inf")},
        "car_end_tension = inf N: a finite number is accepted; destination",
    ),
    ({}, {"destination": -0.1}, "destination = -0.1 m: 0 to shaft.height = 50 m is accepted"),
    ({"trip.start_time": 0.5}, {}, "trip.start_time = 0.5 s: the start of the simulation, 1 s, or later is accepted"),
]


@pytest.mark.parametrize(("parameters", "inputs", "text"), REFUSED)
def test_what_cannot_be_is_refused_at_the_start(parameters: dict[str, float], inputs: dict[str, float], text: str) -> None:
    valid = {"trip.start_time": 1.0}
    with pytest.raises(InputError, match=re.escape(text)):
        create({**valid, **parameters}, {**STILL, **inputs}, 1.0)


def test_what_cannot_be_is_refused_on_the_way() -> None:
    with pytest.raises(InputError, match=r"counterweight_end_tension = nan N: a finite number is accepted; destination = 50.5 m"):
        simulator().step(0.0, 0.01, {**STILL, "destination": 50.5, "counterweight_end_tension": float("nan")})
