"""HTML page of `comprope tune`: trade-off of travel time and swing, controllers, robustness, error of the reduced model."""

from collections.abc import Mapping, Sequence
from typing import Any

from ..report.page import Block, Picture, Section, Table
from .figures import draw_fronts, draw_installed, draw_servo

TITLE = "Tuning of trips and servo"
LEAD = (
    "Swing is the lateral displacement of either side of the rope relative to its static shape for the same car position: the "
    "maximum during the trip, and half the peak-to-peak value after it. Candidates are found with a reduced linear model and "
    "evaluated with the full model with drive and servo."
)
Result = Mapping[str, Any]


def sections(result: Result) -> list[Section]:
    """The page's sections."""
    return [
        Section("trips", "Trips: present and tuned", _trips(result)),
        Section("fronts", "Travel time against swing", _fronts(result)),
        Section("quiet", "Travel time needed for less swing", _quiet(result)),
        Section("robust", "Robustness against the sheave mass", _robust(result)),
        Section("servo", "Servo gains and stability margins", _servo(result)),
        Section("controller", "One controller for all trips", _controller(result)),
        Section("search", "Error of the reduced model", _search(result)),
    ]


def summary(result: Result) -> list[str]:
    """One line for each trip."""
    lines = []
    for trip in result["trips"]:
        shown = trip["installed"]
        if not shown:
            lines.append(f"{_name(trip)}: no travel time requested meets the limit")
            continue
        swings = ", ".join(f"{name} {_pair(shown[key]['swing'])}" for name, key in NAMES)
        lines.append(f"{_name(trip)}: during/after [mm] {swings}; {shown['factor']:g} times the present travel time")
    return lines


NAMES = (("present", "present"), ("best S-curve", "s_curve"), ("tuned", "tuned"))


def _name(trip: Mapping[str, Any]) -> str:
    return f"{trip['origin']:g} to {trip['destination']:g} m"


def _mm(value: float | None) -> str:
    return "" if value is None else f"{1e3 * value:.2f}"


def _pair(values: Sequence[float]) -> str:
    return f"{_mm(values[0])}/{_mm(values[1])}"


def _point(trip: Mapping[str, Any]) -> Mapping[str, Any] | None:
    shown = trip["installed"]
    return next((one for one in trip["points"] if one["factor"] == shown["factor"]), None) if shown else None


def _trips(result: Result) -> list[Block]:
    rows, blocks = [], list[Block]()
    for trip in result["trips"]:
        shown, point = trip["installed"], _point(trip)
        if not shown or not point:
            continue
        less = all(a < b for a, b in zip(shown["tuned"]["swing"], shown["s_curve"]["swing"], strict=True))
        swings = [_mm(one) for key in ("present", "s_curve", "tuned") for one in shown[key]["swing"]]
        times = f"{trip['present']['time']:.2f}", f"{point['tuned']['time']:.2f}"
        rows.append((_name(trip), *times, *swings, point["tuned"]["kind"], "yes" if less else "no"))
        blocks.append(Picture(f"trip_{trip['origin']:g}_{trip['destination']:g}", draw_installed(trip), _name(trip)))
    head = (
        "trip", "present [s]", "tuned [s]", "present: during [mm]", "after", "best S-curve: during", "after", "tuned: during",
        "after", "family", "less in both",
    )  # fmt: skip
    text = (
        "Simulated with the FMUs of drive and rope. The best S-curve is the jerk-limited trip with the same travel time, limits "
        "and servo and the smallest swing."
    )
    return [text, Table(head, rows), *blocks]


def _fronts(result: Result) -> list[Block]:
    rows = []
    for trip in result["trips"]:
        for point in trip["points"]:
            swings = [_mm(one) for key in ("s_curve", "tuned") for one in point[key]["full"]]
            rows.append((_name(trip), f"{point['factor']:g}", f"{point['time']:.2f}", *swings, point["tuned"]["kind"]))
    head = ("trip", "travel time / present", "time [s]", "S-curve: during [mm]", "after", "tuned: during", "after", "family")
    return [Picture("fronts", draw_fronts(result["trips"])), Table(head, rows)]


