"""The page that plays a trip: what it holds is what was simulated, and a browser shows it."""

import json
import re

import numpy as np
import pandas as pd
import pytest

import comprope_system
from comprope.rope.model_file import load
from comprope.rope.simulator.rope import CompensationRope
from comprope.rope.simulator.side_shape import side_shape
from comprope_system import cli
from comprope_system.presets import model_path
from comprope_system.presets.paper_installations import jerk_limited_trip
from comprope_system.report.page import Animation, Section, save_page
from comprope_system.simulation.trips.animation.encoding import Trace, animation_data, decode_array, encode_array
from comprope_system.simulation.trips.rope_shapes import (
    ARC,
    DEPTHS,
    MAX_FRAMES,
    POINTS,
    Frame,
    FrameRecorder,
    frame_of,
    rest_displacements,
)  # fmt: skip
from comprope_system.vibration.prescribed_trip import record_trip

from .browser import needs_browser, played
from .virtual_elevator import MODEL, campaign

# A coarse rope in a low shaft: seconds matter here, not millimetres.
QUICK = [
    *("--set", "rope.element_length=0.2", "--set", "solver.step=0.005", "--set", "shaft.height=12"),
    *("--from", "1", "--to", "4", "--step", "0.02", "--time", "5"),
]


@pytest.fixture(scope="module")
def trip(tmp_path_factory):
    """The page, its film, and the table of a short trip."""
    folder = tmp_path_factory.mktemp("trip")
    with pytest.raises(SystemExit) as done:
        cli.main(["simulate", "tower50", *QUICK, "--report", str(folder / "trip.html"), "--out", str(folder / "trip.csv")])
    assert done.value.code == 0
    page = (folder / "trip.html").read_text(encoding="utf-8")
    inside = re.search(r'<script type="application/json" class="film">(.*?)</script>', page, re.DOTALL)
    return folder / "trip.html", json.loads(inside[1]), pd.read_csv(folder / "trip.csv")


def test_the_film_shows_what_the_sensors_saw(trip):
    _, shown, table = trip
    ends, sides, axle = (decode_array(shown[name]) for name in ("ends", "sides", "axle"))
    at = table.iloc[[round(k * shown["interval"] / 0.02) for k in range(shown["frames"])]]
    assert np.allclose(ends[:, 0], at["car_position"], atol=1e-3)  # 12 m in 32767 parts, twice
    assert np.allclose(axle, at["sheave_displacement"], atol=1e-6)
    for k, sensor in enumerate(shown["sensors"]):
        side = ("car", "counterweight").index(sensor["side"])
        heights = ends[:, side, None] + decode_array(shown["down"]) * (axle[:, None] - shown["pit"] - ends[:, side, None])
        seen = [np.interp(-sensor["height"], -h, y, left=np.nan) for h, y in zip(heights, sides[:, side], strict=True)]
        assert np.array_equal(np.isnan(seen), at[sensor["name"]].isna())
        # Straight between points where the sensor is a cubic: 0.2 m at a curvature of up to 0.2/m is 1 mm.
        assert np.nanmax(np.abs(seen - at[sensor["name"]].to_numpy()), initial=0.0) < 1e-3
        assert np.allclose(decode_array(shown["traces"][k]["value"]), 1e3 * table[sensor["name"]], atol=2e-3, equal_nan=True)


def test_a_trip_at_rest_departs_from_rest_by_nothing(trip):
    _, shown, table = trip
    swing = decode_array(shown["sides"]) - decode_array(shown["rest"])
    still = round(table["time"][table["car_velocity"] > 1e-6].iloc[0] / shown["interval"])
    assert np.nanmax(np.abs(swing[: still - 1])) < 1e-5
    assert 2e-4 < np.nanmax(np.abs(swing)) < 0.05  # and once it moves it swings, by millimetres


