"""Fig. 8: displacement versus sheave weight, for trips whose duration is the natural period of the rope."""

from typing import Any

import numpy as np
from scipy.optimize import brentq

from ...parallel.sweep import Case
from ...presets.paper_installations import BUILDING, installation, sheave_changes, trip_up
from ...report.comparison_report import Comparison, ComparisonReport
from ...report.page import Picture, Table
from ...report.plot_style import COLOURS, label, legend, panels, plain_log
from ...vibration.modal.hanging_string import side_string
from ...vibration.prescribed_trip import Floats
from .study import AGREES, DIFFERS, PARTLY, Study, StudyOptions
from .swing import MEASURES, swing, swing_case

MASSES = (35.0, 42.0, 50.0, 60.0, 72.0, 86.0, 102.0, 119.0, 140.0, 165.0, 190.0)  # kg
SHOWN = ("middle_after", "middle_rest", "whole_rest", "outward")
FIXED = 22.0  # m


def tuned_distance(mass: float) -> float:
    """Running distance [m] whose trip lasts as long as the natural period [s] at its end, for a sheave mass [kg]."""
    model = installation(BUILDING, sheave_changes(BUILDING, mass))
    return float(brentq(lambda d: trip_up(BUILDING, d).duration - side_string(model, d).period(), 3.0, 80.0))


def _cases(_: StudyOptions) -> list[Case]:
    tuned = [swing_case(BUILDING, round(tuned_distance(mass), 3), sheave_changes(BUILDING, mass)) for mass in MASSES]
    return tuned + [swing_case(BUILDING, FIXED, sheave_changes(BUILDING, mass)) for mass in MASSES]


def fits(mass: Floats, value: Floats) -> dict[str, tuple[float, float, float]]:
    """Exponential value ~ exp(-k m) and power law value ~ m^-p: k or p, R2 and AIC of straight lines in log value.

    Both have two parameters, so that the smaller AIC, n log(RSS / n) + 4, is the better law.
    """
    y = np.log(value)
    found = {}
    for name, x in (("exponential", mass), ("power", np.log(mass))):
        slope, level = np.polyfit(x, y, 1)
        left = float(np.sum((y - slope * x - level) ** 2))
        found[name] = (
            -float(slope),
            1.0 - left / float(np.sum((y - y.mean()) ** 2)),
            len(y) * float(np.log(left / len(y))) + 4.0,
        )
    return found


def _evaluate(_: StudyOptions, values: list[Any]) -> ComparisonReport:
    mass, tuned, fixed = np.array(MASSES), values[: len(MASSES)], values[len(MASSES) :]
    laws = {key: fits(mass, np.array([row[key] for row in tuned])) for key in SHOWN}
    falls = all(np.all(np.diff([row[key] for row in tuned]) < 0.0) for key in SHOWN)
    better = [key for key in SHOWN if laws[key]["exponential"][2] < laws[key]["power"][2]]
    first = laws["middle_after"]
    comparisons = [
        Comparison(
            "displacement as the sheave gets lighter",
            "increases",
            "increases monotonically, for every measure" if falls else "increases, but not monotonically for every measure",
            AGREES if falls else PARTLY,
        ),
        Comparison(
            "law of growth",
            "exponential",
            (
                f"exponential better for {len(better)} of {len(SHOWN)} measures; middle of the rope: R² "
                f"{first['exponential'][1]:.3f} exponential, {first['power'][1]:.3f} power law"
            ),
            AGREES if len(better) == len(SHOWN) else PARTLY if better else DIFFERS,
        ),
    ]
    text = (
        "200 m building; the inertia of the sheave is proportional to its mass, its radius constant. For each mass the "
        "duration of the trip equals the natural period at its end. An exponential in the mass and a power law are both "
        "fitted as straight lines to the logarithm of the displacement; the smaller AIC is better, and a difference above 2 "
        "is significant. The rope is excited by its bending at the sheave, of the order EI / (2 r T), which explains powers "
        "of the tension."
    )
    return ComparisonReport(
        comparisons,
        [text, Picture("fig8_sheave_weight", _draw(mass, tuned, fixed, laws)), _law_table(laws), _table(tuned, fixed)],
    )


def _law_table(laws: dict[str, dict[str, tuple[float, float, float]]]) -> Table:
    rows = []
    for key, one in laws.items():
        (k, r_e, aic_e), (p, r_p, aic_p) = one["exponential"], one["power"]
        rows.append(
            (
                MEASURES[key],
                f"exp(−m / {1.0 / k:.0f} kg)",
                f"{r_e:.4f}",
                f"{aic_e:.1f}",
                f"m^−{p:.2f}",
                f"{r_p:.4f}",
                f"{aic_p:.1f}",
            )
        )
    return Table(
        ("measure", "exponential", "R²", "AIC", "power law", "R²", "AIC"),
        rows,
        "Fits for trips of one natural period; R² and AIC of log displacement",
    )


def _table(tuned: list[Any], fixed: list[Any]) -> Table:
    rows = [
        (
            f"{m:g}",
            f"{tuned_distance(m):.1f}",
            f"{a['duration']:.2f}",
            *(f"{1e3 * a[key]:.2f}" for key in SHOWN),
            f"{1e3 * b['middle_after']:.2f}",
        )
        for m, a, b in zip(MASSES, tuned, fixed, strict=True)
    ]
    head = ("mass [kg]", "distance [m]", "trip [s]", *(MEASURES[key] for key in SHOWN), "middle, half swing after 22 m")
    return Table(head, rows, "Displacements in mm")


def _draw(mass: Floats, tuned: list[Any], fixed: list[Any], laws: Any) -> Any:
    figure, (left, right) = panels(2, height=4.0)
    for k, key in enumerate(SHOWN):
        values = np.array([row[key] for row in tuned])
        left.semilogy(mass, 1e3 * values, "o", color=COLOURS[k], markersize=4, label=MEASURES[key])
        for name, x, style in (("exponential", mass, "-"), ("power", np.log(mass), ":")):
            level = np.mean(np.log(values) + laws[key][name][0] * x)
            left.semilogy(mass, 1e3 * np.exp(level - laws[key][name][0] * x), style, color=COLOURS[k], linewidth=1.0)
    for rows, name, style in ((tuned, "trip tuned to the period", "o-"), (fixed, "22 m for every sheave", "s--")):
        values = np.array([row["middle_after"] for row in rows])
        right.plot(mass, values / values.max(), style, color=COLOURS[style == "s--"], markersize=4, label=name)
    label(left, "sheave mass [kg]", "displacement [mm]", "lines: exponential; dots: power law")
    label(right, "sheave mass [kg]", "displacement / maximum", "middle of the rope after the trip")
    left.set_ylim(top=left.get_ylim()[1] * 6.0)
    plain_log(left.yaxis)
    legend(left, loc="upper right", handlelength=1.0)
    legend(right)
    return figure


STUDY = Study(
    "fig8",
    "Fig. 8: effect of the compensation sheave weight",
    (
        "The car runs with the acceleration pattern whose period corresponds to the natural period of the rope. … The "
        "displacement also grows exponentially as the weight becomes lighter."
    ),
    _cases,
    swing,
    _evaluate,
)
