"""What the drive follows: shapers, moving averages and free shapes, against their definitions and limits."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from comprope.drive.cosimulation import create, interface
from comprope.drive.parameters import INTERVALS, Curve, Drive, FirstTrip, Profile, Shaper
from comprope.drive.trajectory.input_shaper import design_period, impulses
from comprope.drive.trajectory.reference_trajectory import ReferenceTrajectory, first_trajectory
from comprope.errors import InputError

WAVE = [math.sin(2.0 * math.pi * k / INTERVALS) for k in range(1, INTERVALS)]
CURVE = Curve(**{f"a{k}": value for k, value in enumerate(WAVE, 1)})
SHARES = [0.9, 1.0, 0.5, 0.6, 0.3, 0.2, 0.1, 0.0, -0.1, 0.2, -0.3, -0.2, -0.1, -0.2, -0.4, -0.5, -0.7, -0.8, -0.5]
LOPSIDED = Curve(**{f"a{k}": value for k, value in enumerate(SHARES, 1)})


def left_over(shaper: Shaper, period: float) -> float:
    """The share of the swing of a period [s] and of the shaper's damping that one blow, shaped, leaves."""
    w, z = 2.0 * math.pi / period, shaper.damping
    pole = w * complex(-z, math.sqrt(1.0 - z * z))
    delays = impulses(shaper, (0.0, 0.0), 50.0)
    end = delays[-1][0]
    return abs(sum(share * cmath.exp(pole * (end - delay)) for delay, share in delays)) / abs(cmath.exp(pole * end))


def shaper(count: float, **other: float) -> Shaper:
    return Shaper(impulses=count, period_landing=4.0, period_middle=4.0, **other)


@pytest.mark.parametrize("damping", [0.0, 0.02, 0.2])
@pytest.mark.parametrize("count", [2.0, 3.0])
def test_zv_and_zvd_cancel_the_swing_of_their_period_exactly(count: float, damping: float) -> None:
    assert left_over(shaper(count, damping=damping), 4.0) < 1e-13


def test_zvd_forgives_a_wrong_period_and_zv_does_less() -> None:
    zv, zvd = (left_over(shaper(count), 4.4) for count in (2.0, 3.0))
    assert zv == pytest.approx(math.cos(math.pi / 2.0 / 1.1), rel=1e-12)  # two halves, half of the shaper's period apart
    assert zvd == pytest.approx(zv**2, rel=1e-12)  # ZVD is ZV twice


def test_ei_leaves_its_tolerance_at_its_period_and_no_more_over_a_wider_band_than_zvd() -> None:
    ei, zvd = shaper(3.0, tolerance=0.05), shaper(3.0)
    assert left_over(ei, 4.0) == pytest.approx(0.05, rel=1e-12)
    band = [[left_over(one, 4.0 * ratio) < 0.05 for ratio in np.linspace(0.6, 1.6, 1001)] for one in (ei, zvd)]
    assert sum(band[0]) > 1.3 * sum(band[1])


def test_the_period_follows_the_trip_s_place() -> None:
    own = Shaper(period_landing=10.0, period_middle=6.0)
    places = [design_period(own, way, 200.0) for way in ((0.0, 0.0), (200.0, 200.0), (50.0, 150.0), (0.0, 100.0))]
    assert places == pytest.approx([10.0, 10.0, 6.0, 8.0])


curves = st.sampled_from([Curve(), CURVE, LOPSIDED])


@settings(max_examples=60, deadline=None)
@given(
    curves, st.sampled_from([0.0, 0.01, 0.7, 3.0]), st.sampled_from([1.0, 2.0, 3.0]), st.floats(0.0, 50.0), st.floats(0.0, 50.0)
)
def test_no_limit_is_passed_whatever_shapes_a_trip(
    curve: Curve, smoothing: float, count: float, start: float, end: float
) -> None:
    profile = Profile(smoothing=smoothing)
    drive = Drive(profile=profile, curve=curve, shaper=shaper(count), trip=FirstTrip(start_position=start, destination=end))
    trajectory = first_trajectory(drive)
    seen = [trajectory.at(trajectory.start_time + trajectory.duration * k / 400) for k in range(401)]
    assert max(abs(one.velocity) for one in seen) <= profile.speed * (1.0 + 1e-9)
    assert max(abs(one.acceleration) for one in seen) <= profile.acceleration * (1.0 + 1e-9)
    assert max(abs(one.jerk) for one in seen) <= profile.jerk * (
        1.0 + 1e-6
    )  # smoothing divides differences by as little as 10 ms
    assert trajectory.at(trajectory.end_time).position == end
    low, high = min(start, end), max(start, end)
    assert all(low - 1e-9 <= one.position <= high + 1e-9 for one in seen)


