"""Parameters of an elevator drive, each declared once.

The defaults are a 50 m test tower at 150 m/min (2.5 m/s) and 0.8 m/s2, machine above the shaft,
ropes 1:1, and two compensation ropes that weigh as much per metre as all hoist ropes together.
"""

from math import pi

from pydantic import model_validator

from ...kernels.kernel_linking import uncompiled
from ...kernels.status import MESSAGE_VALUES, SUCCESS, sentence
from ...quantities import Component, quantity
from ..status import COMPONENT_TEXTS, MESSAGES
from . import parameter_checks
from .parameter_checks import INTERVALS

_CHECKS = uncompiled(parameter_checks)


def _require(check: str, *values: object) -> None:
    """Raise `ValueError` with the sentence of a check of `parameter_checks` that these values fail."""
    message = [0.0] * MESSAGE_VALUES
    status = getattr(_CHECKS, check)(*values, message)
    if status != SUCCESS:
        text = sentence(MESSAGES, status, message)
        raise ValueError(text.removeprefix(f"{COMPONENT_TEXTS[status][0]}: ") if status in COMPONENT_TEXTS else text)


class Profile(Component):
    """Limits of the jerk-limited trips."""

    speed: float = quantity("m/s", "rated speed", 0.01, 25.0, default=2.5)
    acceleration: float = quantity("m/s2", "largest acceleration and deceleration", 0.01, 3.0, default=0.8)
    jerk: float = quantity("m/s3", "largest rate of change of acceleration", 0.01, 20.0, default=0.8)
    smoothing: float = quantity("s", "moving average over the trip, for a continuous jerk; 0: none", 0.0, 20.0, default=0.0)

    @model_validator(mode="after")
    def _smoothing_is_not_too_short(self) -> "Profile":
        _require("check_smoothing", self.smoothing)
        return self


def _acceleration_share(k: int) -> float:
    help = f"acceleration after {k}/{INTERVALS} of the travel time, relative to the largest; all 0: jerk-limited trips"
    share: float = quantity("1", help, -1.0, 1.0, default=0.0)
    return share


class Curve(Component):
    """Free-form trips: accelerations at twentieths of the travel time, linear in between, 0 at both ends."""

    a1: float = _acceleration_share(1)
    a2: float = _acceleration_share(2)
    a3: float = _acceleration_share(3)
    a4: float = _acceleration_share(4)
    a5: float = _acceleration_share(5)
    a6: float = _acceleration_share(6)
    a7: float = _acceleration_share(7)
    a8: float = _acceleration_share(8)
    a9: float = _acceleration_share(9)
    a10: float = _acceleration_share(10)
    a11: float = _acceleration_share(11)
    a12: float = _acceleration_share(12)
    a13: float = _acceleration_share(13)
    a14: float = _acceleration_share(14)
    a15: float = _acceleration_share(15)
    a16: float = _acceleration_share(16)
    a17: float = _acceleration_share(17)
    a18: float = _acceleration_share(18)
    a19: float = _acceleration_share(19)

    @property
    def used(self) -> bool:
        """Whether there is a shape."""
        return any(getattr(self, name) for name in type(self).model_fields)

    @model_validator(mode="after")
    def _moves_forward_and_stops(self) -> "Curve":
        _require("check_curve", [getattr(self, name) for name in type(self).model_fields], 0)
        return self


class Shaper(Component):
    """Input shaper of the trips, for the longest natural period of the compensation rope."""

    impulses: float = quantity("1", "1: no shaper, 2: ZV, 3: ZVD, or EI with a tolerance", 1.0, 3.0, default=1.0)
    period_landing: float = quantity("s", "design period for trips near a terminal landing", 0.1, 60.0, default=4.0)
    period_middle: float = quantity("s", "the same for trips about mid-height; linear in between", 0.1, 60.0, default=3.0)
    damping: float = quantity("1", "damping ratio of this mode", 0.0, 0.5, default=0.0, nominal=0.01)
    tolerance: float = quantity("1", "residual vibration of a shaper of three impulses (EI), relative", 0.0, 0.5, default=0.0)

    @model_validator(mode="after")
    def _impulses_are_whole(self) -> "Shaper":
        _require("check_impulses", self.impulses)
        return self


class FirstTrip(Component):
    """Initial position of the car and its first trip; heights above the bottom landing."""

    start_position: float = quantity("m", "car height at the start", 0.0, 1000.0, default=0.0, nominal=10.0)
    destination: float = quantity("m", "car height at the end of the first trip", 0.0, 1000.0, default=50.0)
    start_time: float = quantity("s", "start of the first trip, not before that of the simulation", 0.0, 1e6, default=1.0)
    overrun: float = quantity("m", "way of a drive that fails to stop beyond the first destination", 0.0, 1000.0, default=0.0)


class Shaft(Component):
    """The building; heights count from the bottom landing, up positive."""

    height: float = quantity("m", "travel from bottom to top landing", 1.0, 1000.0, default=50.0)
    gravity: float = quantity("m/s2", "acceleration of gravity", 1.0, 30.0, default=9.81)


