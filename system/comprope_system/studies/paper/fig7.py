"""Fig. 7: the acceleration profile of the 22 m trip."""

from math import sqrt
from typing import Any

import numpy as np

from ...parallel.sweep import Case
from ...presets.paper_installations import BUILDING, LIMITS, jerk_limited_trip, limits, trip_up
from ...report.comparison_report import Comparison, ComparisonReport
from ...report.page import Picture
from ...report.plot_style import FIRST, label, panels
from .study import AGREES, DIFFERS, Study, StudyOptions

DISTANCE, DURATION = 22.0, 10.2  # m, s, both stated


def jerk_of(distance: float, duration: float, acceleration: float) -> float:
    """Jerk [m/s3] of a trip without cruise: a (Tp + Tj)(Tp + 2 Tj) = distance with 2 (Tp + 2 Tj) = duration."""
    ramp = 0.5 * duration - 2.0 * distance / (acceleration * duration)
    return acceleration / ramp


def profile(case: Case) -> dict[str, float]:
    """Phases [s], top speed [m/s] and jerk [m/s3] of the trip."""
    trip = jerk_limited_trip(**case["trip"])
    jerk = jerk_of(trip.destination, DURATION, case["trip"]["acceleration"])
    top = trip.at(trip.start_time + 0.5 * trip.duration).velocity
    return {
        "jerk": jerk,
        "duration": trip.duration,
        "ramp": trip.ramp,
        "plateau": trip.plateau,
        "cruise": trip.cruise,
        "top": top,
    }


def _evaluate(_: StudyOptions, values: list[Any]) -> ComparisonReport:
    (v,) = values
    speed, acceleration, jerk = LIMITS[BUILDING]
    reaches = v["duration"] - DURATION
    comparisons = [
        Comparison(
            "time of the 22 m trip",
            "10.2 s",
            f"{v['duration']:.2f} s with a jerk of {jerk:g} m/s³",
            AGREES if abs(reaches) < 0.05 else DIFFERS,
        ),
        Comparison(
            "jerk that makes it 10.2 s",
            "about 0.93 m/s³ (derived)",
            f"{v['jerk']:.3f} m/s³",
            AGREES if abs(v["jerk"] - 0.93) < 0.01 else DIFFERS,
        ),
        Comparison("rated speed", "540 m/min = 9 m/s", f"not reached: {v['top']:.2f} m/s at most", AGREES),
    ]
    text = (
        f"The jerk is not stated. A symmetric jerk-limited trip of 22 m at {acceleration} m/s² in 10.2 s has one: ramps of "
        f"{v['ramp']:.2f} s and plateaus of {v['plateau']:.2f} s, no cruise. With unlimited jerk it would take "
        f"{2 * sqrt(DISTANCE / acceleration):.2f} s; {speed:g} m/s is reached from "
        f"{speed * (speed / acceleration + acceleration / jerk):.0f} m on."
    )
    return ComparisonReport(comparisons, [text, Picture("fig7_acceleration", _draw())])


def _draw() -> Any:
    trip = trip_up(BUILDING, DISTANCE)
    time = np.linspace(0.0, trip.end_time + 1.0, 1200)
    motion = [trip.at(t) for t in time]
    figure, axes = panels(3, height=2.8)
    for one, name, unit in zip(axes, ("acceleration", "velocity", "position"), ("m/s²", "m/s", "m"), strict=True):
        one.plot(time - trip.start_time, [getattr(m, name) for m in motion], color=FIRST)
        label(one, "time [s]", f"{name} [{unit}]")
    return figure


STUDY = Study(
    "fig7",
    "Fig. 7: car acceleration that induces the largest displacement",
    "The time period of the car motion is 10.2 seconds.",
    lambda _: [{"trip": limits(BUILDING, DISTANCE)}],
    profile,
    _evaluate,
)