def test_key_figures_are_swings_about_the_shape_at_rest():
    motion = comprope_system.CarMotion(start=0.0, end=3.0)
    changes = {"rope.element_length": 0.2, "solver.step": 0.005, "shaft.height": 12.0}
    result = comprope_system.simulate("tower50", motion, changes=changes, step=0.02, duration=6.0, fmu=False)
    table = result.table
    rest = rest_displacements(result.model, table["car_position"].to_numpy(), table["counterweight_position"].to_numpy())
    figures = dict(result.key_figures)
    for name, still in zip(result.sensors, rest, strict=True):
        swing = table[name] - still
        if swing.notna().any():
            assert abs(swing.iloc[0]) < 1e-5 or np.isnan(swing.iloc[0])
            assert float(figures[f"peak at {name}"].split()[0]) == pytest.approx(1e3 * swing[swing.abs().idxmax()], abs=0.006)


@needs_browser
def test_what_was_measured_stands_beside_rope_and_sheave(tmp_path):
    folder = campaign(tmp_path, {"effects.bearing_friction.coulomb_torque": 15.0})
    with pytest.raises(SystemExit) as done:
        cli.main(
            ["simulate", str(folder / "elevator.toml"), "--car", str(folder / "up.csv"), "--report", str(tmp_path / "trip.html")]
        )
    assert done.value.code == 0
    text = (tmp_path / "trip.html").read_text(encoding="utf-8")
    shown = json.loads(re.search(r'<script type="application/json" class="film">(.*?)</script>', text, re.DOTALL)[1])
    assert [one["name"] for one in shown["traces"] if "measured" in one] == ["cw_low", "car_low", "height of the sheave"]
    height = next(one for one in shown["traces"] if one["name"] == "height of the sheave")
    model, measured = (decode_array(one["value"]) for one in (height, height["measured"]))
    assert measured[:20].mean() == pytest.approx(model[0], abs=0.02)  # mm, relative to rest
    told = played(tmp_path / "trip.html", CIRCLES)
    assert len(told["places"]) == 2 and all(dot != circle for dot, circle in told["places"])


CIRCLES = """
const time = document.querySelector(".time");
time.value = 0.3 * time.max;
time.dispatchEvent(new Event("input"));
const at = [...document.querySelectorAll(".shaft > circle")].filter((one) => one.style.display !== "none").map((one) => +one.getAttribute("cx"));
told.places = Array.from({ length: at.length / 2 }, (_, k) => at.slice(2 * k, 2 * k + 2));
"""


def test_the_report_leaves_the_numbers_as_they_are(trip, tmp_path):
    with pytest.raises(SystemExit):
        cli.main(["simulate", "tower50", *QUICK, "--direct", "--out", str(tmp_path / "plain.csv")])
    assert pd.read_csv(tmp_path / "plain.csv").equals(trip[2])


def test_the_rope_round_the_sheave_keeps_off_its_groove():
    model, trip = MODEL, jerk_limited_trip(6.0, 2.0, 1.0, 1.0, 1.0)
    recorder = []
    record_trip(model, trip, 3.0, lambda rope: recorder.append(frame_of(rope)) or np.zeros(1))
    for one in recorder:
        away = np.hypot(one.arc[0], one.arc[1] - one.axle)
        # Chords between nodes cut l^2 / (8 R) of the circle; the rope sinks in by less than 0.1 mm.
        assert away.min() > model.sheave.radius - model.rope.element_length**2 / (8.0 * model.sheave.radius) - 1e-4
        assert abs(one.arc[0][np.argmin(one.arc[1])]) < 0.05  # and is lowest below the axle
    # The sheave is turned by the rope that passes it: as far as the car went, over the radius, less a little slip.
    assert recorder[-1].angle == pytest.approx((recorder[-1].ends[0] - 1.0) / model.sheave.radius, rel=0.01)