class CompensationRopes(Component):
    """Number of compensation ropes that act on car and counterweight."""

    count: float = quantity("1", "number of compensation ropes; the end tensions are per rope", 0.0, 50.0, default=2.0)


class Plant(Component):
    """Masses and hoist ropes; machine above the top landing, 1:1 roping."""

    car_mass: float = quantity("kg", "mass of the car with its load", 50.0, 1e5, default=2000.0)
    counterweight_mass: float = quantity("kg", "mass of the counterweight", 50.0, 1e5, default=2300.0)
    sheave_radius: float = quantity("m", "radius of the traction sheave to the ropes' centre line", 0.05, 2.0, default=0.25)
    machine_inertia: float = quantity("kg.m2", "moment of inertia of motor and traction sheave", 0.01, 1e5, default=30.0)
    headroom: float = quantity("m", "hoist rope length from traction sheave to a car at the top landing", 0.5, 50.0, default=4.0)
    rope_mass_per_length: float = quantity("kg/m", "mass per length of all hoist ropes together", 0.0, 100.0, default=2.4)
    rope_stiffness: float = quantity("N", "axial stiffness EA of all hoist ropes together", 1e5, 1e10, default=3e7)
    rope_damping: float = quantity("N.s", "axial force of all hoist ropes per strain rate", 0.0, 1e8, default=6e4)


class Servo(Component):
    """Cascade of position and speed control on the motor's encoder."""

    position_bandwidth: float = quantity("rad/s", "gain of the position loop", 0.1, 50.0, default=3.0)
    speed_bandwidth: float = quantity("rad/s", "natural frequency of the speed loop on rigid ropes", 0.5, 200.0, default=12.0)
    speed_damping: float = quantity("1", "damping ratio of the speed loop on rigid ropes", 0.2, 5.0, default=1.0)
    torque_limit: float = quantity("N.m", "largest torque of the motor", 1.0, 1e7, default=5000.0)
    sample_period: float = quantity("s", "sample period of the controller", 1e-4, 0.02, default=1e-3)
    velocity_feedforward: float = quantity("1", "fraction of the reference velocity that is fed forward", 0.0, 1.5, default=1.0)
    acceleration_feedforward: float = quantity("1", "fraction of the inertia force that is fed forward", 0.0, 1.5, default=1.0)


class Brake(Component):
    """Brake of the machine: friction at the traction sheave, with the motor off."""

    torque: float = quantity("N.m", "torque of the brake, fully applied", 0.0, 1e7, default=2500.0)
    rise_time: float = quantity("s", "time in which it takes hold", 0.0, 5.0, default=0.04)


class SafetyGear(Component):
    """Safety gear of the car: friction on its guide rails."""

    deceleration: float = quantity("m/s2", "deceleration of the mass of the car that hangs on nothing", 0.1, 100.0, default=15.0)
    upward_share: float = quantity(
        "1", "force against upward over that against downward motion; 0: lifting the car releases it", 0.0, 1.0, default=0.0
    )
    rise_time: float = quantity("s", "time in which it takes hold", 0.0, 5.0, default=0.04)


class Buffer(Component):
    """Buffers below car and counterweight; without stiffness and deceleration there are none."""

    stiffness: float = quantity("N/m", "stiffness of a spring buffer", 0.0, 1e8, default=0.0, nominal=1e5)
    deceleration: float = quantity(
        "m/s2", "deceleration by a hydraulic buffer of what hangs on nothing", 0.0, 100.0, default=0.0, nominal=10.0
    )
    clearance: float = quantity("m", "from car or counterweight at the bottom landing down to the buffer", 0.0, 10.0, default=0.1)


class Traction(Component):
    """Friction of the hoist ropes on the traction sheave, which limits what a brake can hold: EN 81-50."""

    friction: float = quantity("1", "friction coefficient at rest; half as large at 10 m/s", 0.0, 2.0, default=0.1)
    wrap: float = quantity("rad", "angle of wrap", 0.0, 12.0, default=pi)
    undercut: float = quantity("rad", "angle of the groove's undercut", 0.0, 1.85, default=0.5 * pi)
    groove: float = quantity("rad", "angle of the groove", 0.0, 1.05, default=pi / 6.0)


class Drive(Component):
    """All parameters of a drive."""

    shaft: Shaft = Shaft()
    profile: Profile = Profile()
    curve: Curve = Curve()
    shaper: Shaper = Shaper()
    trip: FirstTrip = FirstTrip()
    plant: Plant = Plant()
    rope: CompensationRopes = CompensationRopes()
    servo: Servo = Servo()
    brake: Brake = Brake()
    safety_gear: SafetyGear = SafetyGear()
    buffer: Buffer = Buffer()
    traction: Traction = Traction()

    @property
    def without_trips(self) -> "Drive":
        """Shaft, plant and servo only: the parameters that the closed loop depends on."""
        return Drive(shaft=self.shaft, plant=self.plant, servo=self.servo, trip=FirstTrip(destination=0.0))

    @model_validator(mode="after")
    def _stops_inside_the_shaft(self) -> "Drive":
        _require("check_stops", self.trip.start_position, self.trip.destination, self.shaft.height)
        return self
