"""The drive's parameters as one vector, in the order of their declaration, which is that of the FMU's parameters."""

from ...quantities import quantities
from ..parameters import Drive

NAMES = tuple(
    f"{component}.{one.name}" for component in Drive.model_fields for one in quantities(type(getattr(Drive(), component)))
)


def slot(name: str) -> int:
    """Index of a parameter in the vector."""
    return NAMES.index(name)


def vector(drive: Drive) -> list[float]:
    """The parameters of a drive."""
    values = {f"{part}.{name}": value for part, table in drive.model_dump().items() for name, value in table.items()}
    return [float(values[name]) for name in NAMES]


HEIGHT = slot("shaft.height")
GRAVITY = slot("shaft.gravity")
SPEED_LIMIT = slot("profile.speed")
ACCELERATION_LIMIT = slot("profile.acceleration")
JERK_LIMIT = slot("profile.jerk")
SMOOTHING_TIME = slot("profile.smoothing")
SHARES = slot("curve.a1")
IMPULSE_COUNT = slot("shaper.impulses")
PERIOD_LANDING = slot("shaper.period_landing")
PERIOD_MIDDLE = slot("shaper.period_middle")
SHAPER_DAMPING = slot("shaper.damping")
TOLERANCE = slot("shaper.tolerance")
START_POSITION = slot("trip.start_position")
FIRST_DESTINATION = slot("trip.destination")
FIRST_START = slot("trip.start_time")
OVERRUN = slot("trip.overrun")
CAR_MASS = slot("plant.car_mass")
COUNTERWEIGHT_MASS = slot("plant.counterweight_mass")
RADIUS = slot("plant.sheave_radius")
INERTIA = slot("plant.machine_inertia")
HEADROOM = slot("plant.headroom")
ROPE_MASS = slot("plant.rope_mass_per_length")
STIFFNESS = slot("plant.rope_stiffness")
DAMPING = slot("plant.rope_damping")
ROPES = slot("rope.count")
POSITION_BANDWIDTH = slot("servo.position_bandwidth")
SPEED_BANDWIDTH = slot("servo.speed_bandwidth")
SPEED_DAMPING = slot("servo.speed_damping")
TORQUE_LIMIT = slot("servo.torque_limit")
SAMPLE_PERIOD = slot("servo.sample_period")
VELOCITY_FEEDFORWARD = slot("servo.velocity_feedforward")
ACCELERATION_FEEDFORWARD = slot("servo.acceleration_feedforward")
BRAKE_TORQUE = slot("brake.torque")
BRAKE_RISE = slot("brake.rise_time")
GEAR_DECELERATION = slot("safety_gear.deceleration")
GEAR_UPWARD = slot("safety_gear.upward_share")
GEAR_RISE = slot("safety_gear.rise_time")
BUFFER_STIFFNESS = slot("buffer.stiffness")
BUFFER_DECELERATION = slot("buffer.deceleration")
BUFFER_CLEARANCE = slot("buffer.clearance")
FRICTION = slot("traction.friction")
WRAP = slot("traction.wrap")
UNDERCUT = slot("traction.undercut")
GROOVE = slot("traction.groove")
