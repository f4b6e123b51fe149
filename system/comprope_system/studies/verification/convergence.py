"""Convergence in mesh and time step, with fitted orders."""

from collections.abc import Callable
from typing import Any

import numpy as np

from comprope.rope.mechanics.end_conditions import PATH, PATHS
from comprope.rope.simulator.rope import CompensationRope

from ...presets.paper_installations import TOWER, installation, trip_up
from ...report.comparison_report import ComparisonReport
from ...report.page import Block, Picture, Table
from ...report.plot_style import COLOURS, label, legend, panels, plain_log
from ...vibration.prescribed_trip import Floats, record_trip
from .check import Check, pass_or_fail
from .reference import rms

Run = Callable[[dict[str, float]], Floats]

ELEMENTS = (0.2, 0.1, 0.05, 0.025)  # m
FINEST_ELEMENT = 0.0125
STEPS = (0.016, 0.008, 0.004, 0.002)  # s
FINEST_STEP = 0.00025
DAMPINGS = (0.0, 0.15)
HEIGHTS = (0.5, 5.0, 25.0)  # m
UNTIL = 8.0  # s of the trip up the tower: speeding up, and four seconds at full speed
CARS = tuple(20.0 + 0.037 * k for k in range(8))  # m; nodes lie differently on the sheave for each
AMPLITUDE, RISE, SWING, COARSE = (
    0.05,
    1.5,
    6.0,
    0.032,
)  # m, s, s: the sideways motion of an end, the time watched, between samples


def seen(rope: CompensationRope) -> Floats:
    """Displacements [m] on the counterweight side at HEIGHTS."""
    return np.array([rope.lateral_displacement("counterweight", height)[0] for height in HEIGHTS])


def on_trip(changes: dict[str, float]) -> Floats:
    """Displacements [m] over the first seconds of a trip up (times, heights)."""
    return record_trip(installation(TOWER, changes), trip_up(TOWER, 50.0), UNTIL, seen)[1]


def at_rest(changes: dict[str, float]) -> Floats:
    """Displacements [m] at rest for CARS (cars, heights)."""
    model = installation(TOWER, changes)
    rope, found = CompensationRope(model), []
    for car in CARS:
        rope.solve_equilibrium(car, model.shaft.height - car)
        found.append(seen(rope))
    return np.array(found)


def moved_sideways(changes: dict[str, float]) -> Floats:
    """Displacements [m] during a lateral motion of the counterweight end (times, heights): no rope runs over the sheave."""
    model, car = installation(TOWER, changes), 10.0
    rope, found = CompensationRope(model), []
    rope.solve_equilibrium(car, model.shaft.height - car)
    path = np.zeros((PATHS, PATH))
    path[:, 0] = path[:, 3] = -car, -model.sheave.radius, car - model.shaft.height, model.sheave.radius
    for k in range(round(SWING / COARSE)):
        path[3] = [*_sideways(k * COARSE), *_sideways((k + 1) * COARSE)]
        path[3, [0, 3]] += model.sheave.radius
        rope.step(COARSE, path.ravel())
        found.append(seen(rope))
    return np.array(found)


def _sideways(time: float) -> tuple[float, float, float]:
    """A quintic rise from rest to rest: position [m], velocity, acceleration."""
    s = min(time / RISE, 1.0)
    x, v, a = s**3 * (10.0 - 15.0 * s + 6.0 * s**2), 30.0 * s**2 * (1.0 - s) ** 2, 60.0 * s * (1.0 - 3.0 * s + 2.0 * s**2)
    return AMPLITUDE * x, AMPLITUDE * v / RISE, AMPLITUDE * a / RISE**2