def test_packing_loses_less_than_a_line_is_wide():
    values = np.array([[0.0, -3.0, 2.99999], [np.nan, 1e-9, np.inf]])
    found = decode_array(encode_array(values))
    assert np.array_equal(np.isnan(found), ~np.isfinite(values))
    assert np.nanmax(np.abs(found[np.isfinite(values)] - values[np.isfinite(values)])) <= 0.5 * 3.0 / 32767
    assert np.array_equal(decode_array(encode_array([0.0, 0.0])), [0.0, 0.0])


@pytest.mark.parametrize(
    ("step", "total", "interval"), [(0.01, 500, 0.05), (0.05, 100, 0.05), (0.1, 50, 0.1), (0.001, 600_000, 0.5)]
)
def test_a_camera_takes_20_frames_a_second_and_never_too_many(monkeypatch, step, total, interval):
    monkeypatch.setattr("comprope_system.simulation.trips.rope_shapes.frame_of", lambda rope: rope)
    recorder = FrameRecorder(lambda: "frame", step)
    for count in range(total + 1):
        recorder(count, total)
    assert recorder.interval == pytest.approx(interval)
    assert len(recorder.frames) == total // round(interval / step) + 1 <= MAX_FRAMES + 1


def test_the_longest_page_stays_below_2_mb(tmp_path, monkeypatch):
    """As many frames as there can be, of noise, with the traces of eight sensors."""
    random = np.random.default_rng(1)
    frames = [
        Frame(random.random(2), random.random((2, POINTS)), random.random((2, ARC)), 0.0, 0.0) for _ in range(MAX_FRAMES + 1)
    ]
    monkeypatch.setattr(
        "comprope_system.simulation.trips.animation.encoding.rest_shapes", lambda model, frames: [one.sides for one in frames]
    )
    traces = [Trace(str(k), "mm", random.random(2400), random.random(2400)) for k in range(12)]
    moving = Animation("trip", animation_data(MODEL, frames, 0.05, traces))
    save_page(tmp_path / "long.html", "long", "", [Section("a", "A", [moving])])
    assert (tmp_path / "long.html").stat().st_size < 1.75e6  # 0.25 MB are left for the picture


def test_a_page_needs_no_network(trip):
    page = trip[0].read_text(encoding="utf-8")
    assert set(re.findall(r"https?://[^\s\"']+", page)) == {"http://www.w3.org/2000/svg"}  # a name, not an address
    assert "<link" not in page and "@import" not in page
    assert set(re.findall(r'src="(.{10})', page)) == {"data:image"}
    assert not re.search(r"<script[^>]*src=", page)


def test_a_side_is_drawn_from_its_end_to_the_axle_and_finely_where_it_bends():
    """Straight lines between the points differ from the rope by less than the width of a line, also where it bends onto the sheave."""
    rope = CompensationRope(load(model_path("tower50")))
    rope.solve_equilibrium(20.0, 30.0)
    axle = -rope.state.q[rope.n]
    for points, side, end in zip(frame_of(rope).sides, ("car", "counterweight"), (20.0, 30.0), strict=True):
        heights = end + DEPTHS * (axle - end)
        assert (heights[0], heights[-1]) == pytest.approx((end, axle))
        between = np.linspace(axle + 1e-3, end - 1e-3, 4000)
        drawn = np.interp(between, heights[::-1], points[::-1])
        # 0.5 mm with points closer together near the sheave; 4 to 7 mm if they were evenly spread.
        assert drawn == pytest.approx(side_shape(rope, side, between), abs=1e-3)


# -- in a browser --------------------------------------------------------------------------------------

