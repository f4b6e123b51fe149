"""Lateral motion of what is fixed to the building beside the rope, in the frame of the building's base.

The building is known at the heights of the rope's ends, which move with it. Between axle and end it is taken as a straight line:
the share `shaft.walls_follow` of an end's motion, in proportion to the height above the axle.
"""

from ...kernels.jit import kernel
from ..parameters.parameter_vector import CAR_WALL, CAR_WALL_V, COUNTERWEIGHT_WALL, COUNTERWEIGHT_WALL_V, WALLS_FOLLOW, R
from .end_conditions import follow


@kernel
def set_wall_motion(p, path, dt, s):
    """Set displacement and velocity of the walls at the heights of both ends, at fraction s of a communication step."""
    share = p[WALLS_FOLLOW]
    if share == 0.0:
        return
    y, v, _ = follow(path, 1, dt, s)
    p[CAR_WALL], p[CAR_WALL_V] = share * (y + p[R]), share * v
    y, v, _ = follow(path, 3, dt, s)
    p[COUNTERWEIGHT_WALL], p[COUNTERWEIGHT_WALL_V] = share * (y - p[R]), share * v


@kernel
def clear_wall_motion(p):
    """The building at rest, as it counts outside of the time steps."""
    p[CAR_WALL], p[CAR_WALL_V], p[COUNTERWEIGHT_WALL], p[COUNTERWEIGHT_WALL_V] = 0.0, 0.0, 0.0, 0.0


@kernel
def wall_motion(n, q, i, walls):
    """Displacement [m] and velocity [m/s] of the wall beside node i, on the side where it is.

    `walls` are displacement and velocity at the car's end, then at the counterweight's.
    """
    car, car_v, counterweight, counterweight_v = walls
    on_car = q[n + 1 + i] < 0.0
    end = q[0] if on_car else q[n - 1]
    share = min(max((q[n] - q[i]) / (q[n] - end), 0.0), 1.0)
    return share * (car if on_car else counterweight), share * (car_v if on_car else counterweight_v)
