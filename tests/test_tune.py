"""Tuning against the rope: the small rope against the full one, the search, the bound, and the command."""

import json

import control
import numpy as np
import pytest

from comprope.drive.parameters import CompensationRopes, Curve, Drive, FirstTrip, Profile, Servo, Shaft, Shaper
from comprope.drive.simulator import DriveSimulator
from comprope.drive.trajectory.reference_trajectory import first_trajectory
from comprope.rope.model_file import load, with_changes
from comprope.rope.simulator.rope import CompensationRope
from comprope_system import cli
from comprope_system.commands.tune import read_times
from comprope_system.modal.hanging_string import HangingString, side_string
from comprope_system.prescribed_trip import side_shape
from comprope_system.presets import model_path
from comprope_system.presets.inputs import load_drive
from comprope_system.reduced_model.calibration import calibrated
from comprope_system.reduced_model.hoist_bounce import hoist_of
from comprope_system.reduced_model.sampled_motion import moves
from comprope_system.reduced_model.state_space import rope_model
from comprope_system.reduced_model.string_dynamics import at_rest, rope_of, still_modes
from comprope_system.reduced_model.swing import PLACES, Case, displacements, full_swing, small_swing, tail
from comprope_system.tuning import report, travel_time_tradeoff
from comprope_system.tuning.search import lower_bound, servo_gains
from comprope_system.tuning.search.profile_families import KINDS, Way, course_of, drive_for
from comprope_system.tuning.search.quasi_random_search import Candidate, Search, _unlike
from comprope_system.tuning.search.trajectory_optimisation import Goal, free_drive
from comprope_system.tuning.task import periods

COARSE = {"rope.element_length": 0.1, "solver.step": 0.01}
TOWER = with_changes(load(model_path("tower50")), COARSE)
LIMITS = Profile(speed=2.5, acceleration=0.8, jerk=0.8)
DRIVE = Drive(shaft=Shaft(height=50.0), profile=LIMITS)
WAY = Way(0.0, 7.0, periods(TOWER))


@pytest.fixture(scope="module")
def case() -> Case:
    return Case(calibrated(TOWER), 50.0, 1.5)


@pytest.fixture(scope="module")
def s_curve(case: Case) -> Drive:
    """The best S-curve of the way in 1.2 times the least time."""
    return search(case).best("S-curve")[0].drive


def goal(case: Case) -> Goal:
    own = small_swing(case, course_of(DRIVE, WAY), tail(TOWER, WAY.destination))
    return Goal(0.5 / own.during, 0.5 / own.after)


def search(case: Case) -> Search:
    watched = tail(TOWER, WAY.destination)
    time = 1.2 * course_of(DRIVE, WAY).duration
    return Search(
        DRIVE, [WAY], time, lambda one: [small_swing(case, course_of(one, WAY), watched)], lambda s: goal(case).cost(s[0])
    )


@pytest.mark.parametrize("kind", [*KINDS, "free"])
def test_sampled_courses_are_the_drive_s_own(kind: str) -> None:
    shares = {"speed": 0.8, "jerk": 0.7, "smoothing": 0.2, "period": 0.6}
    if kind == "free":
        drive = DRIVE.model_copy(update={"curve": Curve(a1=0.5, a2=1.0, a7=-0.3, a15=-1.0, a19=-0.2)})
    else:
        drive = drive_for(DRIVE, kind, shares, WAY.periods, 0.6)
    course = course_of(drive, Way(31.0, 9.0, WAY.periods))
    sampled = moves(course, course.end_time + 1.0, 0.05)
    own = [course.at(time) for time in sampled.time]
    assert sampled.position == pytest.approx([one.position for one in own], abs=1e-11)
    assert sampled.speed == pytest.approx([one.velocity for one in own], abs=1e-11)
    assert sampled.acceleration == pytest.approx([one.acceleration for one in own], abs=1e-11)


def test_the_shape_at_rest_is_the_full_model_s(case: Case) -> None:
    rope = CompensationRope(TOWER)
    rope.settle(10.0, 40.0)
    heights = np.linspace(0.0, 39.0, 30)
    small = at_rest(case.rope, np.array([41.5]), (heights + 1.5) / 41.5)[0]
    # 42 mm of offset; bending above the axle and the coarse mesh are left out of the small rope.
    assert small == pytest.approx(side_shape(rope, "counterweight", heights), abs=2e-4)