PLAY = """
const find = (name) => document.querySelector(name);
const rope = () => find(".shaft .rope").getAttribute("d");
const set = (name, value, event) => { find(name).value = value; find(name).dispatchEvent(new Event(event)); };
told.first = rope();
told.marks = [...document.querySelectorAll(".shaft circle")].map((one) => one.getAttribute("cx"));
set(".time", 3.0, "input");
told.clock = find(".clock").textContent;
told.later = rope();
told.car = find(".now dd").textContent;
set(".view", "shape", "change");
told.shape = rope();
set(".magnify", 1, "input");
told.factor = find(".factor").textContent;
told.traces = document.querySelectorAll(".trace").length;
const texts = (one, anchor) => [...one.querySelectorAll(`.tick[text-anchor=${anchor}]`)].map((tick) => tick.textContent);
told.ticks = [...document.querySelectorAll(".trace")].map((one) => [texts(one, "middle"), texts(one, "end")]);
const box = find(".trace").getBoundingClientRect(), middle = box.left + (box.width * (52 + 512)) / 2 / 520;
find(".trace").setPointerCapture = () => {};
find(".trace").dispatchEvent(new PointerEvent("pointerdown", { clientX: middle, clientY: box.top, pointerId: 1 }));
told.picked = find(".clock").textContent;
set(".time", 0, "input");
find(".play").click();
for (let drawn = 0; drawn < 20; drawn++) await new Promise((done) => requestAnimationFrame(done));
find(".play").click();
told.played = +find(".time").value;
"""


@needs_browser
def test_a_browser_plays_the_page(trip):
    told = played(trip[0], PLAY)
    assert "NaN" not in "".join(told["first"] + told["later"] + told["shape"])
    assert len({told["first"], told["later"], told["shape"]}) == 3
    assert told["clock"].startswith("3.00 s of 5.0 s")
    table = trip[2]
    assert told["car"] == f"{table['car_position'][150]:.2f} m"
    assert told["traces"] == len(trip[1]["traces"]) == 8
    assert told["picked"].startswith("2.5")  # the middle of the trace
    assert told["factor"].startswith("×")
    assert 0.1 < told["played"] < 3.0  # 20 pictures, of 1/60 s each where the browser keeps pace
    for (times, ticks), one in zip(told["ticks"], trip[1]["traces"], strict=True):
        assert times == ["0 s", "0.5", "1", "1.5", "2", "2.5", "3", "3.5", "4", "4.5", "5"]
        values = decode_array(one["value"])
        assert bool(ticks) == np.isfinite(values).any()
        low, high = np.nanmin(values, initial=np.inf), np.nanmax(values, initial=-np.inf)
        assert all(low - 1e-3 <= float(text.replace("−", "-")) <= high + 1e-3 for text in ticks)


ROUND = """
const find = (name) => document.querySelector(name);
const set = (name, value, event) => { find(name).value = value; find(name).dispatchEvent(new Event(event)); };
const [low, high] = [+find(".magnify").min, +find(".magnify").max];
told.least = Infinity;
told.crossed = 0;
for (const view of ["swing", "shape"]) {
  set(".view", view, "change");
  for (let stretch = low; stretch <= high; stretch += 1) {
    set(".magnify", stretch, "input");
    for (let time = 0; time <= 5; time += 0.25) {
      set(".time", time, "input");
      const [x, y] = find(".shaft .wheel").getAttribute("transform").match(/[\\d.]+/g).map(Number);
      document.querySelectorAll(".shaft .rope").forEach((rope, side) => {
        const length = rope.getTotalLength();
        for (let along = 0; along <= length; along += 1) {
          const point = rope.getPointAtLength(along);
          told.least = Math.min(told.least, Math.hypot(point.x - x, point.y - y));
          if (point.y < y && (side ? 1 : -1) * (point.x - x) < 0) told.crossed++;
        }
      });
    }
  }
}
told.radius = +find(".shaft .wheel circle").getAttribute("r");
"""


@needs_browser
def test_the_rope_is_never_drawn_through_the_sheave(trip):
    told = played(trip[0], ROUND)
    assert told["radius"] - 1.0 < told["least"] < told["radius"] + 1.0 and told["crossed"] == 0


def test_the_title_says_what_the_page_is(trip):
    assert "<title>Trip of a compensation rope, simulated: tower50</title>" in trip[0].read_text("utf-8")
