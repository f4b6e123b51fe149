"""Heights above the bottom landing from positions of an unknown zero and sign: found in the shaft, or as asked for."""

from dataclasses import dataclass

from comprope.errors import InputError

from .trip import Trip

OVERTRAVEL = 0.5  # m beyond a landing that a car may reach, on a buffer for instance
BEYOND = 0.05  # m beyond a landing that are worth a remark: encoders and rope stretch account for less
FOUND = 0.1  # m; a trip of the height of the shaft to within this can be at one place only
MISMATCH = 0.05  # m between a measured and a given height that are the same: levelling errors are below it
LARGEST_DRIFT = 0.05  # share of the distance by which an integrated signal may miss the landing where the car stopped


@dataclass(frozen=True)
class Landings:
    """Heights of the car [m] at the start and end of the record, where they are known."""

    start: float | None = None
    end: float | None = None


@dataclass(frozen=True)
class Record:
    """A recovered motion over a record from `begin` to `stop` [s]; `integrated`: from a speed or acceleration, without a zero."""

    trip: Trip
    begin: float
    stop: float
    lowest: float
    highest: float
    integrated: bool


def anchored(record: Record, landings: Landings, height: float) -> Trip:
    """The motion with its heights above the bottom landing, in a shaft of this height [m].

    Raises `InputError` where the place of the motion in the shaft remains unknown or contradicts the landings given.
    """
    first, last = float(record.trip.position(record.begin)), float(record.trip.position(record.stop))
    if landings.start is not None and landings.end is not None:
        return _between(record, (first, last), (landings.start, landings.end), height)
    if landings.start is not None:
        return _shifted(record, landings.start - first, height, f"{landings.start:g} m at the start, as given")
    if landings.end is not None:
        return _shifted(record, landings.end - last, height, f"{landings.end:g} m at the end, as given")
    inside = record.lowest >= -OVERTRAVEL and record.highest <= height + OVERTRAVEL
    if inside and not record.integrated:
        return _with_remarks(record.trip, _beyond(record.lowest, record.highest, height))
    if abs(record.highest - record.lowest - height) <= FOUND:
        return _shifted(record, -record.lowest, height, "the lowest one 0, the only place in the shaft for such a trip")
    raise InputError(_unknown(record, first, height))


def _unknown(record: Record, first: float, height: float) -> str:
    span = record.highest - record.lowest
    if span > height + 2.0 * OVERTRAVEL:
        hint = "; its unit is probably mm" if span > 100.0 * height else ""
        return f"the car travels {span:.6g} m, more than the shaft's height of {height:g} m{hint}"
    least, most = first - record.lowest, height - (record.highest - first)
    accepted = f"give the height of the car at the start of the record, {least:.2f} to {max(most, least):.2f} m is accepted"
    if record.integrated:
        return f"a speed or an acceleration gives no height: {accepted}"
    reached = f"heights from {record.lowest:.4g} to {record.highest:.4g} m"
    return f"{reached} are outside the shaft of 0 to {height:g} m, so that their zero is another: {accepted}"


def _between(record: Record, found: tuple[float, float], given: tuple[float, float], height: float) -> Trip:
    """The motion between two given landings: shifted, turned round if it counts downwards, an integrated one stretched."""
    way, wanted = found[1] - found[0], given[1] - given[0]
    if not record.integrated and abs(abs(way) - abs(wanted)) > MISMATCH:
        raise InputError(
            f"the car travels {abs(way):.4g} m, but {abs(wanted):.4g} m are between the given heights at start and end"
        )
    if abs(wanted) <= MISMATCH:
        return _shifted(record, given[0] - found[0], height, f"{given[0]:g} m at the start, as given")
    factor = wanted / way if way else 0.0
    if record.integrated and abs(abs(factor) - 1.0) > LARGEST_DRIFT:
        raise InputError(f"the integrated signal travels {abs(way):.4g} m, but {abs(wanted):.4g} m are between the given heights")
    scale = factor if record.integrated else (1.0 if factor > 0.0 else -1.0)
    remarks = []
    if scale < 0.0:
        remarks.append("counts downwards, as the given heights at start and end show; its sign is changed")
    if record.integrated:
        remarks.append(f"integrated, then stretched by a factor of {abs(scale):.5g} to end at the given height")
    low, high = sorted((given[0] + scale * (record.lowest - found[0]), given[0] + scale * (record.highest - found[0])))
    moved = record.trip.scaled(scale, given[0] - scale * found[0])
    return _with_remarks(moved, [*remarks, *_inside(low, high, height)])


def _shifted(record: Record, shift: float, height: float, why: str) -> Trip:
    low, high = record.lowest + shift, record.highest + shift
    remarks = _inside(low, high, height)
    if abs(shift) > MISMATCH and not record.integrated:
        remarks.insert(0, f"heights are shifted by {shift:.4g} m ({why})")
    return _with_remarks(record.trip.scaled(1.0, shift), remarks)


def _inside(low: float, high: float, height: float) -> list[str]:
    if low < -OVERTRAVEL or high > height + OVERTRAVEL:
        raise InputError(f"with the given heights the car would be at {low:.4g} to {high:.4g} m in a shaft of 0 to {height:g} m")
    return _beyond(low, high, height)


def _beyond(low: float, high: float, height: float) -> list[str]:
    most = max(-low, high - height)
    return [f"reaches {most:.3g} m beyond a terminal landing"] if most > BEYOND else []


def _with_remarks(trip: Trip, remarks: list[str]) -> Trip:
    return Trip(trip.pieces, trip.noise, trip.kind, (*trip.remarks, *remarks))
