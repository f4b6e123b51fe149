"""Fig. 5: lateral displacement during the trip up the 50 m tower, and its increasing frequency."""

from typing import Any

import numpy as np
from scipy.signal import find_peaks
from scipy.stats import spearmanr

from comprope.rope.simulator.rope import CompensationRope
from comprope.rope.simulator.side_shape import side_shape

from ...parallel.sweep import Case
from ...presets.paper_installations import TOWER, jerk_limited_trip, model_of_case, trip_up
from ...report.comparison_report import Comparison, ComparisonReport
from ...report.page import Picture, Table
from ...report.plot_style import COLOURS, label, legend, panels, plain_log
from ...vibration.modal.hanging_string import HangingString, side_string
from ...vibration.prescribed_trip import Floats, record_trip
from .study import AGREES, DIFFERS, Study, StudyOptions
from .swing import swing_case

DISTANCE = 50.0  # m
AFTER = 4.0  # s
SENSOR = 0.5  # m, height of the low sensor
POINTS = 48  # along the side
PROMINENCE = 1.5e-4  # m: smaller extremes are not counted as swings


def up_trip(case: Case) -> dict[str, list[float]]:
    """The trip over time: car [m], displacement [m] at the low sensor, first mode's part [m], its frequency by theory [Hz]."""
    model, trip = model_of_case(case), jerk_limited_trip(**case["trip"])

    def evaluate(rope: CompensationRope) -> Floats:
        string = side_string(model, -rope.state.q[0])
        sensor = side_shape(rope, "counterweight", np.array([SENSOR]))
        return np.array([-rope.state.q[0], sensor[0], first_mode(rope, string), 1.0 / string.wkb_period()])

    time, samples = record_trip(model, trip, trip.end_time + AFTER, evaluate)
    samples = np.where(np.isfinite(samples), samples, 0.0)
    return {"time": time.tolist()} | dict(zip(("car", "sensor", "mode", "theory"), samples.T.tolist(), strict=True))


def first_mode(rope: CompensationRope, string: HangingString) -> float:
    """Amplitude [m] of the first mode in the displacement of a side: its component sin(pi t) over wave travel time t, 0 to 1."""
    share = (np.arange(POINTS) + 0.5) / POINTS
    values = side_shape(rope, "counterweight", -rope.state.q[rope.n] + string.height_at(share))
    return float(2.0 * np.mean(values * np.sin(np.pi * share)))


def frequencies(time: Floats, signal: Floats) -> tuple[Floats, Floats]:
    """Instants [s] and frequencies [Hz] of an oscillation: from each extreme to the next but one is a period.

    Full periods are used, since a drift of the mean makes half periods unequal.
    """
    extremes = np.sort(np.concatenate([find_peaks(side * signal, prominence=PROMINENCE)[0] for side in (1, -1)]))
    at = np.array([_vertex(time, signal, k) for k in extremes])
    return at[1:-1], 1.0 / (at[2:] - at[:-2])


def _vertex(time: Floats, signal: Floats, k: int) -> float:
    """The instant of an extreme, by the parabola through three samples."""
    a, b, c = signal[k - 1 : k + 2]
    return float(time[k] + 0.5 * (a - c) / (a - 2.0 * b + c) * (time[1] - time[0]))


def _evaluate(_: StudyOptions, values: list[Any]) -> ComparisonReport:
    v = {key: np.array(one) for key, one in values[0].items()}
    trip = trip_up(TOWER, DISTANCE)
    moving = v["time"] <= trip.end_time
    at, found = frequencies(v["time"][moving], v["mode"][moving])
    theory = np.interp(at, v["time"], v["theory"])
    error = found / theory - 1.0
    rising = float(spearmanr(at, found).statistic)
    cruising = (at > trip.start_time + 5.0) & (at < trip.end_time - 5.0)
    within = float(np.sqrt(np.mean(error[cruising] ** 2)))
    comparisons = [
        Comparison(
            "frequency during the trip",
            "increases",
            f"from {found[0]:.2f} to {found[-1]:.2f} Hz, rank correlation with time {rising:.3f}",
            AGREES if rising > 0.9 else DIFFERS,
        ),
        Comparison(
            "cause",
            "the side shortens, so its natural frequency rises",
            f"follows √(T/ρ)/2L (integrated over the side) within {100 * within:.1f} % rms at constant speed",
            AGREES if within < 0.05 else DIFFERS,
        ),
    ]
    swing = 1e3 * 0.5 * np.ptp(v["mode"][moving & (v["time"] > 5.0)])
    text = (
        "Trip of 50 m up at 150 m/min and 0.80 m/s² (jerk 0.8 m/s³, not stated), nominal sheave. The component of the first "
        f"mode, {swing:.1f} mm, is extracted from the shape of the side; each period, from an extreme to the next but one, "
        "gives a frequency. The WKB theory neglects the axial motion of the rope (a tenth of the wave speed here) and "
        "evaluates the length at the middle of each period. While the counterweight descends, a sensor at a fixed height also "
        "measures the approach of the rope to the vertical through its end."
    )
    table = Table(
        ("time [s]", "frequency [Hz]", "theory [Hz]", "difference [%]"),
        [
            (f"{t:.2f}", f"{f:.3f}", f"{g:.3f}", f"{100 * e:+.1f}")
            for t, f, g, e in list(zip(at, found, theory, error, strict=True))[::4]
        ],
        "Every fourth half period",
    )
    return ComparisonReport(comparisons, [text, Picture("fig5_up_trip", _draw(v, at, found)), table])


def _draw(v: dict[str, Floats], at: Floats, found: Floats) -> Any:
    figure, (sensor, mode, frequency, car) = panels(2, 2, height=2.7)
    samples = v["sensor"] != 0.0
    sensor.plot(v["time"][samples], 1e3 * (v["sensor"][samples] - v["sensor"][0]), color=COLOURS[0])
    label(sensor, "", "from rest [mm]", f"counterweight's side at {SENSOR} m")
    mode.plot(v["time"], 1e3 * (v["mode"] - v["mode"][0]), color=COLOURS[0])
    label(mode, "", "from rest [mm]", "first mode of the side")
    frequency.semilogy(at, found, "o", color=COLOURS[1], markersize=3.5, label="each period")
    frequency.semilogy(v["time"], v["theory"], color=COLOURS[0], label="√(T/ρ)/2L along the side")
    label(frequency, "time [s]", "frequency [Hz]", "frequency of this mode")
    plain_log(frequency.yaxis)
    legend(frequency)
    car.plot(v["time"], v["car"], color=COLOURS[0])
    label(car, "time [s]", "height of the car [m]")
    return figure


STUDY = Study(
    "fig5",
    "Fig. 5: lateral displacement during upward motion",
    (
        "The frequency of the displacement increases as shown in Fig. 5. The length of the counterweight side compensation "
        "rope becomes shorter during the car upward motion."
    ),
    lambda _: [swing_case(TOWER, DISTANCE)],
    up_trip,
    _evaluate,
)
