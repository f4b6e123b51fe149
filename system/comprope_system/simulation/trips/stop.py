"""How a trip ends before its destination: by the drive, brake, safety gear or buffer, and what each of them applies."""

from dataclasses import dataclass
from typing import Literal

from comprope.drive.control.hoist_dynamics import moving_mass
from comprope.drive.parameters import Drive
from comprope.errors import InputError

Buffer = Literal["hydraulic", "spring"]

CONTROLLED = 3.0  # m/s2, of a stop by the drive; engineering judgement
SAFETY_GEAR = 15.0  # m/s2; a progressive gear is set for a full car (0.2 to 1 g, EN 81-20) and stops an empty one harder
HYDRAULIC = 9.81  # m/s2: 1 g on average is the most that EN 81-20 accepts of a buffer
SPRING_STROKE = 0.135  # s2/m, times v^2: least stroke [m] of a spring buffer, EN 81-20
LEAST, LARGEST = 0.1, 100.0  # m/s2 that are accepted
SLOWEST = 0.01  # m/s: a car that creeps is at rest
LARGEST_TORQUE = 1e7  # N m, as that of the drive's motor
OVERRUN = 1000.0  # m: a drive that runs on to a buffer does not slow down before it


@dataclass(frozen=True)
class Stop:
    """A stop at `time` [s]: by a `deceleration` [m/s2], the car's safety gear, a buffer, or the machine's `brake` [N m].

    Brake, safety gear and buffers are those of the drive, whose hoist ropes may go slack and slip; `deceleration` is then that
    of a car that hangs on nothing. With a buffer, car or counterweight runs on at its speed past the bottom landing. Without
    any of them both masses follow a motion with this deceleration, 3 m/s2 if none is given.
    """

    time: float = 0.0
    deceleration: float | None = None
    safety_gear: bool = False
    buffer: Buffer | None = None
    brake: float | None = None

    def __post_init__(self) -> None:
        """Raises `InputError` for what cannot be."""
        if not 0.0 <= self.time < 1e6:
            raise InputError(f"stop = {self.time:g} s: 0 to 1e6 s is accepted")
        if self.deceleration is not None and not LEAST <= self.deceleration <= LARGEST:
            raise InputError(f"deceleration = {self.deceleration:g} m/s2: {LEAST:g} to {LARGEST:g} m/s2 is accepted")
        if self.buffer not in (None, "hydraulic", "spring"):
            raise InputError(f"buffer = {self.buffer}: hydraulic or spring is accepted")
        if self.brake is not None and not 0.0 < self.brake <= LARGEST_TORQUE:
            raise InputError(f"brake = {self.brake:g} N m: above 0 to {LARGEST_TORQUE:g} N m is accepted")
        if self.buffer and self.time:
            raise InputError(f"stop = {self.time:g} s: not accepted with a buffer, which is met where the car runs on to it")
        given = [name for name in ("safety_gear", "buffer", "brake") if getattr(self, name)]
        if len(given) > 1:
            raise InputError(f"{' and '.join(given)}: one of them is accepted in a stop")
        if self.deceleration is not None and (self.brake is not None or self.buffer == "spring"):
            other = "brake" if self.brake is not None else "buffer = spring"
            raise InputError(f"deceleration = {self.deceleration:g} m/s2: not accepted with {other}, which determines it")

    @property
    def applied(self) -> float:
        """Deceleration [m/s2] of what is stopped; a brake's depends on the drive, a spring's builds up."""
        return self.deceleration or (SAFETY_GEAR if self.safety_gear else HYDRAULIC if self.buffer else CONTROLLED)

    @property
    def devices(self) -> tuple[str, ...]:
        """The inputs of the drive that are applied; none for a buffer, and for a stop by the drive."""
        return tuple(name for name in ("safety_gear", "brake") if getattr(self, name))


def stopping_drive(drive: Drive, stop: Stop) -> Drive:
    """The drive with what stops its car: a brake's torque, a gear's deceleration, or buffers that it runs on to."""
    table = drive.model_dump()
    if stop.brake is not None:
        table["brake"]["torque"] = stop.brake
    if stop.safety_gear and stop.deceleration is not None:
        table["safety_gear"]["deceleration"] = stop.deceleration
    if stop.buffer:
        up = drive.trip.destination > drive.trip.start_position
        table["trip"] |= {"destination": drive.shaft.height if up else 0.0, "overrun": OVERRUN}
        # Both masses stop together: a spring of this stroke slows them by 7.4 m/s2 at most, less than gravity.
        spring = moving_mass(drive) * (drive.profile.speed / (SPRING_STROKE * drive.profile.speed**2)) ** 2
        table["buffer"] |= {"deceleration": stop.applied} if stop.buffer == "hydraulic" else {"stiffness": spring}
    return Drive.model_validate(table)
