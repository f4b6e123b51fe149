"""Studies of the paper's results, and the checks of the verification page, on few and short runs."""

import re
from pathlib import Path

import numpy as np
import pytest

from comprope.errors import InputError
from comprope.rope.integration.state import State
from comprope.rope.simulator.rope import CompensationRope
from comprope.rope.simulator.side_shape import side_shape
from comprope_system.presets.paper_installations import (
    BUILDING,
    TOWER,
    installation,
    jerk_limited_trip,
    sheave_changes,
    table,
    trip_up,
)
from comprope_system.report.page import Picture, Section, Table, save_page, save_pictures
from comprope_system.report.plot_style import panels
from comprope_system.studies.paper import fig4, fig5, fig6, fig7, fig8, workflow
from comprope_system.studies.paper.design import least_mass
from comprope_system.studies.paper.peaks import oscillator_peak, peak
from comprope_system.studies.paper.study import StudyOptions
from comprope_system.studies.paper.swing import MEASURES, swing, swing_case
from comprope_system.studies.verification import capstan, invariants, offset, reference, shortening
from comprope_system.studies.verification.free_rope import Hanging, swing_sideways
from comprope_system.vibration.prescribed_trip import record_trip

COARSE = {"rope.element_length": 0.1, "solver.step": 0.01}


def test_fig4_displacement_is_small_from_75_percent_on_and_grows_below() -> None:
    nominal = installation(TOWER).sheave.mass
    offsets = np.array(
        [fig4.static_offset({"model": table(TOWER, sheave_changes(TOWER, f * nominal))}) for f in (0.1, 0.5, 0.75, 1.0)]
    )
    relative = fig4.relative(offsets)[:, 0]
    assert relative[0] == 1.0
    assert 0.0 < relative[2] < 0.05
    assert np.all(np.diff(relative) < 0.0)
    assert offsets[:, 0] == pytest.approx(offsets[:, 1], rel=1e-9)  # mirror image: car half-way


def test_fig5_frequency_follows_the_shortening_side() -> None:
    values = fig5.up_trip(swing_case(TOWER, 50.0))
    comparisons = fig5.STUDY.evaluate(StudyOptions(), [values]).comparisons
    assert [one.verdict for one in comparisons] == ["yes", "yes"]


def test_fig5_frequencies_of_a_chirp_on_a_drift() -> None:
    time = np.arange(0.0, 20.0, 0.01)
    signal = 1e-3 * np.sin(2.0 * np.pi * (0.5 * time + 0.025 * time**2)) + 5e-4 * time
    at, found = fig5.frequencies(time, signal)
    assert found == pytest.approx(0.5 + 0.05 * at, rel=0.02)


def test_fig6_peak_by_parabola() -> None:
    x = np.array([10.0, 14.0, 20.0, 28.0, 40.0])
    assert peak(x, 5.0 - (x - 22.0) ** 2) == pytest.approx(22.0)
    assert peak(x, x) == 40.0


def test_fig6_an_oscillator_peaks_one_jerk_time_after_its_period() -> None:
    """sin(w D / 4) sin(w (D / 2 - Tj) / 2) is largest at D = period + Tj, exactly for profiles with a plateau."""
    distance = oscillator_peak(10.27)
    assert trip_up(BUILDING, distance).duration == pytest.approx(10.27 + 1.1 / 0.93, abs=0.05)


def test_fig6_swing_in_the_building_against_an_independent_simulation() -> None:
    """Half the swing in the middle after 22 m: 5.27 mm by another program; here on a coarse mesh."""
    found = swing(swing_case(BUILDING, 22.0, COARSE))
    assert found["duration"] == pytest.approx(10.2, abs=0.02)
    assert 1e3 * found["middle_after"] == pytest.approx(fig6.INDEPENDENT[22.0], rel=0.06)
    assert set(MEASURES) <= set(found)
    assert 0.7 * found["middle_after"] < found["mode_after"] < 1.3 * found["middle_after"]


def test_fig7_jerk_of_the_stated_duration() -> None:
    assert fig7.jerk_of(22.0, 10.2, 1.1) == pytest.approx(0.93, abs=0.005)
    found = fig7.profile({"trip": {"distance": 22.0, "speed": 9.0, "acceleration": 1.1, "jerk": 0.93}})
    assert (found["ramp"], found["plateau"], found["cruise"]) == (
        pytest.approx(1.18, abs=0.01),
        pytest.approx(2.74, abs=0.02),
        0.0,
    )


def test_fig8_the_fits_tell_an_exponential_from_a_power_law() -> None:
    mass = np.linspace(30.0, 200.0, 9)
    for value, name, rate in ((np.exp(-mass / 80.0), "exponential", 1.0 / 80.0), (mass**-0.7, "power", 0.7)):
        laws = fig8.fits(mass, value * (1.0 + 1e-3 * np.cos(mass)))
        assert min(laws, key=lambda one: laws[one][2]) == name
        assert laws[name][0] == pytest.approx(rate, rel=0.01)
        assert laws[name][1] > 0.999


def test_fig8_trips_are_tuned_to_the_period() -> None:
    assert trip_up(BUILDING, fig8.tuned_distance(119.0)).duration == pytest.approx(10.35, abs=0.05)
    assert fig8.tuned_distance(60.0) > fig8.tuned_distance(190.0)


def test_design_least_mass_keeps_the_limit() -> None:
    model = installation(TOWER, COARSE)
    trip = {"distance": 6.0, "speed": 2.5, "acceleration": 0.8, "jerk": 0.8}
    found = least_mass(model, trip, 0.003)
    runs = dict(found.runs)
    assert runs[found.mass] <= 0.003
    assert all(value > 0.003 for mass, value in found.runs if mass < found.mass)
    with pytest.raises(InputError, match=r"--limit 0.01: .* mm or more is accepted"):
        least_mass(model, trip, 1e-5)


