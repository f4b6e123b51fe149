"""Brake, safety gear and buffers of the drive: hand values of rigid masses, slack ropes, traction, energy, refusals."""

from math import exp
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from comprope.drive.kernels import velocity_balance
from comprope.drive.parameters import Brake, Buffer, Drive, FirstTrip, Plant, Profile, SafetyGear, Shaft
from comprope.drive.simulator import DriveSimulator
from comprope.errors import InputError, SimulationError
from comprope.kernels.kernel_linking import uncompiled

G, TRIP = 9.81, 8.0
RIGID = Plant(rope_mass_per_length=0.0, rope_stiffness=1e10, rope_damping=1e6)
LEVELS = {"brake": 0.0, "safety_gear": 0.0}
SHEAVE = RIGID.machine_inertia / RIGID.sheave_radius**2


def elevator(plant: Plant = RIGID, speed: float = 2.5, start: float = 50.0, end: float = 0.0, **tables: Any) -> Drive:
    profile = Profile(speed=speed, acceleration=1.1, jerk=2.0)
    return Drive(profile=profile, plant=plant, trip=FirstTrip(start_position=start, destination=end), **tables)


def run(drive: Drive, duration: float, step: float = 0.01, trip: float = TRIP, **levels: float) -> dict[str, NDArray[np.float64]]:
    """Outputs by name after each step; the inputs `levels` are applied from the time `trip` on."""
    inputs = {"destination": drive.trip.destination, "car_end_tension": 0.0, "counterweight_end_tension": 0.0, **LEVELS}
    simulator, rows = DriveSimulator(drive, inputs, 0.0), []
    for count in range(round(duration / step)):
        simulator.step(count * step, step, inputs | (levels if count * step >= trip - 1e-9 else {}))
        rows.append({"time": (count + 1) * step, **simulator.outputs()})
    return {name: np.array([row[name] for row in rows], float) for name in rows[0]}


def slope(found: dict[str, NDArray[np.float64]], begin: float, end: float) -> float:
    """Mean acceleration of the car [m/s2] between two times."""
    among = (found["time"] > begin) & (found["time"] < end)
    return float(np.polyfit(found["time"][among], found["car_velocity"][among], 1)[0])


def test_without_motor_the_heavier_side_falls() -> None:
    found = run(elevator(), 10.0, brake=1e-12)
    masses = RIGID.car_mass + RIGID.counterweight_mass + SHEAVE
    assert slope(found, 8.5, 10.0) == pytest.approx(G * (RIGID.counterweight_mass - RIGID.car_mass) / masses, rel=2e-4)
    assert found["tripped"].tolist() == [0.0] * 800 + [1.0] * 200
    assert abs(found["motor_torque"][-1]) < 1e-6


def test_a_brake_holds_rigid_masses_back_and_then_holds_them() -> None:
    found = run(elevator(brake=Brake(torque=1500.0, rise_time=0.0)), 10.5, brake=1.0)
    force = 1500.0 / RIGID.sheave_radius + G * (RIGID.counterweight_mass - RIGID.car_mass)
    assert slope(found, 8.3, 9.2) == pytest.approx(force / (RIGID.car_mass + RIGID.counterweight_mass + SHEAVE), rel=2e-3)
    assert abs(found["car_velocity"][-1]) < 1e-6
    assert abs(found["traction_slip"]).max() == 0.0
    assert found["hoist_rope_slack"].max() == 0.0


def test_traction_limits_what_a_brake_holds() -> None:
    """The ropes slide with T_1 / T_2 = e^(f pi): T_1 = m_c (g + a) on the side that goes down, T_2 = m_w (g - a)."""
    drive = elevator(brake=Brake(torque=1e5, rise_time=0.0))
    found = run(drive, 10.0, brake=1.0)
    sliding = float(np.interp(8.4, found["time"], found["car_velocity"]))
    shape = 4.0 * (np.cos(np.pi / 12.0) - np.sin(np.pi / 4.0)) / (np.pi - np.pi / 2.0 - np.pi / 6.0 - 1.0 + 0.5)
    factor = exp(0.1 / (1.0 + abs(sliding) / 10.0) * shape * np.pi) * RIGID.counterweight_mass
    expected = G * (factor - RIGID.car_mass) / (factor + RIGID.car_mass)
    assert slope(found, 8.35, 8.45) == pytest.approx(expected, rel=0.01)
    assert found["traction_slip"][-1] == pytest.approx(-(2.5**2) / 2.0 / 3.1, rel=0.05)
    assert abs(found["car_velocity"][-1]) < 1e-4


