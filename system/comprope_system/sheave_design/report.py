"""HTML page of `comprope design`."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from comprope.drive.parameters import Profile
from comprope.rope.effects import RopeModel

from ..report.page import Block, Picture, Section, Table
from ..report.plot_style import COLOURS, GREY, label, legend, panels, plain_log
from ..vibration.modal.hanging_string import side_string
from .trip_envelopes import floor_heights, s_curve_trajectory

TITLE = "Compensation rope: sheave and sensors"
LEAD = (
    "The smallest sheave mass that meets a limit of the swing on all trips between floors and under building sway, sensor "
    "heights, and resonances. Swing is the largest lateral displacement of either side of the rope relative to its static shape."
)
Result = Mapping[str, Any]
MODES = (1, 2, 3)


def summary(result: Result) -> list[str]:
    """Results as lines of text."""
    places = ", ".join(f"{one['side']} {one['height']:.1f} m" for one in result["sensors"]["places"])
    return [
        f"smallest sheave mass for {1e3 * result['limit']:g} mm: {result['mass']:.1f} kg as sheave.mass "
        f"(reduced model: {result['mass_small']:.1f} kg)",
        *_worst_stops(result),
        *(
            f"clearance, {one['case']}: {1e3 * one['clearance']:.0f} mm on the {one['side']}'s side at {one['height']:.1f} m, "
            f"car at {one['car']:.1f} m"
            for one in result["clearances"]
        ),
        *_shared(result),
        f"sensors: {places}; one of them measures at least {100.0 * result['sensors']['share']:.0f} % of any large swing",
    ]


def sections(result: Result, model: RopeModel, chosen: RopeModel, profile: Profile) -> list[Section]:
    """The page's sections."""
    return [
        Section("mass", "Smallest sheave mass", _mass(result)),
        Section("resonance", "Resonances", _resonance(result, model, chosen, profile)),
        Section("sensors", "Sensor heights", _sensors(result)),
        *([Section("stops", "Stops", _stops(result))] if result["stops"] else []),
        *([Section("clearance", "Clearance", _clearances(result))] if result["clearances"] else []),
        *([Section("sharing", "Ropes that differ", _sharing(result["sharing"]))] if result["sharing"] else []),
    ]


def _worst_stops(result: Result) -> list[str]:
    """The largest rise, force and tension of each kind of stop."""
    lines = []
    for kind in dict.fromkeys(one["stop"] for one in result["stops"]):
        rise, force, tension = (
            max(one[name] for one in result["stops"] if one["stop"] == kind) for name in ("rise", "sheave_force", "peak_tension")
        )
        lines.append(
            f"stop, {kind}: the sheave rises by up to {1e3 * rise:.0f} mm and takes {force:.0f} N, the rope {tension:.0f} N"
            + _beside([one for one in result["stops"] if one["stop"] == kind])
        )
    return lines


def _shared(result: Result) -> list[str]:
    """The rope that carries most of the sheave, and the one that carries least."""
    if not result["sharing"]:
        return []
    ropes = result["sharing"]["ropes"]
    most, least = max(ropes, key=lambda one: one["largest"]), min(ropes, key=lambda one: one["least"])
    return [
        f"ropes that differ: rope {ropes.index(most) + 1} carries up to {100.0 * most['largest']:.0f} %, rope "
        f"{ropes.index(least) + 1} as little as {100.0 * least['least']:.0f} % of the sheave; equal ones {100 / len(ropes):.0f} %"
    ]


def _sharing(sharing: Result) -> list[Block]:
    text = (
        "The car goes slowly up and down; ropes of unequal length or stiffness share the sheave's weight, turn with it and slide "
        "in their grooves where friction does not hold their difference. Quasi-static, without tilt of the sheave."
    )
    rows = [
        (str(k), f"{100.0 * one['least']:.0f} to {100.0 * one['largest']:.0f}", f"{one['largest_pull']:.0f}",
         f"{1e3 * one['slip']:.1f}")
        for k, one in enumerate(sharing["ropes"], 1)
    ]
    head = ("rope", "share of the sheave [%]", "largest pull on one side of it [N]", "slip on a way down and up [mm]")
    figure, (axes,) = panels(height=3.2)
    count = (len(sharing["cars"]) + 1) // 2
    for k, shares in enumerate(zip(*sharing["shares"], strict=True)):
        colour = COLOURS[k % len(COLOURS)]
        axes.plot(sharing["cars"][count:], [100.0 * one for one in shares[count:]], color=colour, label=f"rope {k + 1}, up")
        axes.plot(sharing["cars"][:count], [100.0 * one for one in shares[:count]], "--", color=colour, linewidth=0.9)
    label(axes, "height of the car [m]", "share of the sheave's weight [%]; dashed: down")
    legend(axes)
    return [text, Table(head, rows), Picture("design_sharing", figure)]


