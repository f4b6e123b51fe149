"""Section 6: the smallest sheave mass that keeps the displacement below a limit."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from comprope.errors import InputError
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import as_table, with_changes

from ...parallel.sweep import Case
from ...presets.paper_installations import model_of_case, sheave_changes
from ...report.comparison_report import Comparison, ComparisonReport
from ...report.page import Picture, Table
from ...report.plot_style import COLOURS, GREY, label, panels, plain_log
from .study import AGREES, Study, StudyOptions
from .swing import MEASURES, swing, swing_case

MEASURE = "whole_rest"
LIGHTEST, HEAVIEST = 0.25, 8.0  # of the building's own sheave
TOLERANCE = 0.005  # of the mass


@dataclass(frozen=True)
class LeastMass:
    """The least mass [kg] that keeps the limit, whether the search ended there, and its runs: mass [kg], displacement [m]."""

    mass: float
    at_bound: bool
    runs: tuple[tuple[float, float], ...]


def least_mass(model: RopeModel, trip: Mapping[str, float], limit: float, measure: str = MEASURE) -> LeastMass:
    """Bisect the sheave mass of a building until the displacement on a trip up meets a limit [m].

    `trip` has distance [m], speed, acceleration and jerk. It is simulated with the full model for every mass; the
    inertia is proportional to the mass. Displacement is `measure`, one of `swing.MEASURES`, assumed to decrease with increasing
    mass. Raises `InputError` if even the largest mass does not meet the limit.
    """
    runs: dict[float, float] = {}

    def displacement(mass: float) -> float:
        case = {"model": as_table(with_changes(model, sheave_changes(model, mass))), "trip": dict(trip)}
        runs[mass] = float(swing(case)[measure])
        return runs[mass]

    low, high = LIGHTEST * model.sheave.mass, HEAVIEST * model.sheave.mass
    if displacement(high) > limit:
        raise InputError(
            f"--limit {1e3 * limit:g}: {1e3 * runs[high]:.2f} mm or more is accepted; that is the displacement even with a "
            f"sheave of {high:.0f} kg"
        )
    if displacement(low) <= limit:
        return LeastMass(low, True, tuple(sorted(runs.items())))
    while high - low > TOLERANCE * high:
        middle = (low * high) ** 0.5
        low, high = (low, middle) if displacement(middle) <= limit else (middle, high)
    return LeastMass(high, False, tuple(sorted(runs.items())))


def least_mass_case(case: Case) -> dict[str, Any]:
    """`least_mass` as a case of a sweep."""
    found = least_mass(model_of_case(case), case["trip"], case["limit"])
    return {"mass": found.mass, "at_bound": found.at_bound, "runs": [list(run) for run in found.runs]}


def _evaluate(options: StudyOptions, values: list[Any]) -> ComparisonReport:
    (v,) = values
    least = ("at most " if v["at_bound"] else "") + f"{v['mass']:.1f} kg"
    trip = f"{options.installation}, {options.distance:g} m up from the bottom landing"
    comparisons = [
        Comparison(
            "use of the model",
            "estimate sufficient weight conditions of the sheave",
            f"{least} per rope keep the displacement below {1e3 * options.limit:g} mm ({trip})",
            AGREES,
        )
    ]
    text = (
        f"Displacement: {MEASURES[MEASURE]}. The mass is found by bisection to {100 * TOLERANCE:g} % with simulations of the "
        "full model. Other buildings, trips and limits: options --building, --distance and --limit."
    )
    rows = [(f"{mass:.1f}", f"{1e3 * value:.2f}", "pass" if value <= options.limit else "fail") for mass, value in v["runs"]]
    table = Table(("mass [kg]", "displacement [mm]", f"under {1e3 * options.limit:g} mm"), rows, "Runs of the bisection")
    return ComparisonReport(comparisons, [text, Picture("design_least_weight", _draw(options, v)), table])


def _draw(options: StudyOptions, v: dict[str, Any]) -> Any:
    figure, (axes,) = panels(height=2.8)
    mass, value = zip(*v["runs"], strict=True)
    axes.loglog(mass, [1e3 * one for one in value], "o-", color=COLOURS[0], markersize=4)
    axes.axhline(1e3 * options.limit, color=COLOURS[1], linewidth=1.0)
    axes.axvline(v["mass"], color=GREY, linewidth=0.9)
    plain_log(axes.xaxis, axes.yaxis)
    label(axes, "sheave mass [kg]", "displacement [mm]")
    return figure


STUDY = Study(
    "design",
    "Section 6: smallest sufficient weight",
    "The proposed model can be applied to estimate sufficient weight conditions of the compensation sheave.",
    lambda options: [{**swing_case(options.installation, options.distance), "limit": options.limit}],
    least_mass_case,
    _evaluate,
)
