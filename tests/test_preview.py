"""Previews of effects: what is interpolated is what a replay would show, and a browser shows it."""

import numpy as np
import pytest
from playwright.sync_api import expect

from comprope.rope.effects import REGISTRY
from comprope_system.identification.comparison.compare import compare
from comprope_system.identification.comparison.nrmse import nrmse
from comprope_system.identification.data.campaign import load_campaign
from comprope_system.identification.estimation.linearisation import instrument_slope
from comprope_system.identification.prediction.effect_hypotheses import combine, hypotheses_of_effect, instrument_hypotheses
from comprope_system.identification.prediction.parameter_point import ParameterPoint
from comprope_system.identification.preview.effect_preview import preview_effect
from comprope_system.identification.preview.interpolation import NodeLines
from comprope_system.identification.preview.sliders import moved, sliders_of
from comprope_system.identification_results.result.comparison import ComparisonResult
from comprope_system.parallel.executors import threads
from comprope_system.report.curves import BEFORE, MEASURED, MODEL, Curve, Curves, Group, Panel
from comprope_system.report.page import Section, save_page
from comprope_system.report.preview import Preview, PreviewEffect, PreviewRun, PreviewSlider, Response

from . import virtual_elevator
from .browser import BROWSER
from .browser_pages import needs_chromium, opened

LINES = NodeLines(((0.0, 1.0, 2.0, 3.5), (-1.0, 0.0, 1.0, 2.0)), (2, 1))


def hypothesis(name):
    return hypotheses_of_effect(REGISTRY[name], ())[0]


def test_the_derivative_of_a_fault_of_size_zero_is_found_without_a_division_by_it(campaign):
    run, column = campaign.runs[0], "cw_low"
    value = np.sin(run.time)
    for fault in instrument_hypotheses(campaign.channels):
        ((key, amount),) = fault.parameters([0.0]).items()
        if key.endswith(column) and fault.follows_from_predictions:
            with np.errstate(all="raise"):
                slope = instrument_slope(key, ParameterPoint(effects={key: amount}), run, value, campaign.channels)
            assert np.isfinite(slope).all() and np.ptp(slope) > 0.0


def previewed(campaign, executor, one, coefficients):
    point = ParameterPoint(effects=one.parameters(coefficients))
    return preview_effect(one.effect, campaign, point, sliders_of(one.split_coefficients(coefficients)), executor)


@pytest.fixture(scope="module")
def executor():
    with threads() as workers:
        yield workers


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    folder = tmp_path_factory.mktemp("preview")
    return load_campaign(virtual_elevator.campaign(folder, {"effects.bearing_friction.coulomb_torque": 15.0}))


@pytest.fixture(scope="module")
def gain(campaign, executor):
    fault = next(one for one in instrument_hypotheses(campaign.channels) if one.effect == "sensor_gain")
    return previewed(campaign, executor, fault, [2.0])


@pytest.fixture(scope="module")
def two(campaign, executor):
    return previewed(campaign, executor, hypothesis("bearing_friction"), [3.0, 1.0])


# -- interpolation ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("lines", [NodeLines(LINES.lines[:1], (2,)), NodeLines(((3.0, 2.0, 1.0, -0.5),), (1,)), LINES])
def test_at_a_node_the_preview_is_the_replay(lines):
    for k, point in enumerate(lines.points()):
        expected = np.zeros(len(lines.weights(point)))
        expected[k * (1 + len(point))] = 1.0
        assert lines.weights(point) == pytest.approx(expected, abs=1e-12)


def test_a_cubic_in_two_parameters_is_exact():
    centre = LINES.centre

    def cubic(u, v):
        x, y = u - centre[0], v - centre[1]
        value = 1.0 + 2.0 * x - y + 0.5 * x * y + 0.3 * x**2 * y - 0.7 * x * y**2 + 0.1 * x**3 - 0.2 * y**3
        by_u = 2.0 + 0.5 * y + 0.6 * x * y - 0.7 * y**2 + 0.3 * x**2
        by_v = -1.0 + 0.5 * x + 0.3 * x**2 - 1.4 * x * y - 0.6 * y**2
        return value, by_u, by_v

    data = np.concatenate([cubic(*point) for point in LINES.points()])
    for at in np.random.default_rng(1).uniform((0.0, -1.0), (3.5, 2.0), (20, 2)):
        assert LINES.weights(at) @ data == pytest.approx(cubic(*at)[0], abs=1e-10)


# -- against true replays ----------------------------------------------------------------------------------


def test_the_preview_shows_the_error_of_a_true_replay(two, campaign, executor):
    preview, at = two, (20.0, 0.03)
    truth = compare(campaign, executor, moved(preview.point, preview.sliders, at))
    # Half a point is what the sliders may be off by; a straight line from the fit is off by several.
    assert preview.nrmse(at, "fit") == pytest.approx(truth.fit_nrmse, abs=0.005)
    assert preview.nrmse(at, "validate") == pytest.approx(truth.validate_nrmse, abs=0.005)


