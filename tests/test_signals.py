"""Recovered trips: near the truth, smooth, at rest at both ends, whatever the signal went through."""

import numpy as np
import pytest
from scipy.signal import TransferFunction, lsim

from comprope.errors import InputError
from comprope_system.measurements import recover_trip
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited
from comprope_system.measurements.motion.smoothing.smoothing_spline import smooth

NOISE = 5e-4  # m, a usual encoder
PERIOD = 0.008  # s

PROFILES = {
    "tower": (45.0, 2.5, 0.8, 0.8),
    "short of speed": (22.0, 9.0, 1.1, 0.93),
    "fast": (180.0, 9.0, 1.1, 0.93),
    "down": (-38.0, 2.5, 0.8, 0.8),
}


def true_trip(distance, speed, acceleration, jerk, origin=3.0, start=2.0):
    """A profile of equal limits at both ends."""
    ramp = acceleration / jerk
    plateau = speed / acceleration - ramp
    cruise = abs(distance) / speed - (2.0 * ramp + plateau)
    if cruise < 0.0:
        plateau, cruise = (np.sqrt(ramp**2 + 4.0 * abs(distance) / acceleration) - 3.0 * ramp) / 2.0, 0.0
    return jerk_limited(origin, distance, start, np.array([ramp, plateau, ramp, cruise, ramp, plateau, ramp]))


def sampled(truth, seed, rest=5.0, noise=NOISE):
    time = np.arange(0.0, truth.stop + rest, PERIOD)
    return time, truth.value(time) + noise * np.random.default_rng(seed).standard_normal(len(time))


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


@pytest.mark.parametrize("name", PROFILES)
def test_profile_is_recovered_far_below_the_noise(name):
    truth = true_trip(*PROFILES[name])
    errors, accelerations = [], []
    for seed in range(5):
        time, signal = sampled(truth, seed)
        trip = recover_trip(time, signal)
        grid = np.linspace(0.0, time[-1], 5000)
        errors.append(rms(trip.position(grid) - truth.value(grid)))
        accelerations.append(rms(trip.acceleration(grid) - truth.derivative(grid, 2)))
        assert trip.noise == pytest.approx(NOISE, rel=0.1)
    # Ten numbers from some 3000 samples: noise * sqrt(10 / 3000) = 0.03 mm; twice that for a bad draw.
    assert rms(errors) < 4e-5 and max(errors) < 8e-5
    assert max(accelerations) < 2e-3  # m/s2, of 0.8


@pytest.mark.parametrize("seed", range(3))
def test_gaps_outliers_and_uneven_sampling_do_no_harm(seed):
    rng = np.random.default_rng(seed)
    truth = true_trip(*PROFILES["tower"])
    time = np.sort(rng.uniform(0.0, truth.stop + 5.0, 3500))
    signal = truth.value(time) + NOISE * rng.standard_normal(len(time))
    signal[rng.random(len(time)) < 0.02] += rng.normal(0.0, 1.0)
    signal[600:680] = np.nan
    signal[1500:1504] = 0.0
    trip = recover_trip(time, signal)
    grid = np.linspace(0.0, time[-1], 5000)
    assert rms(trip.position(grid) - truth.value(grid)) < 8e-5


def test_the_car_is_exactly_at_rest_at_both_ends():
    time, signal = sampled(true_trip(*PROFILES["tower"]), 1)
    trip = recover_trip(time, signal)
    for rest in (np.linspace(time[0], trip.rest_before, 50), np.linspace(trip.rest_after, time[-1] + 100.0, 50)):
        assert np.ptp(trip.position(rest)) == 0.0
        assert not np.any(trip.velocity(rest)) and not np.any(trip.acceleration(rest))


def swinging_drive(truth):
    """A car that overshoots its reference: 0.8 Hz, damping ratio 0.4."""
    omega, ratio = 2.0 * np.pi * 0.8, 0.4
    fine = np.arange(0.0, truth.stop + 8.0, 1e-3)
    follow = TransferFunction([2.0 * ratio * omega, omega**2], [1.0, 2.0 * ratio * omega, omega**2])
    _, path, _ = lsim(follow, truth.value(fine) - truth.value(0.0), fine)
    return lambda time: truth.value(0.0) + np.interp(time, fine, path)


