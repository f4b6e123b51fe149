"""How a trip ends before its destination: brake, safety gear or buffer, with the deceleration that each applies."""

from dataclasses import dataclass
from math import cos, exp, pi, sin
from typing import Literal

from comprope.drive.control.hoist_dynamics import lumped_hoist, moving_mass
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
# Traction in an emergency stop, EN 81-50: friction 0.1 / (1 + v / 10 m/s) in a semi-circular groove with an undercut.
FRICTION, FRICTION_SPEED, WRAP, UNDERCUT, GROOVE = 0.1, 10.0, pi, pi / 2.0, pi / 6.0


@dataclass(frozen=True)
class Stop:
    """A stop at `time` [s]: by a `deceleration` [m/s2], the car's safety gear, a buffer, or the machine's `brake` [N m].

    With a buffer, car or counterweight runs on at its speed until it is at the bottom landing; `time` is then the earliest.
    Without any of them the drive stops the car.
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


@dataclass(frozen=True)
class Braking:
    """What the machine's brake does: deceleration [m/s2] of car and counterweight, and whether the hoist ropes slip."""

    deceleration: float
    slips: bool


def braking(drive: Drive, torque: float, position: float, velocity: float) -> Braking:
    """Deceleration by the brake's torque [N m] with the motor off, the car at a position [m] with a velocity [m/s], up positive.

    Rigid masses; the compensation ropes' pulls are left out. Tensions on both sides of the traction sheave differ by no more than
    a factor e^(f alpha), from groove and wrap: beyond, the ropes slip and that factor determines the deceleration. Raises
    `InputError` for a brake that does not stop the car.
    """
    parts, gravity, up = lumped_hoist(drive, position), drive.shaft.gravity, 1.0 if velocity > 0.0 else -1.0
    hanging = drive.plant.car_mass - drive.plant.counterweight_mass
    hanging += drive.plant.rope_mass_per_length * (parts.car_rope - parts.counterweight_rope)
    helping = up * gravity * hanging  # the heavier side helps the brake while it goes up
    held = (torque / drive.plant.sheave_radius + helping) / moving_mass(drive)
    # Side 1 goes down and is pulled harder: T_1 = m_1 (g + a), T_2 = m_2 (g - a).
    first, second = (parts.car, parts.counterweight) if up < 0.0 else (parts.counterweight, parts.car)
    factor = exp(groove_friction(abs(velocity)) * WRAP)
    slipping = gravity * (factor * second - first) / (first + factor * second)
    found = min(held, slipping)
    if found < LEAST:
        what = "the hoist ropes slip, which holds" if slipping < held else f"brake = {torque:g} N m holds"
        raise InputError(f"{what} the car back by {found:.2f} m/s2 only: {LEAST:g} m/s2 or more is accepted")
    return Braking(found, slipping < held)


def groove_friction(speed: float) -> float:
    """Friction factor f of a rope in its groove at a speed [m/s]: EN 81-50, semi-circular groove with undercut."""
    mu = FRICTION / (1.0 + speed / FRICTION_SPEED)
    shape = 4.0 * (cos(0.5 * GROOVE) - sin(0.5 * UNDERCUT)) / (pi - UNDERCUT - GROOVE - sin(UNDERCUT) + sin(GROOVE))
    return mu * shape