def _clearances(result: Result) -> list[Block]:
    text = (
        "Least distance of the rope from the shaft's wall with the smallest sheave; negative beyond the wall. The worst trip by "
        "the full model; the sway by the reduced model, relative to the building."
    )
    rows = [
        (one["case"], f"{1e3 * one['clearance']:.0f}", one["side"], f"{one['height']:.1f}", f"{one['car']:.1f}")
        for one in result["clearances"]
    ]
    return [text, Table(("case", "clearance [mm]", "side", "at [m]", "car at [m]"), rows)]


def _beside(stops: list[Result]) -> str:
    """The least clearance in stops, if a wall is given."""
    known = [one["clearance"] for one in stops if "clearance" in one]
    return f"; clearance {1e3 * min(known):.0f} mm" if known else ""


def _stops(result: Result) -> list[Block]:
    text = (
        "The car comes down from the top landing and is stopped as it passes each floor: by its drive, at 1 g, and by its safety "
        "gear, harder than by gravity, where the counterweight flies on, falls back and lands. Full model with the smallest "
        "sheave; forces are those of one rope."
    )
    rows = [
        (one["stop"], f"{one['height']:.1f}", f"{one['speed']:.2f}", f"{1e3 * one['rise']:.1f}", f"{one['sheave_force']:.0f}",
         f"{one['peak_tension']:.0f}", f"{one['slack_duration']:.2f}",
         *([f"{1e3 * one['clearance']:.0f}"] if "clearance" in one else []))
        for one in result["stops"]
    ]  # fmt: skip
    head = (
        "stop", "at [m]", "speed [m/s]", "rise of the sheave [mm]", "force on it [N]", "largest tension [N]", "slack for [s]",
        *(["clearance [mm]"] if any("clearance" in one for one in result["stops"]) else []),
    )  # fmt: skip
    return [text, Table(head, rows)]


def _mass(result: Result) -> list[Block]:
    worst = min(result["scanned"], key=lambda one: abs(one["mass"] - result["mass"]))
    sway = result["sway"]
    kept = (
        ""
        if not sway
        else ""
        if result["sway_limit"] is None
        else f" and the swing under building sway below {result['sway_limit']:g} mm"
    )
    swayed = (
        f"The building sways by {1e3 * sway['amplitude']:g} mm at the top landing with a period of {sway['period']:g} s for "
        f"{sway['duration']:g} s, car parked: the worst floor for a similar mass is at {worst['sway_car']:g} m, with "
        f"{1e3 * worst['sway']:.1f} mm. The swing is largest at the floor where the rope has the period of the sway; another "
        "mass shifts this floor, and parking at another floor avoids the resonance. " if sway else ""
    )  # fmt: skip
    text = (
        f"{result['mass']:.1f} kg as sheave.mass keep the swing below {1e3 * result['limit']:g} mm on all trips between "
        f"{result['floors']} floors{kept}. For a mass near this one the worst trip is from {worst['trip'][0]:g} to "
        f"{worst['trip'][1]:g} m. The mass is scanned with the reduced linear model; the worst trip is simulated with the "
        f"full model, and the mass increased until it meets the limit. {swayed}Building sway is evaluated with the reduced "
        "model only, which has no damping and therefore overestimates the swing near resonance."
    )
    rows = [
        (f"{one['mass']:.1f}", f"{1e3 * one['swing']:.2f}", f"{one['trip'][0]:g} to {one['trip'][1]:g} m",
         f"{1e3 * one['after']:.2f}", f"{1e3 * one['sway']:.2f}" if sway else "", f"{one['sway_car']:g}" if sway else "")
        for one in result["scanned"]
    ]  # fmt: skip
    head = ("mass [kg]", "worst trip [mm]", "which", "worst after a trip [mm]", "worst sway [mm]", "car parked at [m]")
    full = Table(
        ("mass [kg]", "worst trip, full model [mm]"),
        [(f"{mass:.1f}", f"{1e3 * swing:.2f}") for mass, swing in result["full"]],
        "The worst trip simulated with the full model; the last mass is the result",
    )
    return [text, Picture("design_mass", _draw_mass(result)), Table(head, rows), full]


