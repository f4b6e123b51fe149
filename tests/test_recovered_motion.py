"""Motions that are no single smooth trip, or measured otherwise than as a height, are recovered within the signal's noise."""

import numpy as np
import pandas as pd
import pytest

from comprope.errors import InputError
from comprope_system import cli
from comprope_system.measurements import recover_trip
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited
from comprope_system.simulation.trips.measured_run import MotionWishes, read_run

HEIGHT = 50.0
NOISE = 5e-4  # m
PHASES = np.array([1.0, 2.125, 1.0, 2.0, 1.0, 2.125, 1.0])  # s


def trip(distance, start=2.0):
    return jerk_limited(0.0, distance, start, PHASES)


def noisy(values, noise=NOISE):
    return values + noise * np.random.default_rng(1).standard_normal(len(values))


@pytest.fixture
def ends(tmp_path):
    """The motions of a run with these columns."""

    def recovered(height=HEIGHT, landings=None, motion="auto", **columns):
        pd.DataFrame(columns).to_csv(tmp_path / "run.csv", index=False)
        wishes = MotionWishes(motion, *(landings or (None, None)))
        return read_run(tmp_path / "run.csv", height, [], wishes)

    return recovered


def stopped(time, speed=9.0, start=2.0, stop=12.0, deceleration=15.0):
    """A car that starts smoothly downwards and is stopped hard."""
    ramp = np.clip((time - start) / 4.0, 0.0, 1.0)
    fall = speed * (3.0 * ramp**2 - 2.0 * ramp**3)
    falls = np.where(time < stop, fall, np.clip(speed - deceleration * (time - stop), 0.0, None))
    return -np.concatenate(([0.0], np.cumsum(0.5 * (falls[1:] + falls[:-1]) * np.diff(time))))


def test_a_trip_up_and_back_does_not_stand_still():
    time = np.arange(0.0, 40.0, 0.02)
    truth = trip(6.0).value(time) - trip(6.0, 20.0).value(time)
    found = recover_trip(time, noisy(truth))
    assert found.kind == "trips" and np.abs(found.position(time) - truth).max() < NOISE
    rest = (time > 13.0) & (time < 19.0)
    assert not found.velocity(time[rest]).any()


def test_a_return_without_a_rest_is_followed_and_said():
    time = np.arange(0.0, 30.0, 0.02)
    truth = 3.0 * np.where((time > 5.0) & (time < 20.0), np.sin(np.pi * (time - 5.0) / 15.0) ** 4, 0.0)
    found = recover_trip(time, noisy(truth))
    assert np.abs(found.position(time) - truth).max() < NOISE
    assert found.kind == "exact" and any("taken as it is" in one for one in found.remarks)


@pytest.mark.parametrize("deceleration", [9.81, 15.0])
def test_a_hard_stop_is_followed_within_the_rounding(deceleration):
    fine = np.arange(0.0, 16.0, 1e-3)
    truth = 150.0 + stopped(fine, deceleration=deceleration)
    time, position = fine[::10], np.round(truth[::10], 4)
    found = recover_trip(time, position)
    assert np.abs(found.position(time) - position).max() <= 1e-4
    inside = (time > 12.05) & (time < 12.5)
    assert found.acceleration(time[inside]) == pytest.approx(deceleration, abs=0.5)


def test_a_noisy_hard_stop_is_followed_within_the_noise():
    fine = np.arange(0.0, 16.0, 1e-3)
    truth = (150.0 + stopped(fine))[::10]
    found = recover_trip(fine[::10], noisy(truth))
    assert np.sqrt(np.mean((found.position(fine[::10]) - truth) ** 2)) < NOISE
    assert np.abs(found.position(fine[::10]) - truth).max() < 4.0 * NOISE


def test_a_mirrored_counterweight_mirrors_the_recovered_car_exactly(ends):
    time = np.arange(0.0, 16.0, 0.01)
    car = np.round(150.0 + stopped(time), 4)
    found = ends(200.0, time=time, car_position=car, counterweight_position=200.0 - car)
    assert np.abs(found.trips["car"].position(time) + found.trips["counterweight"].position(time) - 200.0).max() < 1e-9


def test_a_counterweight_that_jumps_is_recovered_beside_the_car(ends):
    time = np.arange(0.0, 16.0, 0.01)
    car = np.round(150.0 + stopped(time), 4)
    flight = np.clip(time - 12.0, 0.0, 1.0)
    other = np.round(200.0 - car + 4.905 * flight * (1.0 - flight), 4)
    found = ends(200.0, time=time, car_position=car, counterweight_position=other)
    assert np.abs(found.trips["counterweight"].position(time) - other).max() <= 1e-4
    assert any("does not mirror" in one for one in found.remarks)