@pytest.mark.parametrize("speed", [2.5, 6.0, 9.0])
def test_a_counterweight_flies_by_the_laws_of_throwing(speed: float) -> None:
    """v^2 / 2g from where its ropes are slack; away from the car by v^2 (1/g - 1/a) / 2, while nothing pulls at it."""
    start = 1.0 + 100.0 / speed + 3.0
    drive = elevator(
        speed=speed, start=200.0, shaft=Shaft(height=200.0), safety_gear=SafetyGear(rise_time=0.0), brake=Brake(torque=0.0)
    )
    found = run(drive, start + speed / G + 0.3, 0.002, start, safety_gear=1.0)
    height = found["counterweight_position"]
    loose = int(np.flatnonzero(found["hoist_rope_slack"])[0]) + 2
    thrown = found["counterweight_velocity"][loose]
    assert height.max() - height[loose] == pytest.approx(thrown**2 / (2.0 * G), abs=2e-5)
    gap = (found["car_position"] + height - 200.0).max()
    # Ropes of 100 m carry the car for another 7 ms.
    assert gap == pytest.approx(0.5 * speed**2 * (1.0 / G - 1.0 / 15.0), abs=0.007 * speed)
    assert found["car_velocity"][loose : int(height.argmax())].max() <= 1e-12


@pytest.mark.parametrize("share", [0.0, 1.0])
def test_a_car_in_its_safety_gear_is_lifted_unless_that_holds_both_ways(share: float) -> None:
    """The counterweight falls back and pulls at the car."""
    gear = SafetyGear(upward_share=share)
    found = run(elevator(Plant(), safety_gear=gear), 11.0, safety_gear=1.0)
    lowest = int(found["car_position"].argmin())
    lifted = found["car_position"][lowest:].max() - found["car_position"].min()
    assert (lifted > 0.1) == (share == 0.0)
    assert found["car_hoist_tension"].min() == 0.0


@pytest.mark.parametrize(("tables", "travel"), [({"deceleration": G}, 2.5**2 / (2.0 * G)), ({"stiffness": 4.2e4}, 0.843)])
def test_a_buffer_stops_a_car_that_runs_on(tables: dict[str, float], travel: float) -> None:
    """A hydraulic one by v^2 / 2g; a spring of M (v / s)^2 by its stroke s, and what the weight adds to it."""
    trip = FirstTrip(start_position=20.0, destination=0.0, overrun=50.0)
    drive = Drive(profile=Profile(speed=2.5), plant=RIGID, trip=trip, buffer=Buffer(**tables), brake=Brake(torque=0.0))
    found = run(drive, 14.0, 0.002)
    assert found["tripped"][-1] == 1.0
    assert -found["car_position"].min() - 0.1 == pytest.approx(travel, rel=0.1)