def _draw_mass(result: Result) -> Any:
    figure, (axes,) = panels(height=3.2)
    masses = [one["mass"] for one in result["scanned"]]
    axes.loglog(
        masses, [1e3 * one["swing"] for one in result["scanned"]], "o-", color=COLOURS[0], markersize=3.5, label="worst trip"
    )
    if result["sway"]:
        axes.loglog(
            masses, [1e3 * one["sway"] for one in result["scanned"]], "o-", color=COLOURS[2], markersize=3.5, label="sway"
        )
    full = [(mass, 1e3 * swing) for mass, swing in result["full"]]
    axes.loglog(*zip(*full, strict=True), "D", color=COLOURS[1], markersize=4.5, label="worst trip, full model")
    axes.axhline(1e3 * result["limit"], color=COLOURS[4], linewidth=1.0, label="limit")
    axes.axvline(result["mass"], color=GREY, linewidth=0.9)
    plain_log(axes.xaxis, axes.yaxis)
    label(axes, "sheave mass [kg]", "largest displacement [mm]")
    legend(axes)
    return figure


def _resonance(result: Result, model: RopeModel, chosen: RopeModel, profile: Profile) -> list[Block]:
    text = (
        "Blue and orange: natural periods of both sides over the car position, one to three half waves. Green: duration of trips "
        "up from the bottom and down from the top landing over the position where they end, with marks at the floors; at "
        "an intersection of green with blue or orange the duration of the trip equals a natural period. The band is the period "
        "of the building sway ± 5 %."
    )
    pictures = [
        Picture(f"resonance_{name}", _draw_resonance(result, one, profile), f"Sheave of {one.sheave.mass:.1f} kg ({description})")
        for name, one, description in (("own", model, "as in the model"), ("least", chosen, "the smallest"))
    ]
    return [text, *pictures]


def _draw_resonance(result: Result, model: RopeModel, profile: Profile) -> Any:
    figure, (axes,) = panels(height=4.2)
    height = model.shaft.height
    cars = np.linspace(0.0, height, 81)
    for side, colour in (("car", COLOURS[1]), ("counterweight", COLOURS[0])):
        strings = [side_string(model, float(car), side) for car in cars]
        for waves, style in zip(MODES, ("-", "--", ":"), strict=True):
            name = f"{side}'s side, {waves} half wave{'s' if waves > 1 else ''}"
            axes.plot(cars, [one.period(waves) for one in strings], style, color=colour, linewidth=1.3, label=name)
    fine, ends = np.linspace(0.0, height, 401), floor_heights(height, result["floors"])
    for start, mark, name in ((0.0, "^", "trips up from the bottom"), (height, "v", "trips down from the top")):
        axes.plot(
            fine, [s_curve_trajectory(profile, (start, float(end))).duration for end in fine], color=COLOURS[2], linewidth=0.8
        )
        axes.plot(
            ends,
            [s_curve_trajectory(profile, (start, float(end))).duration for end in ends],
            mark,
            color=COLOURS[2],
            markersize=4.5,
            label=name,
        )
    if result["sway"]:
        period = result["sway"]["period"]
        axes.axhspan(0.95 * period, 1.05 * period, color="#f0d9d2", label="building's sway")
    axes.set_ylim(0.0, 1.3 * max(side_string(model, 0.0).period(), result["sway"]["period"] if result["sway"] else 0.0))
    label(axes, "height of the car [m]", "period, or duration of the trip [s]")
    legend(axes, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _sensors(result: Result) -> list[Block]:
    found = result["sensors"]
    text = (
        f"The {len(found['places'])} sensors were placed by greedy selection followed by exchange, so that during and after "
        "the trips with the largest swing the sensor with the largest signal measures as much as possible of the maximum along "
        f"the rope: {100.0 * found['share']:.0f} % or more on each of these trips."
    )
    rows = [(one["side"], f"{one['height']:.1f}") for one in found["places"]]
    return [text, Table(("side", "height above the bottom landing [m]"), rows), Picture("design_sensors", _draw_sensors(found))]


def _draw_sensors(found: Mapping[str, Any]) -> Any:
    figure, axes = panels(2, height=3.6)
    count = len(found["heights"])
    for one, side, largest in zip(axes, ("car", "counterweight"), (found["seen"][:count], found["seen"][count:]), strict=True):
        one.plot([1e3 * value for value in largest], found["heights"], color=COLOURS[0])
        for place in found["places"]:
            if place["side"] == side:
                one.axhline(place["height"], color=COLOURS[1], linewidth=1.2)
        label(one, "largest displacement over trips [mm]", "height [m]", f"{side}'s side; orange: sensors")
    return figure