def test_bending_damping_makes_the_offset_follow_the_speed() -> None:
    rope, still = calibrated(TOWER), calibrated(with_changes(TOWER, {"rope.bending_damping": 0.0}))
    bending = (rope.bending_stiffness / rope.weight) ** 0.5
    theory = -TOWER.rope.bending_damping / (rope.bending_stiffness * bending)
    assert rope.held[0] == pytest.approx(1.0, abs=0.02)
    assert rope.held[1] == pytest.approx(theory, rel=0.2)  # to first order in the damping, and elements of half a bending length
    assert abs(still.held[1]) < 0.05 * abs(theory)


def test_the_small_rope_swings_as_the_full_one(case: Case) -> None:
    course, watched = course_of(DRIVE, WAY), tail(TOWER, WAY.destination)
    swing, traces = full_swing(load(model_path("tower50")), case, course, watched)
    moved = moves(course, course.end_time + watched, 0.02)
    _, small = displacements(case, moved)["counterweight"]
    full = traces["counterweight"]
    k, count = len(PLACES) // 2, min(len(full), len(small))
    error = np.sqrt(np.mean((full[:count, k] - small[:count, k]) ** 2))
    assert error < 0.06 * np.sqrt(np.mean(full[:, k] ** 2))  # the sheave's bounce, which the small rope does not know
    own = small_swing(case, course, watched)
    assert (own.during, own.after) == pytest.approx((swing.during, swing.after), rel=0.12)


def test_a_light_sheave_is_refused_with_what_is_accepted(capsys) -> None:
    assert run(capsys, "tune", "tower50_light")[0] == 2
    with pytest.raises(Exception, match=r"sheave.mass = 10 kg: more than 11\.\d+ kg is accepted"):
        rope_of(load(model_path("tower50_light")))


def test_the_car_bounces_as_the_drive_s_own() -> None:
    trip = FirstTrip(destination=6.0)
    drive = Drive(trip=trip, profile=Profile(jerk=8.0), rope=CompensationRopes(count=0.0))
    still = {"destination": 6.0, "car_end_tension": 0.0, "counterweight_end_tension": 0.0}
    engine, course, dt = DriveSimulator(drive, still, 0.0), first_trajectory(drive), 0.02
    moved = moves(course, 10.0, dt)
    seen = []
    for k in range(len(moved.time)):
        seen.append(engine.outputs()["car_acceleration"])
        engine.step(k * dt, dt, still)
    added, _ = hoist_of(drive).ends(moved)
    error = np.sqrt(np.mean((np.array(seen) - moved.acceleration - added[2]) ** 2))
    # A quarter of the bounce, 0.13 m/s2, is left: how the servo itself follows so hard a jerk is left out.
    assert error < 0.3 * np.sqrt(np.mean((np.array(seen) - moved.acceleration) ** 2))


def test_waves_as_short_as_the_bounce_s_run_as_fast_as_they_should(case: Case) -> None:
    squares, _, _ = still_modes(case.rope, 41.5)
    string = HangingString(case.rope.weight, case.rope.mass_per_length, 41.5, case.rope.gravity)
    for waves in (1, 5, 15, 25):
        # A thirtieth of the rope's length for a wave's half is under four elements.
        assert 2.0 * np.pi / np.sqrt(squares[waves - 1]) == pytest.approx(string.period(waves), rel=3e-3)


def test_candidates_that_swing_the_same_count_once() -> None:
    shares = [{"speed": 0.3, "jerk": 0.5}, {"speed": 0.9, "jerk": 0.5}, {"speed": 0.9, "jerk": 0.7}]
    tried = [Candidate("S-curve", one, DRIVE, [], cost) for one, cost in zip(shares, (1.0, 1.0, 1.1), strict=True)]
    assert _unlike(tried, ("speed", "jerk"), 3) == [tried[0], tried[2]]


def test_the_time_for_quiet_is_searched_again_until_the_full_model_agrees(monkeypatch) -> None:
    """A rope whose small model promises 0.7 of what the full one leaves, at 1 / factor of the present swing."""
    monkeypatch.setattr(travel_time_tradeoff, "course_of", lambda *_: None)
    monkeypatch.setattr(travel_time_tradeoff, "small_swing", lambda *_: None)
    monkeypatch.setattr(travel_time_tradeoff, "told_of", lambda _, drive, *__: {"time": drive, "full": [1.0, 1.0 / drive]})
    task = type("Task", (), {"case": lambda _: None, "way": None, "watched": 0.0})()
    found = travel_time_tradeoff._time_for(task, lambda factor: (factor, 0.7 / factor), 0.5, 1.0)
    assert found["full"][1] <= 0.5
    assert found["time"] == pytest.approx(2.0, rel=0.06)  # AIM, and the bisection's hundredth