def order(sizes: tuple[float, ...], errors: Floats) -> float:
    """Order of convergence: slope of log error versus log size."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def in_mesh() -> dict[str, Floats]:
    """Differences [m], rms, from the finest mesh over ELEMENTS."""
    return {
        name: _errors(run, "rope.element_length", ELEMENTS, FINEST_ELEMENT)
        for name, run in (("at rest", at_rest), ("on a trip", on_trip))
    }


def in_step() -> dict[str, Floats]:
    """Differences [m], rms, from the finest step over STEPS, for each numerical damping."""
    found = {}
    for name, run in (("end led sideways", moved_sideways), ("on a trip", on_trip)):
        for damping in DAMPINGS:
            changes = {"solver.numerical_damping": damping}
            found[f"{name}, damping {damping:g}"] = _errors(run, "solver.step", STEPS, FINEST_STEP, changes)
    return found


def _errors(run: Run, key: str, sizes: tuple[float, ...], finest: float, changes: dict[str, float] | None = None) -> Floats:
    best = run({**(changes or {}), key: finest})
    return np.array([rms(run({**(changes or {}), key: size}) - best) for size in sizes])


def _run() -> ComparisonReport:
    mesh, step = in_mesh(), in_step()
    comparisons = [
        pass_or_fail(f"order in element length, {name}", "1.8 or more", f"{order(ELEMENTS, one):.2f}", order(ELEMENTS, one) > 1.8)
        for name, one in mesh.items()
    ]
    for name, one in step.items():
        least, most = (1.8, 2.2) if "sideways" in name else (1.4, 2.2)
        comparisons.append(
            pass_or_fail(
                f"order in time step, {name}",
                f"{least:g} to {most:g}",
                f"{order(STEPS, one):.2f}",
                least < order(STEPS, one) < most,
            )
        )
    for name, error in (("mesh, 5 cm", mesh["on a trip"][2]), ("step, 4 ms", step["on a trip, damping 0.15"][2])):
        comparisons.append(pass_or_fail(f"default {name}, on a trip", "under 0.1 mm rms", f"{1e3 * error:.4f} mm", error < 1e-4))
    text = (
        f"50 m tower; lateral displacement at {', '.join(f'{h:g}' for h in HEIGHTS)} m on the counterweight's side, rms of the "
        f"difference from {1e3 * FINEST_ELEMENT:g} mm elements or steps of {1e3 * FINEST_STEP:g} ms. On a trip: the first "
        f"{UNTIL:g} s up the tower. Led sideways: the counterweight end moves laterally by {1e3 * AMPLITUDE:g} mm in {RISE:g} "
        "s. Numerical damping 0 is the paper's Newmark rule, 0.15 the default. The order is 2 if no rope runs over the "
        "sheave; on a trip, contact of elements changes faster than the time steps resolve, and the order is lower, with "
        "errors of micrometres."
    )
    blocks: list[Block] = [
        text,
        Picture("verify_convergence", _draw(mesh, step)),
        _table("element [mm]", ELEMENTS, mesh),
        _table("step [ms]", STEPS, step),
    ]
    return ComparisonReport(comparisons, blocks)


def _table(name: str, sizes: tuple[float, ...], errors: dict[str, Floats]) -> Table:
    rows = [(f"{1e3 * size:g}", *(f"{1e3 * one[k]:.5f}" for one in errors.values())) for k, size in enumerate(sizes)]
    rows.append(("order", *(f"{order(sizes, one):.2f}" for one in errors.values())))
    return Table((name, *(f"{key}, rms [mm]" for key in errors)), rows)


def _draw(mesh: dict[str, Floats], step: dict[str, Floats]) -> Any:
    figure, (left, right) = panels(2)
    for axes, sizes, errors, name in ((left, ELEMENTS, mesh, "element length [mm]"), (right, STEPS, step, "time step [ms]")):
        x = 1e3 * np.array(sizes)
        for k, (key, one) in enumerate(errors.items()):
            axes.loglog(x, 1e3 * one, "o-", color=COLOURS[k], markersize=4, label=f"{key}: order {order(sizes, one):.2f}")
        middle = 1e3 * np.exp(np.mean([np.log(one) for one in errors.values()]))
        axes.loglog(x, middle * (x / np.exp(np.log(x).mean())) ** 2, ":", color="black", linewidth=0.9, label="order 2")
        plain_log(axes.xaxis)
        label(axes, name, "difference, rms [mm]")
        legend(axes)
    return figure


CHECK = Check("convergence", "Convergence in mesh and time step", _run)