def test_the_page_shows_stated_and_obtained(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    workflow.run(workflow.Request(["fig7"], tmp_path, jobs=1))
    page = (tmp_path / "studies.html").read_text(encoding="utf-8")
    assert "10.2 s" in page
    assert "data:image/png;base64," in page
    assert not re.search(r'(src|href)="(?!data:|#)', page)  # nothing from elsewhere
    assert (tmp_path / "fig7_acceleration.png").stat().st_size > 10_000
    assert "yes" in capsys.readouterr().out


def test_an_unknown_study_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="fig9: not a study"):
        workflow.run(workflow.Request(["fig9"], tmp_path))


def test_pages_escape_texts(tmp_path: Path) -> None:
    figure, _ = panels()
    sections = [Section("a", "A < B", ["x & y", Table(("n", "v"), [("1.5", "pass"), ("-2", "fail")]), Picture("p", figure, "c")])]
    save_page(tmp_path / "page.html", "T", "", sections)
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "A &lt; B" in text
    assert "x &amp; y" in text
    assert 'class="mark yes">pass' in text
    assert '<td class="number">1.5' in text
    assert [path.name for path in save_pictures(tmp_path, sections)] == ["p.png"]


def test_a_ride_starts_at_rest_and_ends_where_the_trip_does() -> None:
    model = installation(TOWER, COARSE)
    trip = jerk_limited_trip(3.0, 2.5, 0.8, 0.8)
    _, seen = record_trip(model, trip, trip.end_time + 0.2, lambda rope: np.array([-rope.state.q[0], -rope.state.q[rope.n - 1]]))
    assert seen[0] == pytest.approx([0.0, 50.0])
    assert seen[-1] == pytest.approx([3.0, 47.0])


def test_side_shapes_agree_with_the_sensors() -> None:
    rope = CompensationRope(installation(TOWER))
    rope.solve_equilibrium(20.0, 30.0)
    for side in ("car", "counterweight"):
        heights = np.array([0.5, 7.0, 19.0])
        sensors = [rope.lateral_displacement(side, height)[0] for height in heights]
        assert side_shape(rope, side, heights) == pytest.approx(sensors, abs=2e-5)  # linear between nodes against cubic
    assert np.isnan(side_shape(rope, "car", np.array([20.5, -2.0]))).all()


def test_verification_against_the_other_program() -> None:
    """250 elements: 0.098 mm rms, as the other program has with so few; the page shows 1000."""
    time, middle, bottom = reference.reference()
    own = swing_sideways(Hanging(250), 2e-3, 10.0, 0.05)
    assert own[0] == pytest.approx(time)
    assert reference.rms(own[1] - middle) < 1.2e-4
    assert reference.rms(own[2] - bottom) < 1e-5


def test_verification_offset() -> None:
    row = offset._row(20.0, 120.0)
    assert row.worst < offset.ALLOWED
    # EI / (2 r T) = 20 N m2 / (2 * 0.4 m * 596 N) = 41.9 mm at the axle; 2 m above it 6 % less, as the tension grows.
    weight = 9.81 * (120.0 + 1.2 * np.pi * 0.4)
    assert row.rigid[0] == pytest.approx(0.94 * 20.0 / (0.4 * weight), rel=0.03)


def test_a_rope_that_is_shortened_gains_energy_as_its_length_falls() -> None:
    """As 1 / length without friction; friction takes the more the further the rope swings."""
    name, amplitude, changes = shortening.CASES[1]
    row, rubbed = shortening.shorten(name, amplitude, changes), shortening.shorten("", 0.1, {"rope.element_length": 0.1})
    assert abs(row.exponent + 1.0) < shortening.ALLOWED and abs(row.product - 1.0) < shortening.ALLOWED
    assert rubbed.product < 0.8 and rubbed.lost > 10.0


def test_a_rope_that_slides_obeys_the_capstan_equation_with_bending() -> None:
    row = capstan.slide(0.3, 20.0)
    assert abs(row.error) < capstan.ALLOWED
    assert row.form == pytest.approx(2.33, abs=0.01)  # by hand, with 62.5 N of bending
    without = capstan.closed_form(installation(TOWER, {"rope.bending_stiffness": 0.0, "rope.mass_per_length": 0.05}), 500.0)
    assert without == pytest.approx(500.0 * np.exp(0.3 * np.pi), rel=1e-3)


def test_the_verdict_of_an_offset_is_its_largest_difference_from_the_closed_form() -> None:
    form = np.array([0.04, 0.03, 0.02])
    assert offset.Row(20.0, 120.0, form * [1.0, 0.99, 1.004], form, 2.0 * form).worst == pytest.approx(0.01)


def test_a_trip_that_goes_on_from_a_saved_state_is_the_same_and_from_another_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not invariants.restart_differs()
    restore = State.from_bytes

    def restore_inexactly(state: State, data: bytes) -> None:
        restore(state, data)
        state.v[9] += 1e-9  # m/s

    monkeypatch.setattr(State, "from_bytes", restore_inexactly)
    assert invariants.restart_differs()


def test_the_mirror_image_of_a_path_exchanges_the_ends_and_turns_sideways_motion_round() -> None:
    """Rows: car down, car sideways, counterweight down, counterweight sideways; each begins and ends with three values."""
    path = np.arange(24.0)
    assert invariants.mirrored(path).tolist() == [*range(12, 18), *range(-18, -24, -1), *range(6), *range(-6, -12, -1)]
