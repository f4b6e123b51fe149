"""Heights above the bottom landing from positions of an unknown zero: found in the shaft, or as asked for."""

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
        return f"the car travels {span:.6g} m, more than the shaft's height of {height:g} m"
    least, most = first - record.lowest, height - (record.highest - first)
    accepted = f"write car_start = ... in the run, {least:.2f} to {max(most, least):.2f} m is accepted"
    if record.integrated:
        return f"a speed or an acceleration gives no height: {accepted}"
    reached = f"heights from {record.lowest:.4g} to {record.highest:.4g} m"
    return f"{reached} are outside the shaft of 0 to {height:g} m, so that their zero is another: {accepted}"


def _between(record: Record, found: tuple[float, float], given: tuple[float, float], height: float) -> Trip:
    """The motion between two given landings: shifted, an integrated one stretched."""
    way, wanted = found[1] - found[0], given[1] - given[0]
    if not record.integrated and abs(way - wanted) > MISMATCH:
        raise InputError(f"the car travels {way:.4g} m, but {wanted:.4g} m are between the given heights at start and end")
    if not record.integrated or abs(wanted) <= MISMATCH:
        return _shifted(record, given[0] - found[0], height, f"{given[0]:g} m at the start, as given")
    factor = wanted / way if way else 0.0
    if abs(factor - 1.0) > LARGEST_DRIFT:
        raise InputError(f"the integrated signal travels {way:.4g} m, but {wanted:.4g} m are between the given heights")
    low, high = (given[0] + factor * (one - found[0]) for one in (record.lowest, record.highest))
    moved = record.trip.scaled(factor, given[0] - factor * found[0])
    return _with_remarks(
        moved, [f"stretched by a factor of {factor:.5g} to end at the given height", *_inside(low, high, height)]
    )


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
