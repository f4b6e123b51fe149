"""Stops: how car and counterweight move through them, what the sheave does, and what is refused."""


import numpy as np
import pytest
from typer.testing import CliRunner

import comprope_system
from comprope.drive.parameters import Profile
from comprope.drive.trajectory.s_curve import plan_s_curve
from comprope_system.cli import app
from comprope_system.presets.inputs import read_model
from comprope_system.sheave_design.stop_cases import stop_case, stop_cases
from comprope_system.simulation.trips.stop import Stop
from comprope_system.simulation.trips.stop_motion import StoppedMotion, stopped_motions

G, SHAFT, BEGIN = 9.81, 200.0, 9.0


def stopped(stop: Stop, speed: float = 6.0, origin: float = 150.0, destination: float = 5.0) -> dict[str, StoppedMotion]:
    trip = plan_s_curve(Profile(speed=speed, acceleration=1.1, jerk=2.0), origin, destination, 0.0)
    return stopped_motions(trip, stop, SHAFT, G)


@pytest.mark.parametrize("deceleration", [0.5, 3.0, 9.81, 9.9, 15.0, 40.0])
@pytest.mark.parametrize("begin", [1.0, 9.0])
def test_motions_are_smooth_and_end_at_rest_on_taut_ropes(begin: float, deceleration: float) -> None:
    """Position, velocity and acceleration belong together; at the end the counterweight mirrors the car."""
    ends, h = stopped(Stop(begin, deceleration)), 1e-4
    last = max(one.end for one in ends.values())
    for one in ends.values():
        for t in np.linspace(begin - 0.1, last + 0.1, 400):
            assert one.velocity(t) == pytest.approx((one.position(t + h) - one.position(t - h)) / (2.0 * h), abs=2e-4)
            assert one.acceleration(t) == pytest.approx((one.velocity(t + h) - one.velocity(t - h)) / (2.0 * h), abs=2.0)
    assert ends["car"].position(last) + ends["counterweight"].position(last) == pytest.approx(SHAFT, abs=1e-9)
    assert [one.velocity(last) for one in ends.values()] == [0.0, 0.0]


def test_a_counterweight_flies_as_a_body_that_is_thrown() -> None:
    """Up by v^2 / 2g from where its ropes go slack, and never faster than it was; down to what the ropes catch."""
    car, other = (stopped(Stop(BEGIN, 15.0))[end] for end in ("car", "counterweight"))
    times = np.linspace(BEGIN, other.end, 4001)
    heights = np.array([other.position(t) for t in times])
    loose = next(t for t in times if other.acceleration(t) <= -G + 1e-9)
    assert heights.max() == pytest.approx(other.position(loose) + other.velocity(loose) ** 2 / (2.0 * G), abs=1e-4)
    gap = heights - np.array([SHAFT - car.position(t) for t in times])
    # v^2 (1/g - 1/a) / 2 for a brake that takes hold at once; it takes 40 ms.
    assert gap.max() == pytest.approx(18.0 * (1.0 / G - 1.0 / 15.0), rel=0.08)
    assert gap.min() > -1e-9 - 0.02  # m: the landing stretches the ropes no further
    assert max(other.acceleration(t) for t in times) > 50.0


def test_within_gravity_both_ends_stop_alike() -> None:
    ends = stopped(Stop(BEGIN, 9.81))
    for t in np.linspace(BEGIN, ends["car"].end, 50):
        assert ends["car"].position(t) + ends["counterweight"].position(t) == pytest.approx(SHAFT, abs=1e-9)
    assert ends["car"].end - BEGIN == pytest.approx(6.0 / 9.81 + 0.04, abs=1e-9)


@pytest.mark.parametrize(("speed", "by_hand"), [(2.5, 0.051)])
def test_the_sheave_follows_half_of_the_slack_between_the_masses(speed: float, by_hand: float) -> None:
    """51 mm at 2.5 m/s by hand, for a car that is stopped at 15 m/s2; the rope's own stretch and throw come on top."""
    limits = {"speed": speed, "acceleration": 2.0, "jerk": 5.0}
    motion = comprope_system.CarMotion(start=40.0, end=0.0, stop=Stop(3.0, 15.0), **limits)
    table = comprope_system.simulate("tower50", motion, duration=5.0).table
    assert table["sheave_displacement"].max() == pytest.approx(by_hand, abs=0.012)
    assert table["least_element_tension"].min() > -200.0
    assert table["energy_residual"].abs().max() < 5.0
    # Its weight comes down with the counterweight, that lands at some 50 m/s2.
    assert table["sheave_force"].max() > 2.0 * 120.0 * G


