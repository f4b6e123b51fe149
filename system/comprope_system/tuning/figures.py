"""Figures of `comprope tune`."""

from collections.abc import Mapping, Sequence
from typing import Any

from ..report.plot_style import COLOURS, GREY, label, legend, panels

LINES = (("present", "present", GREY), ("best S-curve", "s_curve", COLOURS[1]), ("tuned", "tuned", COLOURS[0]))


def draw_installed(trip: Mapping[str, Any]) -> Any:
    """Speed, acceleration and largest relative displacement over time: present, best S-curve and tuned."""
    figure, (speed, acceleration, swing) = panels(1, 3, height=2.1)
    for name, key, colour in LINES:
        one = trip["installed"][key]
        speed.plot(one["time"], one["speed"], color=colour, label=name)
        acceleration.plot(one["time"], one["acceleration"], color=colour)
        swing.plot(one["time"], [1e3 * value for value in one["largest"]], color=colour, linewidth=1.1)
        swing.axvline(one["end"], color=colour, linewidth=0.8, linestyle=":")
    legend(speed, ncols=3)
    label(speed, "", "reference speed [m/s]")
    label(acceleration, "", "acceleration [m/s²]")
    label(swing, "time [s] (dotted: end of the trip)", "largest displacement [mm]")
    return figure


def draw_fronts(trips: Sequence[Mapping[str, Any]]) -> Any:
    """Swing during and after over travel time, a row for each trip."""
    figure, axes = panels(2, len(trips), height=2.3)
    for row, trip in enumerate(trips):
        for column, what in enumerate(("during", "after")):
            one = axes[2 * row + column]
            present = trip["present"]
            one.plot([present["time"]], [1e3 * present["full"][column]], "s", color="#333333", label="present", markersize=5)
            for name, key, colour in LINES[1:]:
                points = [(point[key]["time"], 1e3 * point[key]["full"][column]) for point in trip["points"]]
                one.plot(*zip(*points, strict=True), "o-", color=colour, label=name, markersize=3.5) if points else None
            one.set_ylim(0.0, 1.12 * max(one.get_ylim()[1], 1e3 * present["full"][column]))
            label(one, "travel time [s]", f"{what} [mm]", f"{trip['origin']:g} to {trip['destination']:g} m")
    legend(axes[0])
    return figure


def draw_servo(servo: Mapping[str, Any]) -> Any:
    """Stability margins and damping of the vertical vibration of the car, before and after."""
    figure, axes = panels(4, height=2.4)
    names = (("gain", "gain margin", 1.0), ("phase", "phase margin [°]", 1.0), ("delay", "delay margin [ms]", 1e3),
             ("bounce", "damping of the vibration", 1.0))  # fmt: skip
    for one, (key, text, scale) in zip(axes, names, strict=True):
        values = [scale * servo[name][key] for name in ("present", "chosen")]
        one.bar(["present", "chosen"], values, color=[GREY, COLOURS[0]], width=0.6)
        label(one, "", text)
    return figure