def test_an_impact_between_two_samples_does_not_ring():
    fine = np.arange(0.0, 8.0, 1e-4)
    acceleration = np.select([fine < 4.0, fine < 4.5, fine < 4.51], [0.0, -9.81, 490.5], 0.0)
    speed = 1e-4 * np.cumsum(acceleration)
    time, position = fine[::100], np.round(20.0 + 1e-4 * np.cumsum(speed), 4)[::100]
    found = recover_trip(time, position, "exact")
    away = np.abs(fine - 4.505) > 0.01
    assert np.abs(found.velocity(fine) - speed)[away].max() < 0.3
    assert np.abs(found.velocity(fine)).max() < 1.05 * 4.905
    before = (fine > 4.1) & (fine < 4.48)
    assert np.abs(found.acceleration(fine[before]) + 9.81).max() < 3.0
    assert any("an impact, or a failure of the sensor" in one for one in found.remarks)


def test_a_trip_that_follows_is_not_missed_by_the_one_before():
    time = np.arange(0.0, 44.0, 4e-3)
    slow = jerk_limited(0.0, 6.0, 14.5, np.array([8.0, 0.1, 1.0, 2.0, 1.0, 2.0, 1.0]))
    truth = trip(6.0).value(time) - slow.value(time)
    found = recover_trip(time, noisy(truth))
    assert np.sqrt(np.mean((found.position(time) - truth) ** 2)) < 0.3 * NOISE
    assert not found.remarks


