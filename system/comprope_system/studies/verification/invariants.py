"""Invariants: mirror symmetry, restart from a saved state, conservation of energy."""

from typing import Any

import numpy as np

from comprope.rope.simulator.rope import CompensationRope

from ...presets.paper_installations import TOWER, installation, trip_up
from ...report.comparison_report import ComparisonReport
from ...report.page import Picture, Table
from ...report.plot_style import COLOURS, label, legend, panels, plain_log
from ...vibration.prescribed_trip import INTERVAL, Floats, ends_path, record_trip, simulate_trip
from .check import Check, pass_or_fail

DISTANCE, UNTIL = 20.0, 14.0  # m, s
HEIGHTS = (0.5, 10.0)  # m
STEPS = (0.008, 0.004, 0.002, 0.001)  # s
ROUNDING = 1e-8  # m: Newton's iteration ends at corrections of 1e-8 m, which need not mirror


def mirrored(path: Floats) -> Floats:
    """Mirror image of the motion of the ends: car and counterweight exchanged, lateral motion with the opposite sign."""
    car_x, car_y, other_x, other_y = path.reshape(4, 6)
    return np.concatenate([other_x, -other_y, car_x, -car_y])


def mirror_difference() -> float:
    """Largest difference [m] between a trip up and its mirror image, displacements at HEIGHTS with sides exchanged."""
    model, trip = installation(TOWER), trip_up(TOWER, DISTANCE)
    plain, image = CompensationRope(model), CompensationRope(model)
    image.solve_equilibrium(model.shaft.height - trip.origin, trip.origin)
    largest = 0.0
    for k, _ in enumerate(simulate_trip(plain, trip, UNTIL)):
        for side, other in (("car", "counterweight"), ("counterweight", "car")):
            for height in HEIGHTS:
                a, b = plain.lateral_displacement(side, height)[0], image.lateral_displacement(other, height)[0]
                largest = max(largest, abs(a - b))
        image.step(INTERVAL, mirrored(ends_path(model, trip, k * INTERVAL, (k + 1) * INTERVAL)))
    return largest


def restart_differs() -> bool:
    """Whether a restart from a saved state, in another instance of the rope, changes any bit of the result."""
    model, trip = installation(TOWER), trip_up(TOWER, DISTANCE)
    rope, other = CompensationRope(model), CompensationRope(model)
    steps = list(enumerate(simulate_trip(rope, trip, 6.0)))
    other.solve_equilibrium(trip.origin, model.shaft.height - trip.origin)
    other.state.from_bytes(rope.state.to_bytes())
    for k in range(steps[-1][0], steps[-1][0] + 150):
        for one in (rope, other):
            one.step(INTERVAL, ends_path(model, trip, k * INTERVAL, (k + 1) * INTERVAL))
    return rope.state.to_bytes() != other.state.to_bytes()


def energy_balance(step: float, damping: float = 0.0) -> tuple[Floats, Floats]:
    """Times [s] and energy [J] not accounted for on the trip, and that exchanged with the ends so far (times, 2)."""
    model = installation(TOWER, {"solver.step": step, "solver.numerical_damping": damping})
    return record_trip(
        model, trip_up(TOWER, DISTANCE), UNTIL, lambda rope: np.array([rope.energy_residual, rope.energies()["ends"]])
    )


def _run() -> ComparisonReport:
    mirror, restart = mirror_difference(), restart_differs()
    series = {step: energy_balance(step) for step in STEPS}
    left = np.array([np.abs(seen[:, 0]).max() for _, seen in series.values()])
    scale = float(np.ptp(series[STEPS[1]][1][:, 1]))
    share = float(left[1] / scale)
    comparisons = [
        pass_or_fail("trip and its mirror image", f"equal within {ROUNDING:g} m", f"{mirror:.1e} m at most", mirror < ROUNDING),
        pass_or_fail("restart from a saved state", "bitwise equal", "differs" if restart else "bitwise equal", not restart),
        pass_or_fail(
            "energy residual, step 4 ms",
            f"under 0.1 % of the {scale:.0f} J exchanged by the ends",
            f"{100 * share:.4f} %",
            share < 1e-3,
        ),
        pass_or_fail("the same at half the step", "less", f"{left[2] / left[1]:.2f} of it", bool(left[2] < left[1])),
    ]
    text = (
        f"A trip of {DISTANCE:g} m up the tower and {UNTIL:g} s. Energy residual: stored energy minus its initial value, minus "
        "the work of the ends, plus all losses, integrated by the trapezoidal rule; time integration as in the paper, without "
        "numerical damping. The residual is the integration error where stiff contact and axial waves are not resolved."
    )
    rows = [(f"{1e3 * step:g}", f"{value:.2e}") for step, value in zip(STEPS, left, strict=True)]
    table = Table(("step [ms]", "energy residual [J]"), rows)
    return ComparisonReport(comparisons, [text, Picture("verify_energy", _draw(series, left)), table])


def _draw(series: dict[float, tuple[Floats, Floats]], left: Floats) -> Any:
    figure, (time, size) = panels(2)
    for k, (step, (at, seen)) in enumerate(series.items()):
        time.plot(at, 1e3 * seen[:, 0], color=COLOURS[k], linewidth=1.0, label=f"{1e3 * step:g} ms")
    size.loglog([1e3 * step for step in STEPS], 1e3 * left, "o-", color=COLOURS[0], markersize=4)
    plain_log(size.xaxis)
    label(time, "time [s]", "energy residual [mJ]")
    label(size, "time step [ms]", "at most [mJ]")
    legend(time)
    return figure


CHECK = Check("invariants", "Symmetry, restart and energy", _run)