def test_the_error_is_that_of_the_interpolated_curves(two, campaign):
    at = (7.0, 0.02)
    expected = nrmse(campaign, campaign.of_role("fit"), two.predictions(at))
    assert two.nrmse(at, "fit") == pytest.approx(expected, rel=1e-9)


def test_a_fault_of_an_instrument_needs_no_derivative_of_the_rope(gain, campaign, executor):
    at = (1.07,)
    truth = compare(campaign, executor, moved(gain.point, gain.sliders, at))
    assert gain.nrmse(at, "fit") == pytest.approx(truth.fit_nrmse, rel=1e-6)


def test_more_than_two_parameters_are_moved_effect_by_effect():
    pair = combine(hypothesis("bearing_friction"), hypothesis("attachment_offset"))
    sliders = sliders_of(pair.split_coefficients([3.0, 1.0, 1.0, -2.0]))
    assert [one.key.split(".")[1] for one in sliders] == ["bearing_friction", "attachment_offset"]
    point = ParameterPoint(effects=pair.parameters([3.0, 1.0, 1.0, -2.0]))
    without = moved(point, sliders, [sliders[0].nodes[0], sliders[1].value])
    assert (
        without.effects["effects.bearing_friction.coulomb_torque"] == without.effects["effects.bearing_friction.viscous"] == 0.0
    )
    assert without.effects["effects.attachment_offset.car"] == point.effects["effects.attachment_offset.car"]


def test_a_page_of_many_long_runs_with_sliders_stays_below_3_mb(tmp_path):
    random = np.random.default_rng(1)
    place, rows = np.arange(30_000) * 0.01, random.standard_normal((21, 30_000))
    curves = [Curve(n, s, v) for n, s, v in zip("mba", (MEASURED, BEFORE, MODEL), rows, strict=False)]
    groups = [Group(str(k), str(k), [Panel(str(j), "mm", place, curves) for j in range(10)]) for k in range(15)]
    curves = [Curve("measured", MEASURED, rows[0]), Curve("model", MODEL, rows[0])]
    panels = [Panel(str(j), "mm", place, curves) for j in range(10)]
    responses = [Response(rows, rows @ rows.T)] * len(panels)
    runs = [PreviewRun(Group(str(k), str(k), panels, shown=k == 7), "fit", responses) for k in range(15)]
    sliders = [PreviewSlider(name, "mm", (0.0, 0.5, 1.0, 1.5), 2) for name in "uv"]
    preview = Preview("preview", [PreviewEffect("a", sliders, runs)], {"fit": (0.5, 0.1)})
    save_page(tmp_path / "long.html", "long", "", [Section("a", "A", [Curves("curves", groups), preview])])
    assert 2e6 < (tmp_path / "long.html").stat().st_size < 3e6
    assert 7 in preview.drawn and 0 < len(preview.drawn) < 15
    assert "Not drawn" in (tmp_path / "long.html").read_text()
    if BROWSER:
        with opened((tmp_path / "long.html").as_uri()) as page:
            assert page.locator(".preview output[data-role=fit]").text_content().endswith("%")


# -- in a browser ------------------------------------------------------------------------------------------

MOVE = """([k, value]) => {
  const input = document.querySelectorAll(".preview .slider input")[k];
  input.value = value;
  input.dispatchEvent(new Event("input"));
}"""
DRAWN = "() => window.compropeCurves.get('preview_curves').groups[0].panels?.[0].panel.curves[1].value"