def test_a_car_that_does_not_follow_its_profile_is_recovered_too():
    path = swinging_drive(true_trip(*PROFILES["tower"]))
    time = np.arange(0.0, 30.0, PERIOD)
    trip = recover_trip(time, path(time) + NOISE * np.random.default_rng(2).standard_normal(len(time)))
    assert "spline" in trip.kind
    assert rms(trip.position(time) - path(time)) < 1.2e-4
    assert trip.velocity(trip.rest_before) == 0.0 and trip.velocity(trip.rest_after) == 0.0
    # Second derivative of the position given: the curve is one curve, not three.
    grid = np.linspace(trip.rest_before + 0.01, trip.rest_after - 0.01, 4001)
    assert np.allclose(np.gradient(trip.position(grid), grid)[2:-2], trip.velocity(grid)[2:-2], atol=1e-4)
    assert np.allclose(np.gradient(trip.velocity(grid), grid)[2:-2], trip.acceleration(grid)[2:-2], atol=1e-2)


def test_two_trips_in_one_record_need_the_spline_alone():
    up = true_trip(20.0, 2.5, 0.8, 0.8)
    down = true_trip(-12.0, 2.5, 0.8, 0.8, origin=0.0, start=25.0)
    time = np.arange(0.0, 45.0, PERIOD)
    truth = up.value(time) + down.value(time)
    trip = recover_trip(time, truth + NOISE * np.random.default_rng(3).standard_normal(len(time)))
    assert rms(trip.position(time) - truth) < 1.5e-4


def test_a_record_cut_off_on_the_way_is_recovered_as_far_as_it_goes():
    truth = true_trip(*PROFILES["tower"])
    time, signal = sampled(truth, 4)
    trip = recover_trip(time[:1200], signal[:1200])
    assert rms(trip.position(time[:1200]) - truth.value(time[:1200])) < 1.5e-4


def test_a_coarse_encoder_without_noise_is_no_trap():
    truth = true_trip(*PROFILES["tower"])
    time = np.arange(0.0, 30.0, PERIOD)
    trip = recover_trip(time, np.round(truth.value(time), 3))
    # Rounding at rest is the same for all samples there, and nothing can take it away.
    assert rms(trip.position(time) - truth.value(time)) < 3e-4


def test_a_clean_signal_is_kept():
    truth = true_trip(*PROFILES["tower"])
    time = np.arange(0.0, 30.0, PERIOD)
    trip = recover_trip(time, truth.value(time))
    assert np.max(np.abs(trip.position(time) - truth.value(time))) < 1e-6


def test_a_car_that_stays_is_a_trip_too():
    time = np.arange(0.0, 10.0, PERIOD)
    trip = recover_trip(time, 7.0 + NOISE * np.random.default_rng(5).standard_normal(len(time)))
    assert trip.kind == "rest"
    assert np.ptp(trip.position(time)) == 0.0 and abs(trip.position(0.0) - 7.0) < 1e-4


def test_the_counterweight_mirrors_the_car():
    time, signal = sampled(true_trip(*PROFILES["tower"]), 6)
    car = recover_trip(time, signal)
    counterweight = car.mirrored(50.0)
    assert np.allclose(counterweight.position(time), 50.0 - car.position(time), atol=1e-12)
    assert np.array_equal(counterweight.acceleration(time), -car.acceleration(time))
    assert (counterweight.rest_before, counterweight.rest_after) == (car.rest_before, car.rest_after)


@pytest.mark.parametrize(
    ("time", "position", "told"),
    [
        (np.arange(50.0)[::-1], np.zeros(50), r"time = 48 s in row 2: must be later"),
        (np.full(50, np.nan), np.zeros(50), "time: a finite number"),
        (np.arange(50.0), np.full(50, np.nan), "position: 0 numbers; at least 20"),
        (np.arange(0.0, 5.0, 0.01), np.where(np.arange(500) > 250, 30.0, 0.001), r"position changes in steps of 30 m"),
        (np.arange(0.0, 5.0, 0.01), 30.0 * (np.arange(500) > 250) + 1e-3 * np.arange(500), r"position jumps .* at most 25 m/s"),
    ],
)
def test_what_is_no_trip_is_refused(time, position, told):
    with pytest.raises(InputError, match=told):
        recover_trip(time, position)


def test_the_spline_gives_back_a_quintic_and_its_rests():
    """Between its rests the spline of a smooth clean curve is that curve up to the order of its knots."""
    s = np.linspace(0.0, 1.0, 2001)
    curve = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    piece = smooth(4.0 * s, curve, 0.0, 4.0).piece
    assert np.max(np.abs(piece.value(4.0 * s) - curve)) < 1e-5
    for order in (1, 2):
        assert abs(piece.curve(0.0, order)) < 1e-9 and abs(piece.curve(4.0, order)) < 1e-9
