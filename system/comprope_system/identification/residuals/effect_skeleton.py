"""Skeleton of an effect of the user's own, from the force that explains the residual.

The file acts where the best estimate acts, follows what that correlates with, and begins with its size. Only the name and the law
are left to the user: a sinusoid, or a proportional force, is the simplest law that follows a coordinate.
"""

from dataclasses import dataclass
from textwrap import fill

import numpy as np

from ..data.campaign import Campaign
from ..settings import CORRELATION, FORCE_REPORT
from .force_locations import ForceLocation
from .input_estimation import ForceEstimate, InputEstimation
from .residual_correlation import ResidualCorrelation, explained_squares
from .skeleton_templates import ENDS, FILE, LOCATIONS, ON_SIDE, PROPORTIONAL, SINUSOIDS


@dataclass(frozen=True)
class Law:
    """What the force follows: declarations of its quantities by name, statements, its value, and for a motion its derivatives."""

    quantities: dict[str, str]
    statements: tuple[str, ...]
    value: str
    rates: str = ""


def effect_skeleton(force: InputEstimation, campaign: Campaign) -> str | None:
    """Text of a file with the estimated force as an effect; None where it follows nothing that such a file can state."""
    best = force.estimates[0]
    if best.share < CORRELATION.min_share:
        return None
    clear = [one for one in force.correlations if one.share > _least_share(one)]
    for one in clear:
        if law := _law(best, one, campaign):
            return _file(force, best.location, one.coordinate, law)
    return None


def _least_share(one: ResidualCorrelation) -> float:
    return CORRELATION.min_share if one.peak is None else FORCE_REPORT.min_sinusoid_share


def _law(best: ForceEstimate, one: ResidualCorrelation, campaign: Campaign) -> Law | None:
    """The law of a coordinate; a motion of an end needs one whose derivatives are known."""
    if one.coordinate in SINUSOIDS:
        return _sinusoid(best, one, campaign)
    if one.coordinate in PROPORTIONAL and best.location.quantity not in ENDS:
        top = max(float(np.abs(run.trip.velocity(run.time)).max()) for run in campaign.runs)
        speed = f'"m/s", "speed at which it has that size", 1e-6, 100.0, default={number(top)}'
        declared = {"size": _size(best, -FORCE_REPORT.largest_size * best.size), "reference": speed}
        return Law(declared, (), f"p[SIZE] * {PROPORTIONAL[one.coordinate]} / p[REFERENCE]")
    return None


def _sinusoid(best: ForceEstimate, one: ResidualCorrelation, campaign: Campaign) -> Law:
    """A sinusoid over a coordinate."""
    name, unit, meaning, factor, (value, rate, change) = SINUSOIDS[one.coordinate]
    found = one.peak or 1.0 / _wave_number(best, campaign)
    declared = {
        "size": _size(best, 0.0),
        "phase": '"rad", "phase of the sinusoid", -2 * pi, 2 * pi, default=0.0, nominal=1.0',
        name: f'"{unit}", "{meaning}", {number(0.01 * found)}, {number(100.0 * found)}, default={number(found)}',
    }
    angle = (f"k = {factor}", f"angle = k * {value} + p[PHASE]")
    return Law(declared, angle, "p[SIZE] * sin(angle)", f"rate, change = k * {rate}, k * {change}")


def _size(best: ForceEstimate, least: float) -> str:
    """Declaration of the size, in the unit of the location; that of a sinusoid with the estimated rms is the nominal one."""
    limits, nominal = f"{number(least)}, {number(FORCE_REPORT.largest_size * best.size)}", number(2.0**0.5 * best.size)
    return f'"{best.location.unit}", "largest value of {best.location.name}", {limits}, nominal={nominal}, off=0.0'


def _wave_number(best: ForceEstimate, campaign: Campaign) -> float:
    """Periods per metre of the car's way that explain most of the force."""
    height = campaign.model.shaft.height
    grid = np.arange(1.0, FORCE_REPORT.max_waves, FORCE_REPORT.waves_step) / height
    explained = np.zeros(len(grid))
    for run in campaign.runs:
        if history := best.histories.get(run.file):
            explained += explained_squares(2.0 * np.pi * run.trip.position(history.time), history.value, grid)
    return float(grid[int(np.argmax(explained))])


def _file(force: InputEstimation, location: ForceLocation, coordinate: str, law: Law) -> str:
    """The text of the file."""
    on_side, moves, declared = location.quantity.endswith("side"), location.quantity in ENDS, dict(law.quantities)
    if on_side:
        limits = f"{number(-location.reach)}, {number(location.height + 10.0 * location.reach)}"
        declared["height"] = f'"m", "height at which it is largest", {limits}, default={number(location.height)}'
        declared["reach"] = f'"m", "distance above and below at which it is zero", 0.01, 1e3, default={number(location.reach)}'
    sinusoid = "phase" in declared
    lines = ['    polar = ("size", "phase")'] if sinusoid else []
    return FILE.substitute(
        sentence=fill(f"{force.sentence()}.", FORCE_REPORT.comment_width), location=location.name, coordinate=coordinate,
        imports=f"from math import {'cos, ' if moves else ''}pi, sin\n\n" if sinusoid else "",
        quantities="\n".join([*lines, *(f"    {name}: float = quantity({text})" for name, text in declared.items())]),
        slots="\n".join(f'{name.upper()} = slot("effects.missing_effect.{name}")' for name in declared),
        on_side=ON_SIDE if on_side else "",
        kernel=_motion(location, law) if moves else _force(location, law),
        hook="ends=move" if moves else "forces=act",
    )  # fmt: skip


def _force(location: ForceLocation, law: Law) -> str:
    """Kernel of a force."""
    statement, power = LOCATIONS[location.quantity]
    begin = ["power = 0.0"] if power == "power" else ["m = n + 1"] if "m + n" in power else []
    lines = ['"""Add the force and return its power."""', *begin, *law.statements]
    return _kernel("act(n, t, p, q, v, w, f)", [*lines, f"force = {law.value}", statement, f"return {power}"])


def _motion(location: ForceLocation, law: Law) -> str:
    """Kernel of a motion of an end."""
    index, sign = ENDS[location.quantity]
    lines = ['"""Move the end, with velocity and acceleration."""', "m = n + 1", f"j = {index}", *law.statements, law.rates]
    moved = [
        f"q[j] += {sign}p[SIZE] * sin(angle)",
        f"v[j] += {sign}p[SIZE] * cos(angle) * rate",
        f"a[j] += {sign}p[SIZE] * (cos(angle) * change - sin(angle) * rate * rate)",
    ]
    return _kernel("move(n, t, p, q, v, a)", [*lines, *moved])


def _kernel(signature: str, lines: list[str]) -> str:
    return "\n".join(["@kernel", f"def {signature}:", *(f"    {line}" for line in lines)])


def number(value: float) -> str:
    """A number of three digits, without an exponent where it needs none."""
    return f"{float(f'{value:.3g}'):g}"