@pytest.mark.parametrize("curve", [Curve(), CURVE, LOPSIDED])
@pytest.mark.parametrize("smoothing", [0.0, 1.3])
def test_velocity_and_acceleration_are_the_position_s_derivatives(curve: Curve, smoothing: float) -> None:
    drive = Drive(profile=Profile(smoothing=smoothing), curve=curve, shaper=shaper(3.0, tolerance=0.05))
    trajectory, h = first_trajectory(drive), 1e-4
    for time in np.linspace(trajectory.start_time + 0.1, trajectory.end_time - 0.1, 37):
        before, now, after = (trajectory.at(time + shift) for shift in (-h, 0.0, h))
        # Differences of 50 m over 0.2 ms keep 1e-10; the acceleration's corners lie within a step now and then.
        assert (after.position - before.position) / (2.0 * h) == pytest.approx(now.velocity, abs=1e-8)
        assert (after.velocity - before.velocity) / (2.0 * h) == pytest.approx(now.acceleration, abs=1e-4)


def test_a_free_shape_is_as_fast_as_its_limits_allow() -> None:
    drive = Drive(curve=CURVE)
    trajectory = first_trajectory(drive)
    seen = [trajectory.at(trajectory.start_time + trajectory.duration * k / 2000) for k in range(2001)]
    used = (
        max(one.velocity for one in seen) / drive.profile.speed,
        max(one.acceleration for one in seen) / drive.profile.acceleration,
        max(one.jerk for one in seen) / drive.profile.jerk,
    )
    assert max(used) == pytest.approx(1.0, abs=1e-3)


def test_without_shaping_a_course_is_its_trip() -> None:
    trajectory = first_trajectory(Drive())
    assert trajectory == ReferenceTrajectory(trajectory.unshaped)
    assert [trajectory.at(one) for one in (3.0, 9.0)] == [trajectory.unshaped.at(one) for one in (3.0, 9.0)]


def test_no_way_takes_no_time_however_it_is_shaped() -> None:
    trip = FirstTrip(start_position=7.0, destination=7.0)
    trajectory = first_trajectory(Drive(profile=Profile(smoothing=2.0), curve=CURVE, shaper=shaper(3.0), trip=trip))
    assert trajectory.duration == 0.0
    assert trajectory.at(5.0).position == 7.0


def test_the_simulator_follows_a_shaped_trajectory_and_restarts_in_it() -> None:
    names = {"profile.smoothing": 0.5, "shaper.impulses": 2.0, "trip.destination": 4.0}
    names |= {f"curve.a{k}": value for k, value in enumerate(SHARES, 1)}
    inputs = {"destination": 4.0, "car_end_tension": 0.0, "counterweight_end_tension": 0.0, "brake": 0.0, "safety_gear": 0.0}
    one, two = (create(names, inputs, 0.0) for _ in range(2))
    one.step(0.0, 3.0, inputs)
    two.set_state(one.get_state())
    for drive in (one, two):
        drive.step(3.0, 12.0, inputs)
    assert one.outputs() == two.outputs()
    assert one.outputs()["trip_finished"]
    assert one.outputs()["car_position"] == pytest.approx(4.0, abs=1e-3)
    assert {"curve.a1", "curve.a19", "shaper.period_middle"} <= {each.name for each in interface().variables}


@pytest.mark.parametrize(
    ("parameters", "text"),
    [
        ({"shaper.impulses": 2.5}, "shaper: impulses = 2.5: accepted is 1, 2 or 3"),
        ({"profile.smoothing": 0.001}, "profile: smoothing = 0.001 s: accepted is 0 (none) or 0.01 to 20 s"),
        ({"curve.a1": 0.5}, "the sum of a1 to a19 is 0.5: accepted is 0, so that the car stops"),
        ({"curve.a1": -0.5, "curve.a2": 0.5}, "no sum below 0 is accepted, so that the car never reverses"),
    ],
)
def test_impossible_shapes_are_refused_with_a_sentence(parameters: dict[str, float], text: str) -> None:
    with pytest.raises(InputError) as caught:
        create(parameters, {one.name: one.start for one in interface().of_role("input")}, 0.0)
    assert text in str(caught.value)


def test_a_shape_out_of_range_is_refused() -> None:
    with pytest.raises(ValidationError):
        Curve(a1=1.5, a2=-1.5)
