"""Jerk-limited trips: closed form against differences, limits, published durations."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from comprope.drive.parameters import Profile
from comprope.drive.trajectory.s_curve import SCurve, TrajectoryPoint, plan_s_curve

TOWER = Profile(speed=2.5, acceleration=0.8, jerk=0.8)
PAPER_FIG_7 = Profile(speed=9.0, acceleration=1.1, jerk=0.93)

profiles = st.builds(Profile, speed=st.floats(0.05, 15.0), acceleration=st.floats(0.05, 2.0), jerk=st.floats(0.05, 10.0))
heights = st.floats(0.0, 500.0)
distances = st.one_of(st.floats(1e-6, 1e-2), st.floats(0.01, 500.0))


def test_a_trip_of_22_m_lasts_10_2_s() -> None:
    trip = plan_s_curve(PAPER_FIG_7, 0.0, 22.0, 0.0)
    assert trip.duration == pytest.approx(10.2, abs=0.02)  # the jerk is known to two digits
    assert trip.ramp == pytest.approx(1.18, abs=0.01)
    assert trip.plateau == pytest.approx(2.74, abs=0.02)
    assert trip.cruise == 0.0
    assert trip.at(trip.duration / 2).velocity < PAPER_FIG_7.speed


def test_the_tower_trip_reaches_rated_speed() -> None:
    trip = plan_s_curve(TOWER, 0.0, 50.0, 0.0)
    # distance / speed, and the time that speeding up and down costs: speed / acceleration + acceleration / jerk
    assert trip.duration == pytest.approx(50.0 / 2.5 + 2.5 / 0.8 + 0.8 / 0.8, rel=1e-12)
    middle = trip.at(trip.duration / 2)
    assert (middle.position, middle.velocity) == pytest.approx((25.0, 2.5))
    assert (middle.acceleration, middle.jerk) == (0.0, 0.0)


def test_a_short_trip_has_neither_cruise_nor_plateau() -> None:
    trip = plan_s_curve(TOWER, 10.0, 9.9, 5.0)
    assert trip.duration == pytest.approx(4.0 * (0.1 / (2 * 0.8)) ** (1 / 3), rel=1e-12)
    assert (trip.cruise, trip.plateau) == (0.0, 0.0)
    assert max(abs(trip.at(5.0 + trip.duration * k / 1000).acceleration) for k in range(1001)) < 0.8


def test_a_jerk_too_small_for_the_acceleration_still_reaches_the_speed() -> None:
    lazy = Profile(speed=1.0, acceleration=2.0, jerk=0.1)
    trip = plan_s_curve(lazy, 0.0, 100.0, 0.0)
    assert trip.at(trip.duration / 2).velocity == pytest.approx(1.0)
    assert trip.at(trip.ramp).acceleration == pytest.approx(math.sqrt(1.0 * 0.1))
    assert trip.plateau == 0.0


def test_rest_before_and_after() -> None:
    trip = plan_s_curve(TOWER, 40.0, 3.0, 7.0)
    assert trip.at(-1.0) == trip.at(7.0) == TrajectoryPoint(40.0)
    assert trip.at(trip.end_time) == trip.at(1e6) == TrajectoryPoint(3.0)


def test_no_way_takes_no_time() -> None:
    trip = plan_s_curve(TOWER, 12.0, 12.0, 7.0)
    assert trip.duration == 0.0
    assert trip.at(6.0) == trip.at(7.0) == trip.at(8.0) == TrajectoryPoint(12.0)


@given(profiles, heights, distances, st.booleans())
def test_limits_are_kept(profile: Profile, origin: float, distance: float, up: bool) -> None:
    trip = plan_s_curve(profile, origin, origin + distance if up else origin - distance, 0.0)
    rounding = 1.0 + 1e-9
    for k in range(201):
        at = trip.at(trip.duration * k / 200)
        assert abs(at.velocity) <= profile.speed * rounding
        assert abs(at.acceleration) <= profile.acceleration * rounding
        assert abs(at.jerk) <= profile.jerk
        assert at.velocity * (1 if up else -1) >= 0.0


@given(profiles, heights, distances, st.booleans())
def test_halves_meet_and_every_phase_joins(profile: Profile, origin: float, distance: float, up: bool) -> None:
    trip = plan_s_curve(profile, origin, origin + distance if up else origin - distance, 0.0)
    joins = [0.0, trip.ramp, trip.ramp + trip.plateau, 2 * trip.ramp + trip.plateau, trip.duration / 2]
    for join in joins + [trip.duration - join for join in joins]:
        before, after = trip.at(join - 1e-9), trip.at(join + 1e-9)
        # in 2 ns nothing moves further than speed, acceleration and jerk times 2 ns, beside rounding
        assert after.position == pytest.approx(before.position, abs=2.1e-9 * profile.speed + 1e-11)
        assert after.velocity == pytest.approx(before.velocity, abs=2.1e-9 * profile.acceleration + 1e-11)
        assert after.acceleration == pytest.approx(before.acceleration, abs=2.1e-9 * profile.jerk + 1e-11)


@given(profiles, st.floats(0.01, 300.0))
def test_velocity_sums_up_to_the_way(profile: Profile, distance: float) -> None:
    trip = plan_s_curve(profile, 0.0, distance, 0.0)
    steps = 4000
    h = trip.duration / steps
    way = sum(trip.at((k + 0.5) * h).velocity for k in range(steps)) * h
    # midpoint rule: error at most duration h^2 max|jerk| / 24
    assert way == pytest.approx(distance, abs=trip.duration * h * h * profile.jerk / 24 + 1e-9 * distance)


@pytest.mark.parametrize("origin, destination", [(0.0, 50.0), (30.0, 8.0), (5.0, 5.5)])
def test_each_output_is_the_derivative_of_the_one_before(origin: float, destination: float) -> None:
    trip, h = plan_s_curve(TOWER, origin, destination, 2.0), 1e-4
    joins = _joins(trip)
    for k in range(1, 300):
        time = 2.0 + trip.duration * k / 300
        if min(abs(time - join) for join in joins) < 2 * h:
            continue  # the jerk jumps here
        low, at, high = trip.at(time - h), trip.at(time), trip.at(time + h)
        assert (high.position - low.position) / (2 * h) == pytest.approx(at.velocity, abs=1e-8)  # j h^2 / 6 and rounding
        assert (high.velocity - low.velocity) / (2 * h) == pytest.approx(at.acceleration, abs=1e-8)
        assert (high.acceleration - low.acceleration) / (2 * h) == pytest.approx(at.jerk, abs=1e-8)


def _joins(trip: SCurve) -> list[float]:
    rising = (0.0, trip.ramp, trip.ramp + trip.plateau, 2 * trip.ramp + trip.plateau)
    return [trip.start_time + join for join in rising] + [trip.end_time - join for join in rising]
