"""The curves of a page: what they hold is what was compared, and a browser draws them."""

import json
import re
from dataclasses import replace
from html import unescape
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import comprope_system
from comprope_system.identification.comparison.compare import compare, compared
from comprope_system.identification.comparison.largest_error import largest_error
from comprope_system.identification.data.campaign import load_campaign
from comprope_system.identification.prediction.replay import relative_to_rest
from comprope_system.identification_results.reporting.heat_maps import error_map
from comprope_system.identification_results.reporting.pages.comparison import before_and_after
from comprope_system.identification_results.reporting.run_curves import run_curves
from comprope_system.identification_results.result.comparison import ComparisonResult
from comprope_system.parallel.executors import threads
from comprope_system.report import page as pages
from comprope_system.report.curves import (
    BEFORE,
    GAP,
    MEASURED,
    MODEL,
    Curve,
    Curves,
    Group,
    Panel,
    Span,
    decode,
    thinned,
    with_gaps,
)
from comprope_system.report.heat_map import LEVELS, HeatCell, HeatMap, Target, level_of
from comprope_system.report.page import Section, save_page

from . import virtual_elevator
from .browser import needs_browser, played

TIME = np.arange(0.0, 30.0, 0.01)
AWKWARD = ("<b>low</b>", '$x$ & "y"', "y (mm)", "</script><script>wrong.push('run')</script>")


@pytest.fixture(scope="module")
def comparison(tmp_path_factory):
    folder = virtual_elevator.campaign(tmp_path_factory.mktemp("curves"), {})
    with threads() as executor:
        return compare(load_campaign(folder), executor)