def test_no_profile_beats_the_bound_and_a_short_trip_cannot_hide() -> None:
    course = course_of(DRIVE, WAY)
    for period in (2.0, 4.0, 9.0):
        least = lower_bound.least_spectrum(DRIVE, WAY, 1.001 * course.duration, period)
        assert least <= lower_bound.spectrum(course, period) * 1.02 + 1e-3
    assert lower_bound.least_spectrum(DRIVE, WAY, 0.9 * course.duration, 4.0) == np.inf  # the S-curve is the fastest trip
    assert lower_bound.least_spectrum(DRIVE, WAY, 2.0 * course.duration, 4.0) < 1e-6
    long = 3.0 * course.duration
    assert lower_bound.spectrum(course, long) >= lower_bound.too_short(course.duration, long) > 0.49
    assert lower_bound.too_short(course.duration, 1.9 * course.duration) == 0.0


def test_searched_trips_take_the_time_asked_for_within_the_limits(case: Case, s_curve: Drive) -> None:
    course = course_of(s_curve, WAY)
    assert course.duration == pytest.approx(1.2 * course_of(DRIVE, WAY).duration, rel=1e-6)
    own = s_curve.profile
    assert own.speed <= LIMITS.speed and own.acceleration <= LIMITS.acceleration and own.jerk <= LIMITS.jerk


def test_a_free_shape_swings_less_than_the_best_s_curve_in_the_same_limits_and_time(case: Case, s_curve: Drive) -> None:
    watched, first = tail(TOWER, WAY.destination), course_of(s_curve, WAY)
    drive = free_drive(DRIVE, WAY, first.duration, [case], watched, goal(case), first)
    assert drive is not None
    course = course_of(drive, WAY)
    assert goal(case).cost(small_swing(case, course, watched)) < 0.98 * goal(case).cost(small_swing(case, first, watched))
    assert course.duration == pytest.approx(first.duration, rel=1e-4)
    seen = [course.at(course.start_time + course.duration * k / 1000) for k in range(1001)]
    limits = ("velocity", LIMITS.speed), ("acceleration", LIMITS.acceleration), ("jerk", LIMITS.jerk)
    assert all(max(abs(getattr(one, name)) for one in seen) <= limit * (1.0 + 1e-6) for name, limit in limits)
    assert free_drive(DRIVE, WAY, 0.9 * course_of(DRIVE, WAY).duration, [case], watched, goal(case), first) is None


def test_state_space_models_have_the_rope_s_periods_and_offsets(case: Case) -> None:
    model = rope_model(case, 10.0)
    found = sorted(2.0 * np.pi / abs(pole.imag) for pole in model.poles() if pole.imag > 1e-6)[::-1]
    wanted = [side_string(TOWER, 10.0, side).period() for side in ("car", "counterweight")]
    for period in wanted:
        assert min(abs(one / period - 1.0) for one in found) < 2e-3  # finite elements
    assert isinstance(model, control.StateSpace)
    gain = model.dcgain()[model.output_labels.index("counterweight_50_percent"), 0]
    rest = at_rest(case.rope, np.array([41.5]), np.array([0.5]))[0, 0] / case.rope.offset
    offset = -case.rope.bending_stiffness / (2.0 * case.rope.radius * case.rope.weight) * case.rope.held[1]
    assert gain == pytest.approx(offset * rest, rel=0.02)  # four modes of the shape at rest


def test_servo_gains_keep_their_margins_and_damp_the_bounce_more() -> None:
    present = servo_gains.gains_of(DRIVE)
    best = servo_gains.best_gains(DRIVE)
    assert best.kept
    assert best.bounce > present.bounce
    weak = servo_gains.gains_of(DRIVE.model_copy(update={"servo": Servo(position_bandwidth=10.0)}))
    assert not weak.kept