def test_a_stop_trips_the_drive_which_the_rope_pulls_at() -> None:
    """With stiff hoist ropes, at once and without the brake the counterweight flies as by hand; later it lifts the car."""
    changes = {"plant.rope_stiffness": 1e9, "safety_gear.rise_time": 0.0, "safety_gear.upward_share": 1.0, "brake.torque": 0.0}
    limits = {"speed": 2.5, "acceleration": 2.0, "jerk": 5.0}
    motion = comprope_system.CarMotion(start=40.0, end=0.0, stop=Stop(3.0, safety_gear=True), **limits)
    result = comprope_system.simulate("tower50", motion, duration=5.0, changes=changes)
    table = result.table
    gap = (table["car_position"] + table["counterweight_position"] - 50.0).max()
    assert gap == pytest.approx(0.5 * 2.5**2 * (1.0 / G - 1.0 / 15.0), rel=0.12)
    assert table["car_velocity"][(table["time"] > 3.3) & (table["time"] < 3.4)].abs().max() < 1e-9
    assert table["energy_residual"].abs().max() < 5.0
    assert table["hoist_rope_slack"].max() == 1.0
    assert table["hoist_rope_slack"][table["time"] < 3.0].max() == 0.0
    assert "hoist ropes" in result.summary()


def test_fmus_trip_as_the_models_do() -> None:
    motion = comprope_system.CarMotion(start=40.0, end=0.0, speed=2.5, stop=Stop(4.0, brake=2000.0))
    one, other = (comprope_system.simulate("tower50", motion, duration=5.5, fmu=fmu).table for fmu in (False, True))
    for name in ("car_position", "counterweight_position", "traction_slip", "sheave_displacement"):
        assert np.allclose(one[name], other[name], rtol=0.0, atol=1e-9), name


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["--stop", "-1"], "stop = -1 s: 0 to 1e6 s is accepted"),
        (["--stop", "0.5"], "stop = 0.5 s: the car is at rest at 0 m; a time at which it moves is accepted"),
        (["--stop", "5", "--deceleration", "1000"], "deceleration = 1000 m/s2: 0.1 to 100 m/s2 is accepted"),
        (["--stop", "5", "--safety-gear"], "safety_gear: the car moves up at 5 s; a time at which it moves down is accepted"),
        (["--safety-gear"], "--safety-gear: accepted with --stop TIME or --buffer KIND"),
        (["--stop", "5", "--safety-gear", "--brake", "900"], "safety_gear and brake: one of them is accepted in a stop"),
        (["--stop", "5", "--brake", "900", "--deceleration", "2"], "deceleration = 2 m/s2: not accepted with brake"),
        (["--buffer", "rubber"], "buffer = rubber: hydraulic or spring is accepted"),
        (["--buffer", "hydraulic", "--stop", "100"], "stop = 100 s: not accepted with a buffer, which is met where the car"),
    ],
)
def test_bad_stops_are_one_sentence(options: list[str], sentence: str) -> None:
    outcome = CliRunner().invoke(app, ["simulate", "tower50", "--direct", *options])
    assert outcome.exit_code != 0
    assert sentence in str(outcome.exception)


def test_a_design_s_stop_tells_rise_force_and_tension() -> None:
    model, profile = read_model("tower50"), Profile(speed=2.5, acceleration=1.5, jerk=3.0)
    cases = stop_cases(model, profile, 3)
    assert [(one["stop"], one["height"]) for one in cases] == [("drive", 25.0), ("1 g", 25.0), ("safety gear", 25.0)]
    found = [stop_case(one) for one in cases]
    assert [one["speed"] for one in found] == pytest.approx([2.5] * 3)
    assert [one["rise"] for one in found] == sorted(one["rise"] for one in found)
    # v^2 (1/g - 1/a) / 4 is 55 mm; the counterweight, falling back, then lifts the car out of its gear.
    assert 0.055 < found[2]["rise"] < 0.4
    assert found[0]["slack_duration"] == 0.0
    assert found[2]["sheave_force"] > 2.0 * found[0]["sheave_force"]
    assert found[2]["peak_tension"] > 0.5 * found[2]["sheave_force"]