@pytest.fixture(scope="module")
def page(comparison, tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "compare.html"
    ComparisonResult(comparison, ()).save_html(path)
    return path


def data_of(path: Path, name: str = "curves") -> dict:
    """The data of a figure of a page."""
    place = rf'<figure class="curves" id="{name}">.*?<script type="application/json">(.*?)</script>'
    found = re.search(place, path.read_text(encoding="utf-8"), re.DOTALL)
    return json.loads(found[1])


# -- data ----------------------------------------------------------------------------------------------


def test_the_page_holds_the_series_of_the_comparison(comparison, page):
    groups = data_of(page)["groups"]
    assert [group["name"] for group in groups] == [run.file for run in comparison.runs]
    for group, run in zip(groups, comparison.runs, strict=True):
        for panel, one in zip(group["panels"], run.channels, strict=True):
            measured, model = (decode(curve["value"]) for curve in panel["curves"])
            there = np.isfinite(measured)
            assert np.allclose(decode(panel["place"])[there], one.time, atol=1e-5)
            assert np.allclose(measured[there], one.measured / one.channel.scale, rtol=1e-6, atol=1e-7)
            assert np.allclose(model[there], one.predicted / one.channel.scale, rtol=1e-6, atol=1e-7)
            assert (panel["name"], panel["unit"]) == (one.column, one.channel.unit)


def test_all_panels_of_a_run_have_its_time_axis_and_the_phases_of_its_trip(comparison):
    runs = {run.file: run for run in comparison.campaign.runs}
    for group in run_curves("a", {"model": comparison}, "").curve_data["groups"]:
        run = runs[group["name"]]
        assert group["range"][0] <= run.time[0] + 0.1 and group["range"][1] >= run.time[-1] - 0.1
        spans = group["spans"]
        assert [one["name"] for one in spans] == ["rest", "acceleration", "cruise", "deceleration", "after stop"]
        assert all(a["end"] == b["start"] for a, b in pairwise(spans))
        assert [one["name"] for one in spans if one["tinted"]] == ["acceleration", "deceleration"]


def test_the_band_is_two_standard_deviations_wide_and_wider_where_noise_grows_with_motion(comparison):
    column = "cw_low"
    noisy = replace(comparison.campaign)
    noisy.__dict__["noise"] = comparison.campaign.noise | {column: replace(comparison.campaign.noise[column], motion_factor=3.0)}
    group = run_curves("a", {"model": replace(comparison, campaign=noisy)}, "").groups[0]
    rest, moving, after = next(one for one in group.panels if one.name == column).noise
    deviation = comparison.campaign.noise[column].deviation / comparison.campaign.channels[column].scale
    assert (rest[2], moving[2], after[2]) == pytest.approx((2.0 * deviation, 6.0 * deviation, 2.0 * deviation))
    run = comparison.campaign.runs[0]
    assert moving[0] == pytest.approx(run.trip.rest_before, abs=0.1) and moving[1] == pytest.approx(run.trip.rest_after, abs=0.1)


def test_models_that_show_different_samples_share_the_places_of_all(comparison):
    shorter = comparison.predictions | {
        key: np.where(np.arange(len(value)) < 500, np.nan, value) for key, value in comparison.predictions.items()
    }
    section = before_and_after(comparison, compared(comparison.campaign, shorter), "fitted")
    panel = section.blocks[0].groups[0].panels[0]
    whole, late = comparison.runs[0].channels[0], compared(comparison.campaign, shorter).runs[0].channels[0]
    measured, before, after = (one.value for one in panel.curves)
    assert len(panel.place) == len(whole.time) > len(late.time)
    assert np.isfinite(measured).all() and np.isfinite(before).all() and np.isfinite(after).sum() == len(late.time)


def test_thinned_curves_keep_their_extremes_and_gaps():
    random = np.random.default_rng(3)
    value, other = random.standard_normal(50_000), random.standard_normal(50_000)
    value[[1234, 40_001]], other[777] = (50.0, -60.0), 70.0
    place, (value, other) = with_gaps(np.r_[np.arange(25_000), np.arange(25_100, 50_100)].astype(float), [value, other])
    kept = thinned(place, [value, other], 1000)
    assert len(kept) <= 1010 and list(kept) == sorted(set(kept))
    assert {1234, 777, 40_002} <= set(kept.tolist())
    assert np.isnan(value[kept]).sum() == 1 and place[kept][np.isnan(value[kept])] == pytest.approx(25_049.5)
    assert list(thinned(place[:100], [value[:100]], 1000)) == list(range(100))


def test_a_line_is_interrupted_where_samples_are_missing_only():
    place = np.array([0.0, 1.0, 2.0, 3.0, 3.0 + 0.99 * GAP, 20.0, 21.0])
    found, (value,) = with_gaps(place, [np.arange(7.0)])
    assert found == pytest.approx([*place[:5], 0.5 * (place[4] + 20.0), 20.0, 21.0])
    assert list(np.isnan(value)) == [False] * 5 + [True, False, False]


def test_a_page_of_many_long_runs_stays_below_3_mb(tmp_path):
    random = np.random.default_rng(1)
    values = random.standard_normal((3, 30_000))
    panel = Panel(
        "a",
        "mm",
        np.arange(30_000) * 0.01,
        [Curve(n, s, v) for n, s, v in zip("mba", (MEASURED, BEFORE, MODEL), values, strict=True)],
    )
    runs = [Group(str(k), str(k), [replace(panel, name=str(j)) for j in range(10)]) for k in range(15)]
    save_page(tmp_path / "long.html", "long", "", [Section("a", "A", [Curves("curves", runs)])])
    assert 1.5e6 < (tmp_path / "long.html").stat().st_size < 3e6
    assert "extremes of each interval are kept" in (tmp_path / "long.html").read_text()


# -- where it fails ----------------------------------------------------------------------------------------


def test_the_largest_error_is_the_largest_cell_that_noise_does_not_explain(comparison):
    worst = largest_error(comparison)
    cells = [
        (share, run.file, one.column, name)
        for run in comparison.runs
        for one in run.channels
        for name, share in one.by_phase.items()
    ]
    assert (worst.share, worst.file, worst.channel.column, worst.phase) == max(one for one in cells if np.isfinite(one[0]))
    assert worst.rms <= worst.peak and worst.peak_time > 0.0
    text = ComparisonResult(comparison, ()).summary()
    assert text.startswith(f"It fails most at {worst.channel.column} in {worst.file}")
    assert f"RMS error {1e3 * worst.rms:.3g} mm" in text.replace("\n", " ")


def test_an_error_put_into_one_phase_is_found_there(comparison):
    campaign, run = comparison.campaign, comparison.campaign.runs[1]
    measured = {
        (one.file, c): v for one in campaign.runs for c, v in relative_to_rest(one.values, one, campaign.channels).items()
    }
    assert largest_error(compared(campaign, measured)) is None
    off = measured[run.file, "car_low"] + np.where(
        (run.time > run.trip.rest_after) & (run.time < run.trip.rest_after + 1.0), 7e-3, 0.0
    )
    found = largest_error(compared(campaign, measured | {(run.file, "car_low"): off}))
    assert (found.file, found.channel.column, found.phase) == (run.file, "car_low", "after_stop")
    assert found.peak == pytest.approx(7e-3) and 0.0 < found.peak_time - run.trip.rest_after < 1.0


def test_noise_alone_is_no_failure(comparison):
    campaign, random = comparison.campaign, np.random.default_rng(2)
    noise = {column: one.deviation for column, one in campaign.noise.items()}
    measured = {
        (one.file, c): v + noise[c] * random.standard_normal(len(v))
        for one in campaign.runs for c, v in relative_to_rest(one.values, one, campaign.channels).items()
    }  # fmt: skip
    assert ComparisonResult(compared(campaign, measured), ()).summary().startswith("The model fails nowhere beyond")


def test_levels_of_colour_begin_at_their_limits():
    assert [level_of(one) for one in (0.0, 0.049, *LEVELS, 7.0, float("nan"))] == [0, 0, 1, 2, 3, 4, 5, 5, 0]


def test_errors_that_noise_explains_are_not_coloured(comparison):
    run = comparison.runs[0]
    one = run.channels[0]
    loud = replace(one, noise=10.0 * one.rmse)
    found = error_map(replace(comparison, runs=(replace(run, channels=(one, loud)),)), "curves")
    _, seen, explained = ([cell for cell in row if isinstance(cell, HeatCell)] for row in found.heat_rows)
    assert [cell.text for cell in seen] == [cell.text for cell in explained] and len(seen) == 6
    assert seen[0].level == level_of(one.nrmse) > 0 and {cell.level for cell in explained} == {0}


# -- page ----------------------------------------------------------------------------------------------


def test_a_page_asks_for_nothing_from_outside(page):
    text = page.read_text(encoding="utf-8")
    assert (
        not re.search(r'(src|href|action)\s*=\s*["\']?(https?:|//)', text)
        and "@import" not in text
        and not re.search(r"url\((?!#)", text)
    )
    assert "default-src 'none'" in unescape(text) and "<link" not in text and not re.search(r"<script[^>]*src=", text)
    assert "fetch(" not in text and "XMLHttpRequest" not in text
    assert "Copyright (c) 2022 Leon Sorokin" in text


def test_pages_without_curves_do_not_carry_their_program(tmp_path):
    save_page(tmp_path / "plain.html", "plain", "", [Section("a", "A", ["text"])])
    assert (tmp_path / "plain.html").stat().st_size < 20_000


def test_texts_of_files_are_escaped(tmp_path):
    awkward(tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "<b>" not in text and "</script><script>" not in text.replace("</script>\n<script>", "")


def awkward(path: Path) -> None:
    """A page whose names are markup."""
    panels = [
        Panel(name, "mm", TIME, [Curve("measured", MEASURED, np.sin(TIME)), Curve(name, MODEL, np.cos(TIME))]) for name in AWKWARD
    ]
    group = Group(AWKWARD[0], AWKWARD[0], panels, [Span(AWKWARD[3], 0.0, 20.0, True)])
    cells = HeatMap(
        (AWKWARD[0], "n"), [[AWKWARD[3]], [AWKWARD[1], HeatCell("1", 1, AWKWARD[3], Target("curves", 0, 1, AWKWARD[3]))]]
    )
    save_page(path, AWKWARD[0], AWKWARD[3], [Section("a", AWKWARD[0], [cells, Curves("curves", [group], caption=AWKWARD[3])])])


def colours(dark: bool) -> dict[str, np.ndarray]:
    """The colours of the style sheet."""
    style = (Path(pages.__file__).with_name("style.css")).read_text(encoding="utf-8")
    light, dark_part = style.split("@media screen and (prefers-color-scheme: dark)", 1)
    found = dict(re.findall(r"--([\w-]+): (#\w+);", light))
    if dark:
        found |= dict(re.findall(r"--([\w-]+): (#\w+);", dark_part.split("}")[0]))
    long = {name: one[1:] if len(one) == 7 else "".join(2 * digit for digit in one[1:]) for name, one in found.items()}
    return {name: np.array([int(two, 16) for two in re.findall("..", one)]) / 255.0 for name, one in long.items()}


def contrast(one: np.ndarray, other: np.ndarray) -> float:
    """Contrast ratio after WCAG 2."""
    linear = [np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4) for c in (one, other)]
    a, b = (float(each @ [0.2126, 0.7152, 0.0722]) for each in linear)
    return (max(a, b) + 0.05) / (min(a, b) + 0.05)


@pytest.mark.parametrize("dark", [False, True])
def test_texts_and_curves_stand_out_by_more_than_four_and_a_half(dark):
    found = colours(dark)
    drawn = ("ink", "soft", "accent", "good", "bad", "partly", "measured", "before", "model", *(f"series-{k}" for k in range(8)))
    for name in drawn:
        assert contrast(found[name], found["paper"]) > 4.5, name
    for name in ("measured", "model", "soft", "before"):
        assert contrast(found[name], found["tint"]) > 4.5, name
    for share in (0.12, 0.25, 0.42, 0.62, 0.85):
        assert contrast(found["ink"], share * found["heat"] + (1.0 - share) * found["paper"]) > 4.5, share


def test_the_curves_of_the_animation_stand_out_by_more_than_four_and_a_half():
    player = Path(pages.__file__).with_name("player.js").read_text(encoding="utf-8")
    drawn = re.findall(
        r'"(#\w{6})"', "".join(line for line in player.splitlines() if "const COLOURS" in line or "const MEASURED" in line)
    )
    assert len(drawn) == 8
    for one in drawn:
        rgb = np.array([int(two, 16) for two in re.findall("..", one[1:])]) / 255.0
        assert contrast(rgb, np.array([0xF5, 0xF7, 0xF9]) / 255.0) > 4.5, one


# -- in a browser --------------------------------------------------------------------------------------

USE = """
const all = (name) => [...document.querySelectorAll(name)], figure = document.getElementById("curves");
const groups = () => [...figure.querySelectorAll(".group")], shown = () => groups().filter((one) => !one.hidden);
const press = (text) => all("#curves .switches button").find((one) => one.textContent === text).click();
told.opened = performance.now();
told.first = shown().map((one) => one.querySelector("h3").textContent);
const cell = document.querySelector('.heat a[data-group="1"][data-panel="0"][data-span="cruise"]');
cell.click();
const group = groups()[1];
told.visited = !group.hidden;
await new Promise((done) => setTimeout(done, 50));
told.view = [+group.dataset.from, +group.dataset.to];
told.plots = group.querySelectorAll("canvas").length;
group.dispatchEvent(new KeyboardEvent("keydown", { key: "0" }));
told.whole = [+group.dataset.from, +group.dataset.to];
const over = group.querySelector(".u-over"), box = over.getBoundingClientRect();
const mouse = (name, share) => {
  const place = { clientX: box.left + share * box.width, clientY: box.top + 20 };
  const event = new MouseEvent(name, { bubbles: true, button: 0, movementX: 1, ...place });
  (name === "mouseup" ? document : over).dispatchEvent(event);
};
mouse("mouseenter", 0.5); mouse("mousemove", 0.5);
await new Promise((done) => setTimeout(done, 50));
told.readouts = [...group.querySelectorAll(".told")].map((one) => [...one.children].map((part) => part.textContent));
told.lines = [...group.querySelectorAll(".u-cursor-x")].map((one) => one.style.transform);
mouse("mousedown", 0.5); mouse("mousemove", 0.75); mouse("mouseup", 0.75);
await new Promise((done) => setTimeout(done, 50));
told.dragged = [+group.dataset.from, +group.dataset.to];
group.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", shiftKey: true }));
told.panned = [+group.dataset.from, +group.dataset.to];
press("cw_low"); press("residual");
told.panels = [...group.querySelectorAll(".panel")].map((one) => !one.hidden);
told.residuals = [...group.querySelectorAll(".residual")].filter((one) => !one.hidden).length;
const width = () => group.querySelector(".uplot").clientWidth;
const before = width();
dispatchEvent(new Event("beforeprint"));
told.printed = width();
dispatchEvent(new Event("afterprint"));
told.restored = width() === before;
told.wide = document.documentElement.scrollWidth;
told.cut = [...document.querySelectorAll(".scroll:has(.heat)")].filter((one) => one.scrollWidth > one.clientWidth).length;
"""


@needs_browser
@pytest.mark.parametrize("width", [1400, 700])
def test_a_browser_draws_zooms_and_reads_the_curves(comparison, page, width):
    told = played(page, USE, width)
    worst, run, data = largest_error(comparison), comparison.runs[1], data_of(page)["groups"][1]
    assert [one.split(" (")[0] for one in told["first"]] == [worst.file] and told["cut"] == 0
    assert told["visited"] and told["plots"] == 2 * len(run.channels)
    cruise = next(one for one in data["spans"] if one["name"] == "cruise")
    assert (
        told["view"][0] < cruise["start"] < cruise["end"] < told["view"][1]
        and told["view"][1] - told["view"][0] < told["whole"][1]
    )
    assert told["whole"] == pytest.approx(data["range"])
    for told_values, panel in zip(told["readouts"], data["panels"], strict=True):
        when = float(told_values[0].removesuffix(" s"))
        assert when == pytest.approx(np.mean(data["range"]), abs=0.2)
        k = int(np.argmin(np.abs(decode(panel["place"]) - when)))
        values = [decode(one["value"])[k] for one in panel["curves"]]
        for text, value in zip(told_values[1:4], [*values, values[0] - values[1]], strict=True):
            assert float(text.split()[-1].replace("−", "-").replace("–", "nan")) == pytest.approx(
                value, rel=6e-3, abs=1e-5, nan_ok=True
            )
    assert len(set(told["lines"])) == 1  # the cursor is in step
    middle = np.mean(data["range"])
    assert told["dragged"] == pytest.approx([middle, 0.5 * (middle + data["range"][1])], abs=0.3)
    span = told["dragged"][1] - told["dragged"][0]
    assert told["panned"] == pytest.approx([one + 0.2 * span for one in told["dragged"]], abs=1e-6)
    assert told["panels"] == [one.column != "cw_low" for one in run.channels] and told["residuals"] == 0
    assert told["wide"] <= width
    assert told["printed"] <= 182.0 / 25.4 * 96.0 and told["restored"]  # A4 less margins of 14 mm, at 96 pixels in an inch


@needs_browser
def test_a_browser_shows_awkward_names_as_they_are(tmp_path):
    awkward(tmp_path / "page.html")
    told = played(
        tmp_path / "page.html",
        """told.names = [...document.querySelectorAll(".panel b")].map((one) => one.textContent);
        told.bold = document.querySelectorAll("h1 b, h3 b, button b, td b").length;
        document.querySelector(".heat a").click();
        told.view = [+document.querySelector(".group").dataset.from, +document.querySelector(".group").dataset.to];""",
    )
    assert told["names"] == [f"{name} [mm]" for name in AWKWARD] and told["bold"] == 0
    assert told["view"] == pytest.approx([0.0, 23.0])


ODD = "<b>$x_1$ y (mm) & 'z'"


@needs_browser
def test_a_campaign_with_a_column_of_markup_is_compared_and_shown(tmp_path):
    folder = virtual_elevator.campaign(tmp_path / "odd", {})
    described = (folder / "campaign.toml").read_text().replace('column = "car_low"', f'column = "{ODD}"')
    (folder / "campaign.toml").write_text(described)
    for path in folder.glob("*.csv"):
        head, rest = path.read_text().split("\n", 1)
        path.write_text(head.replace("car_low", ODD) + "\n" + rest)
    result = comprope_system.compare(folder)
    result.save_html(tmp_path / "odd.html")
    assert "<b>" not in (tmp_path / "odd.html").read_text("utf-8")
    script = """told.names = [...document.querySelectorAll(".curves .panel b")].map((one) => one.textContent);
    told.cells = [...document.querySelectorAll(".heat td:first-child")].map((one) => one.textContent);"""
    told = played(tmp_path / "odd.html", script)
    assert f"{ODD} [mm]" in told["names"] and ODD in told["cells"]