def energy(drive: Drive, found: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    """Kinetic, potential and elastic energy [J] of a hoist whose ropes weigh nothing, with its rim as the encoder has it."""
    plant, rim = drive.plant, np.gradient(found["encoder_position"], found["time"])
    lengths = plant.headroom + 50.0 - found["car_position"], plant.headroom + found["car_position"]
    tensions = found["car_hoist_tension"], found["counterweight_hoist_tension"]
    elastic = sum(T * T * L / (2.0 * plant.rope_stiffness) for T, L in zip(tensions, lengths, strict=True))
    total = 0.5 * SHEAVE * rim**2 + elastic
    for end, mass in (("car", plant.car_mass), ("counterweight", plant.counterweight_mass)):
        total = total + mass * (0.5 * found[f"{end}_velocity"] ** 2 + G * found[f"{end}_position"])
    return np.asarray(total)


@pytest.mark.parametrize("torque", [0.0, 800.0, 2500.0, 1e5])
@pytest.mark.parametrize("damping", [0.0, 6e4])
def test_no_trip_puts_in_energy(torque: float, damping: float) -> None:
    """Slack ropes, slip, brake and gear only take it out: 10 kJ, and it never grows by 3 J; also without any damping."""
    plant = Plant(rope_mass_per_length=0.0, rope_damping=damping)
    drive = elevator(plant, brake=Brake(torque=torque))
    stored = energy(drive, run(drive, 9.5, 0.001, safety_gear=1.0))[8002:-1]
    assert (stored - np.minimum.accumulate(stored)).max() < 3.0
    assert stored[0] - stored[-1] > 1e4


def test_a_step_s_velocities_balance_all_forces() -> None:
    """Whatever slides, is slack or held: of rope, rim, car and counterweight the momentum is that of the forces."""
    kernels, generator = uncompiled(velocity_balance), np.random.default_rng(5)
    for _ in range(300):
        h, ratio = 1e-4, 1.0 + generator.uniform(0.0, 2.0)
        car, counterweight = (
            (2000.0 / h, generator.normal(), 2e4, generator.choice([0.0, 5e4]), 0.0, generator.normal(1e4, 2e4), 1e3)
            for _ in range(2)
        )
        rope = (generator.uniform(0.0, 100.0), generator.uniform(0.0, 100.0), generator.normal(), 1.0 / h, G)
        sheave = (480.0 / h, rope[2] + generator.choice([0.0, 0.3, -0.3]), generator.choice([0.0, 1e4]))
        v_s, v = kernels.velocities_after(rope, car, counterweight, sheave, rope[2] - sheave[1], ratio)
        _, pull, _ = kernels.pulled_end(car, v)
        _, other, _ = kernels.pulled_end(counterweight, -v)
        gained = (v - rope[2]) / h
        first, second = pull + rope[0] * (G + gained), other + rope[1] * (G - gained)
        braked = -(first - second) - sheave[0] * (v_s - sheave[1])
        assert abs(braked) <= sheave[2] * (1.0 + 1e-9) + 1e-3
        assert braked * v_s >= -1e-3
        if v != v_s:
            assert (first == pytest.approx(ratio * second, rel=1e-6, abs=1e-3)) == (v < v_s)
            assert (second == pytest.approx(ratio * first, rel=1e-6, abs=1e-3)) == (v > v_s)


@pytest.mark.parametrize(
    ("inputs", "sentence"),
    [
        ({"brake": 1.5}, "brake = 1.5: 0 \\(released\\) to 1 \\(fully applied\\) is accepted"),
        ({"safety_gear": float("nan")}, "safety_gear = nan: 0 \\(released\\) to 1 \\(fully applied\\) is accepted"),
    ],
)
def test_levels_beyond_fully_applied_are_refused(inputs: dict[str, float], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        run(elevator(), 0.1, trip=0.0, **inputs)


def test_a_car_that_nothing_stops_is_an_error() -> None:
    with pytest.raises(SimulationError, match="has left the shaft of 0 to 50 m after a trip: brake, safety gear or buffer does"):
        run(elevator(), 30.0, 0.05, brake=1e-9)


def test_the_result_depends_little_on_the_communication_step() -> None:
    fine, coarse = (run(elevator(Plant()), 10.0, step, safety_gear=1.0) for step in (0.0025, 0.02))
    for name in ("car_position", "counterweight_position"):
        assert fine[name][-1] == pytest.approx(coarse[name][-1], abs=2e-3), name


def test_the_state_after_a_trip_goes_on_bit_for_bit() -> None:
    drive = elevator(Plant())
    inputs = {"destination": 0.0, "car_end_tension": 900.0, "counterweight_end_tension": 950.0, **LEVELS}
    one, two = DriveSimulator(drive, inputs, 0.0), DriveSimulator(drive, inputs, 0.0)
    one.step(0.0, TRIP, inputs)
    one.step(TRIP, 0.3, inputs | {"safety_gear": 1.0})
    two.set_state(one.get_state())
    for simulator in (one, two):
        simulator.step(TRIP + 0.3, 0.7, inputs | {"safety_gear": 1.0})
    assert one.outputs() == two.outputs()


def test_a_step_of_no_length_trips_nothing() -> None:
    drive = elevator(Plant())
    inputs = {"destination": 0.0, "car_end_tension": 0.0, "counterweight_end_tension": 0.0, **LEVELS}
    simulator = DriveSimulator(drive, inputs, 0.0)
    simulator.step(0.0, 0.01, inputs)
    before = simulator.outputs()
    simulator.step(0.01, 0.0, inputs | {"brake": 1.0})
    assert simulator.outputs() == before