def test_held_samples_are_no_steps():
    time = np.arange(0.0, 15.0, 0.04)
    truth = trip(18.0).value(time)
    held = noisy(truth)[5 * (np.arange(len(time)) // 5)]
    found = recover_trip(time, held)
    assert np.abs(found.position(time) - truth).max() < 2.0 * NOISE
    assert any("holds its values for 0.2 s" in one for one in found.remarks)


def test_held_samples_of_a_car_under_way_are_no_coarse_steps():
    time = np.arange(5.0, 9.0, 0.01)
    truth = trip(18.0).value(time)
    found = recover_trip(time, noisy(truth)[10 * (np.arange(len(time)) // 10)])
    known = time < 8.905  # the last change of the signal
    assert np.abs(found.position(time) - truth)[known].max() < 3.0 * NOISE  # 40 samples, of which the last has no successor
    with pytest.raises(InputError, match=r"position .* at most"):
        recover_trip(time, np.round(truth))


def test_a_hard_stop_between_held_samples_is_no_failure_of_the_sensor():
    time = np.arange(0.0, 14.0, 0.004)
    truth = stopped(time, speed=3.0, stop=10.05, deceleration=15.0)
    found = recover_trip(time, noisy(truth, 1e-4)[25 * (np.arange(len(time)) // 25)])  # held for 0.1 s
    assert np.abs(found.position(time) - truth).max() < 5e-3 and not any("left out" in one for one in found.remarks)
    assert any("between them a hard stop may move the car by 19 mm unseen" in one for one in found.remarks)


def test_the_steps_of_a_held_signal_are_not_its_resolution():
    time = np.arange(0.0, 4.0, 0.004)
    truth = 1.2 * time + 0.02 * time**2
    found = recover_trip(time, truth[25 * (np.arange(len(time)) // 25)])  # no two updates less than 0.1 m apart
    assert np.abs(found.position(time) - truth)[:975].max() < 1e-3
    assert any("its last 0.1 s are extrapolated, uncertain by some 10 mm" in one for one in found.remarks)


@pytest.mark.parametrize(("quantity", "order"), [("speed", 1), ("acceleration", 2)])
def test_a_speed_or_an_acceleration_needs_one_height(ends, quantity, order):
    time = np.arange(0.0, 16.0, 0.02)
    truth = trip(18.0)
    signal = noisy(truth.derivative(time, order), 2e-3) + 0.01
    with pytest.raises(InputError, match=rf"run.csv: car_{quantity}: .* gives no height: .* 0\.00 to 32\.00 m is accepted"):
        ends(time=time, **{f"car_{quantity}": signal})
    found = ends(time=time, landings=(4.0, None), **{f"car_{quantity}": signal})
    assert np.abs(found.trips["car"].position(time) - 4.0 - truth.value(time)).max() < 0.03
    both = ends(time=time, landings=(4.0, 22.0), **{f"car_{quantity}": signal})
    assert float(both.trips["car"].position(16.0)) == pytest.approx(22.0, abs=1e-6)


def test_heights_at_both_ends_must_agree_with_the_position(ends):
    time = np.arange(0.0, 16.0, 0.02)
    fallen = -trip(18.0).value(time)
    with pytest.raises(InputError, match="car_start"):
        ends(time=time, car_position=fallen)
    found = ends(time=time, car_position=fallen, landings=(40.0, None))
    assert found.trips["car"].position([0.0, 16.0]) == pytest.approx([40.0, 22.0], abs=1e-3)
    with pytest.raises(InputError, match="the car travels -18 m, but -20 m are between the given heights"):
        ends(time=time, car_position=fallen, landings=(40.0, 20.0))


def test_the_counterweight_alone_moves_the_car(ends):
    time = np.arange(0.0, 16.0, 0.02)
    found = ends(time=time, counterweight_position=noisy(trip(18.0).value(time)))
    assert np.abs(found.trips["car"].position(time) - HEIGHT + trip(18.0).value(time)).max() < NOISE


def test_a_record_that_begins_under_way_is_preceded_by_a_run_up(ends):
    time = np.arange(6.0, 16.0, 0.02)
    truth = trip(18.0)
    found = ends(time=time, car_position=noisy(truth.value(time)))
    time = time - 6.0  # as a run's times count
    assert np.abs(found.trips["car"].position(time) - truth.value(time + 6.0)).max() < 2.0 * NOISE
    assert found.simulation_start == found.trips["car"].rest_before < -1.0
    assert not found.trips["car"].velocity(found.simulation_start)
    assert found.trips["car"].velocity(0.0) == pytest.approx(float(truth.derivative(np.array(6.0), 1)), abs=0.02)
    before = np.linspace(found.trips["car"].rest_before, 0.0, 2001)
    assert np.abs(np.diff(found.trips["car"].velocity(before))).max() < 0.01
    assert found.trips["car"].position(before) + found.trips["counterweight"].position(before) == pytest.approx(HEIGHT, abs=1e-9)
    assert any("under way" in one for one in found.remarks)


@pytest.mark.parametrize("sampling", [0.02, 0.04, 0.05])
def test_a_record_that_ends_under_way_goes_on_at_its_speed(ends, sampling):
    time = np.arange(0.0, 8.0, sampling)
    truth = trip(18.0)
    found = ends(time=time, car_position=noisy(truth.value(time))).trips["car"]
    assert np.isinf(found.rest_after)
    assert found.velocity([8.0, 8.2]) == pytest.approx(float(truth.derivative(np.array(8.0), 1)), abs=0.1)


def test_lateral_columns_act_and_idle_ones_are_named(ends):
    time = np.arange(0.0, 16.0, 0.02)
    columns = {"car_lateral_displacement": np.full(len(time), 0.1), "car_speed": trip(18.0).derivative(time, 1)}
    found = ends(time=time, car_position=trip(18.0).value(time), cw_lateral_mm=time, **columns)
    assert found.lateral["car"].position(5.0) == pytest.approx(0.1, abs=1e-9) and "counterweight" not in found.lateral
    for name in ("car_speed", "cw_lateral_mm"):
        assert any(one.startswith(f"{name}: not used") for one in found.remarks)


def test_a_single_failed_sample_of_a_clean_trip_is_left_out_with_a_remark():
    time = np.arange(0.0, 16.0, 0.01)
    position = np.round(trip(18.0).value(time), 4)
    position[700] += 0.02
    found = recover_trip(time, position)
    assert found.kind.startswith("profile") and np.abs(found.position(7.0) - position[699:702:2].mean()) < 1e-3
    assert any("20 mm" in one for one in found.remarks)


def test_a_dense_signal_is_averaged_without_bending_it():
    time = np.arange(0.0, 16.0, 1e-3)
    found = recover_trip(time, trip(18.0).value(time))
    assert np.abs(found.position(time) - trip(18.0).value(time)).max() < 5e-6


def command(capsys, *arguments):
    """Exit status, standard output and standard error of a command."""
    with pytest.raises(SystemExit) as done:
        cli.main([str(one) for one in arguments])
    return done.value.code, *capsys.readouterr()


def test_exact_motion_and_heights_are_options_of_simulate(tmp_path, capsys):
    run, out, time = tmp_path / "run.csv", tmp_path / "out.csv", np.arange(0.0, 3.0, 0.02)
    speed = jerk_limited(0.0, 0.5, 1.0, np.full(7, 0.2)).derivative(time, 1)
    pd.DataFrame({"time": time, "car_speed": speed}).to_csv(run, index=False)
    quick = ["simulate", "tower50", "--car", run, "--set", "rope.element_length=0.2", "--step", "0.05", "--direct"]
    status, _, errors = command(capsys, *quick)
    assert status == 2 and "write car_start" in errors
    status, shown, _ = command(capsys, *quick, "--exact", "--from", "2", "--out", out)
    assert status == 0 and "note: car_speed: integrated to a height" in shown
    assert pd.read_csv(out)["car_position"].iloc[[0, -1]].to_list() == pytest.approx([2.0, 2.5], abs=1e-3)
    status, _, errors = command(capsys, *quick, "--speed", "2")
    assert status == 2 and "speed: not accepted with a measured motion" in errors