def _quiet(result: Result) -> list[Block]:
    rows, short = [], []
    for trip in result["trips"]:
        present = trip["present"]["time"]
        cells = []
        for least_times, least in zip(trip["saved"], trip["bound"]["times"], strict=True):
            left = least_times["full"][1] / trip["present"]["full"][1] if least_times["full"] else None
            cells += [
                f"+{least_times['time'] - present:.2f}" if least_times["time"] else "none found",
                f"{100.0 * (1.0 - left):.0f}" if left is not None else "",
                f"+{max(least - present, 0.0):.2f}" if least else "none",
            ]  # fmt: skip
        rows.append((_name(trip), f"{present:.2f}", f"{trip['period']:.2f}", *cells))
        if trip["bound"]["too_short"] > 0.0:
            short.append(f"{_name(trip)} ({100.0 * trip['bound']['too_short']:.0f} % of the swing of an impulse)")
    head = (
        "trip", "present [s]", "longest period [s]", "half: additional [s]", "reduction, full model [%]", "bound [s]",
        "a fifth: additional [s]", "reduction, full model [%]", "bound [s]",
    )  # fmt: skip
    text = (
        "Additional travel time that reduces the swing after the trip to a half and to a fifth. The bound is the additional time "
        "of the fastest acceleration profile of any shape within the limits whose spectrum at the longest period is as small; "
        "since the period of the rope changes during the trip and other modes contribute, the actual value may be larger or "
        "smaller."
    )
    if short:
        remark = f"Shorter than half a period, so that no profile avoids the excitation: {', '.join(short)}."
    else:
        remark = "Every trip lasts longer than half a period."
    return [text, Table(head, rows), remark]


def _robust(result: Result) -> list[Block]:
    rows = []
    for trip in result["trips"]:
        if not trip["robust"]:
            continue
        cells = [_mm(one) for row in trip["robust"] for key in ("s_curve", "tuned") for one in row[key]]
        rows.append((_name(trip), *cells))
    head = ["trip"]
    for mass in ("−10 %", "+10 %"):
        head += [f"{mass}: S-curve, during [mm]", "after", "tuned: during", "after"]
    return ["The same drives with a sheave mass 10 % lower and higher, full model.", Table(head, rows)]


def _servo(result: Result) -> list[Block]:
    rows = []
    for name, key in (("present", "present"), ("chosen", "chosen")):
        one = result["servo"][key]
        rows.append((
            name, f"{one['position_bandwidth']:.3g}", f"{one['speed_bandwidth']:.3g}", f"{one['speed_damping']:.3g}",
            f"{one['gain']:.2f}", f"{one['phase']:.1f}", f"{1e3 * one['delay']:.0f}", f"{one['bounce']:.3f}",
        ))  # fmt: skip
    head = (
        "servo", "position [rad/s]", "speed [rad/s]", "damping", "gain margin", "phase margin [°]", "delay margin [ms]",
        "damping ratio of the slower vibration",
    )  # fmt: skip
    text = (
        "Car and counterweight vibrate vertically on their hoist ropes, which excites a side of the rope with a similar period. "
        "The chosen gains maximise the damping of this vibration, averaged over car positions, subject to a gain margin of 2, a "
        "phase margin of 45° and a delay margin of 20 ms at the bottom, in the middle and at the top."
    )
    return [text, Table(head, rows), Picture("servo", draw_servo(result["servo"]))]


def _controller(result: Result) -> list[Block]:
    found = result["controller"]
    if not found:
        return ["No family of profiles meets the requested travel time."]
    rows = []
    for trip, time, full in zip(result["trips"], found["times"], found["full"], strict=True):
        rows.append((_name(trip), f"{trip['present']['time']:.2f}", f"{time:.2f}", _pair(trip["present"]["full"]), _pair(full)))
    head = ("trip", "present [s]", "tuned [s]", "present: during/after [mm]", "tuned: during/after [mm]")
    text = (
        f"controller.drive.toml: {found['kind']}, with {100.0 * result['extra']:.0f} % more travel time over all trips together."
    )
    return [text, Table(head, rows)]


def errors(trips: Sequence[Mapping[str, Any]]) -> list[float]:
    """Relative errors of the swing of the reduced model, during and after all trips: full / reduced - 1."""
    evaluated = [trip["present"] for trip in trips]
    evaluated += [point[key] for trip in trips for point in trip["points"] for key in ("s_curve", "tuned")]
    return [
        full / reduced - 1.0
        for one in evaluated
        for reduced, full in zip(one["small"], one["full"], strict=True)
        if reduced > 0.0
    ]


def _search(result: Result) -> list[Block]:
    found = sorted(errors(result["trips"]))
    middle = found[len(found) // 2]
    rows = []
    for trip in result["trips"]:
        one = trip["present"]
        rows.append((_name(trip), _pair(one["small"]), _pair(one["full"])))
    text = (
        f"Swing of the full model relative to the reduced model, {len(found)} values: median {100 * middle:+.0f} %, range "
        f"{100 * found[0]:+.0f} to {100 * found[-1]:+.0f} %. rope_models.json contains the rope as state-space models of "
        "python-control at seven car positions."
    )
    return [text, Table(("present trip", "reduced model: during/after [mm]", "full model"), rows)]