@pytest.fixture(scope="module")
def page(campaign, executor, gain, two, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "compare.html"
    ComparisonResult(compare(campaign, executor), (), (two, gain)).save_html(path)
    return path


def shown_error(page, role):
    return float(page.locator(f".preview output[data-role={role}]").text_content().removesuffix(" %")) / 100.0


@needs_chromium
def test_dragging_a_slider_moves_curves_and_errors_as_computed(page, two, gain, campaign):
    with opened(page.as_uri()) as shown:
        shown.evaluate("document.querySelectorAll('#preview .switches button[aria-pressed=false]').forEach((one) => one.click())")
        assert shown_error(shown, "fit") == pytest.approx(two.nrmse(two.lines.centre, "fit"), rel=6e-3)
        assert shown.locator(".badge").text_content() == "replayed"
        for at in ((4.0, 0.05), (4.0, 0.12), (20.0, 0.12)):
            shown.evaluate(MOVE, [0, at[0]])
            shown.evaluate(MOVE, [1, at[1]])
            shown.wait_for_function("() => !document.querySelector('#preview').waiting")
            shown.wait_for_timeout(60)
            at = tuple(shown.evaluate("compropePreviews.get('preview').at"))  # on the steps of the sliders
            for role in ("fit", "validate"):
                assert shown_error(shown, role) == pytest.approx(two.nrmse(at, role), rel=6e-3)  # three digits are shown
            assert shown.locator(".badge").text_content() == "preview"
            run, column = campaign.runs[0].file, next(iter(campaign.channels))
            expected = two.predictions(at)[run, column] / campaign.channels[column].scale
            drawn = np.array([np.nan if one is None else one for one in shown.evaluate(DRAWN)])
            kept = np.unique(np.linspace(0, len(expected) - 1, len(drawn)).round().astype(int))
            assert np.allclose(drawn, expected[kept], atol=1e-4 * np.ptp(expected))
        shown.get_by_role("button", name="sensor gain").click()
        assert shown.locator(".preview .slider").count() == 1
        assert shown_error(shown, "fit") == pytest.approx(gain.nrmse(gain.lines.centre, "fit"), rel=6e-3)


@needs_chromium
def test_settings_are_pinned_undone_and_kept_over_a_reload(page, two):
    drawn = """() => compropeCurves.get("preview_curves").groups.find((one) => one.panels).panels[0]
      .panel.curves.map((one) => one.name)"""
    with opened(page.as_uri()) as shown:
        assert "stays a preview" in shown.locator(".preview .acts").text_content()
        slider, pins = shown.get_by_label("Coulomb torque [N·m]", exact=True), shown.locator(".pins tbody tr")
        first = slider.input_value()
        for _ in range(30):
            slider.press("ArrowRight")
        second = slider.input_value()
        shown.get_by_role("button", name="Pin").click()
        shown.get_by_role("button", name="Pin").click()  # the same again is not drawn twice
        expect(pins).to_have_count(1)
        at = tuple(shown.evaluate("compropePreviews.get('preview').at"))
        expect(pins.locator("td").nth(1)).to_have_text(f"{100.0 * two.nrmse(at, 'fit'):.3g} %")
        for _ in range(30):
            shown.get_by_role("button", name="Undo").click()
        expect(slider).to_have_value(first)
        expect(shown.get_by_role("button", name="Undo")).to_be_disabled()
        assert len(shown.evaluate(drawn)) == 3 and shown.evaluate(drawn)[1].startswith("bearing friction: Coulomb torque")
        shown.reload()
        expect(pins).to_have_count(1)
        expect(shown.get_by_label("Coulomb torque [N·m]", exact=True)).to_have_value(first)
        pins.get_by_role("button", name="go there").click()
        expect(shown.get_by_label("Coulomb torque [N·m]", exact=True)).to_have_value(second)
        pins.get_by_role("button", name="remove").click()
        expect(pins).to_have_count(0)
        assert shown.evaluate(drawn) == ["measured", "model"]


@needs_chromium
def test_a_replay_stays_until_the_hand_moves_on(page, two):
    with opened(page.as_uri()) as shown:
        slider = shown.get_by_label("Coulomb torque")
        slider.press("ArrowLeft")
        told = """() => {
          const preview = compropePreviews.get("preview"), errors = { fit: 0.123, validate: 0.456 };
          const empty = ({ data }) => [data.name, Object.fromEntries(data.panels.map((one) => [one.name, []]))];
          const curves = Object.fromEntries(preview.curves.groups.map(empty));
          preview.replayed({ effect: preview.effect.name, values: [...preview.at] }, { errors, curves });
        }"""
        shown.evaluate(told)
        expect(shown.locator(".badge")).to_have_text("replayed")
        shown.locator("#preview .switches").first.locator("button[aria-pressed=false]").first.click()  # another run
        expect(shown.locator(".badge")).to_have_text("replayed")
        assert [shown_error(shown, role) for role in ("fit", "validate")] == pytest.approx([0.123, 0.456])
        slider.press("ArrowLeft")
        expect(shown.locator(".badge")).to_have_text("preview")
        assert shown_error(shown, "fit") != pytest.approx(0.123)


@needs_chromium
def test_sliders_obey_the_keyboard_and_fit_a_narrow_window(page):
    with opened(page.as_uri(), 700) as shown:
        slider = shown.get_by_label("Coulomb torque")
        before = float(slider.input_value())
        slider.focus()
        slider.press("ArrowLeft")
        expect(slider).not_to_have_value(f"{before:g}")
        assert float(slider.input_value()) < before
        assert slider.get_attribute("aria-valuetext").endswith("N·m")
        shown.locator(".preview .slider").first.get_by_role("button", name="off").press("Enter")
        expect(slider).to_have_value("0")
        assert shown.evaluate("document.documentElement.scrollWidth") <= 700
        shown.wait_for_function("document.querySelector('#preview').frames?.length > 0")