def test_a_trip_of_the_front_counts_where_it_is_quiet_sooner_than_what_was_found() -> None:
    found = [{"share": 0.5, "time": 9.0, "full": [1.0, 0.4]}, {"share": 0.2, "time": 12.0, "full": [1.0, 0.3]}]
    points = [{"s_curve": {"time": 8.0, "full": [1.0, 0.45]}, "tuned": {"time": 8.0, "full": [1.0, 0.6]}}]
    half, fifth = travel_time_tradeoff.sooner(found, points, {"full": [2.0, 1.0]})
    assert half == {"share": 0.5, "time": 8.0, "full": [1.0, 0.45]}
    assert fifth == found[1]  # nothing leaves a fifth: what was found is told with what it leaves


def run(capsys, *arguments):
    """Exit status, standard output and standard error of a command."""
    with pytest.raises(SystemExit) as done:
        cli.main([str(one) for one in arguments])
    return done.value.code, *capsys.readouterr()


def test_a_tiny_tuning_writes_a_drive_that_the_fmu_runs(capsys, tmp_path, monkeypatch) -> None:
    """One trip of 6 m in a shaft of 12 m, from the command to the page and back into a simulation."""
    few = {kind: KINDS[kind] for kind in ("S-curve", "smooth")}
    for module in ("trip_tuning", "shared_controller"):
        monkeypatch.setattr(f"comprope_system.tuning.{module}.KINDS", few)
    monkeypatch.setattr("comprope_system.tuning.travel_time_tradeoff.LONGEST", 1.15)
    monkeypatch.setattr("comprope_system.tuning.trip_tuning.AVERAGES", (0.0,))
    monkeypatch.setattr("comprope_system.tuning.search.trajectory_optimisation.PROGRAMS", 4)
    monkeypatch.setattr("comprope_system.tuning.trip_tuning.CURVES", 1)
    monkeypatch.setattr("comprope_system.tuning.trip_tuning.OTHERS", 1)
    monkeypatch.setattr("comprope_system.tuning.search.quasi_random_search.SAMPLES", 16)
    monkeypatch.setattr("comprope_system.tuning.search.quasi_random_search.STEPS", 10)
    changes = [*("--set", "rope.element_length=0.2"), *("--set", "solver.step=0.01"), *("--set", "shaft.height=12")]
    told = tmp_path / "told.json"
    status, out, errors = run(
        capsys, "tune", "tower50", *changes, "--trip", "1:7", "--times", "1.2", "--jobs", 1, "--out", tmp_path, "--json", told
    )  # fmt: skip
    assert (status, errors) == (0, "")
    assert out.startswith("1 to 7 m: during/after [mm] present ")
    result = json.loads(told.read_text())
    (trip,) = result["trips"]
    assert trip["points"][0]["tuned"]["time"] == pytest.approx(trip["points"][0]["time"], rel=1e-3)
    assert report.errors(result["trips"])
    names = {path.name for path in tmp_path.iterdir()}
    assert {
        "tuning.html",
        "result.json",
        "rope_models.json",
        "trip_1_7.drive.toml",
        "controller.drive.toml",
        "fronts.png",
    } <= names
    drive = load_drive(tmp_path / "trip_1_7.drive.toml", {"shaft": {"height": 12.0}, "trip": {"destination": 7.0}})
    assert drive.curve.used or drive.shaper != Shaper() or drive.profile != LIMITS
    csv = tmp_path / "trip.csv"
    asked = ["--from", 1, "--to", 7, "--drive", tmp_path / "trip_1_7.drive.toml", "--step", 0.05, "--out", csv]
    assert run(capsys, "simulate", "tower50", *changes, *asked)[0] == 0
    positions = np.genfromtxt(csv, delimiter=",", names=True)["car_position"]
    assert positions[-1] == pytest.approx(7.0, abs=2e-3)


def test_impossible_requests_are_refused_with_every_sentence(capsys, tmp_path) -> None:
    status, _, errors = run(capsys, "tune", "tower50", "--trip", "0:60", "--trip", "up", "--out", tmp_path)
    assert status == 2
    assert errors.splitlines() == [
        f"--trip {text}: two heights FROM:TO from 0 to 50 m, half a metre apart or more, are accepted" for text in ("0:60", "up")
    ]
    status, _, errors = run(capsys, "tune", "tower50", "--times", "0.9,2", "--out", tmp_path)
    assert (status, errors) == (2, "--times 0.9,2: numbers from 1 to 5, with commas between, are accepted\n")
    assert read_times("1.2,1.1") == [1.1, 1.2]
