"""Air drag on the rope, in still air or in a lateral flow caused by the car.

Per length, f = -1/2 rho_air C_d d |v_n| v_n, where v_n is the part of the relative velocity normal to
the rope (cross-flow principle, Hoerner 1965). Along the rope there is none. `shaft_airflow` blows
outward on both sides at a fraction of the car's velocity; it needs the drag coefficient to act.
"""

from math import copysign
from typing import ClassVar

from ....kernels.jit import kernel
from ....quantities import quantity
from ...parameters.parameter_vector import DIAMETER, ELEMENT, slot
from ...runtime.array_layout import DXX, DXY, DYY, TX, TY
from ..base import Effect, acts, register


class AirDrag(Effect):
    """Air drag normal to the rope."""

    name = "air_drag"
    proportional = True
    drag_coefficient: float = quantity("1", "drag coefficient of the rope across the flow", 0.0, 1000.0, nominal=1.1, off=0.0)
    air_density: float = quantity("kg/m3", "density of the air", 0.1, 5.0, default=1.2)


class ShaftAirflow(Effect):
    """Lateral air flow in the shaft, driven by the car."""

    name = "shaft_airflow"
    proportional = True
    probes: ClassVar[dict[str, tuple[float, ...]]] = {"crossflow_ratio": (0.3, -0.3)}
    brings: ClassVar[dict[str, float]] = {"effects.air_drag.drag_coefficient": 1.1}
    crossflow_ratio: float = quantity(
        "1", "outward lateral air velocity on both sides over the car's velocity (up positive)", -2.0, 2.0, nominal=0.3, off=0.0
    )


register(AirDrag)
register(ShaftAirflow)
CD = slot("effects.air_drag.drag_coefficient")
DENSITY = slot("effects.air_drag.air_density")
CROSSFLOW = slot("effects.shaft_airflow.crossflow_ratio")


@kernel
def normal_velocity(n, p, v, w, y, i):
    """Normal of the rope at node i and its velocity along that normal, relative to the air."""
    m = n + 1
    wind = p[CROSSFLOW] * copysign(1.0, y) * -v[0]
    nx, ny = -0.5 * (w[TY * m + i - 1] + w[TY * m + i]), 0.5 * (w[TX * m + i - 1] + w[TX * m + i])
    return nx, ny, nx * v[i] + ny * (v[m + i] - wind)


@kernel
def drag(n, t, p, q, v, w, f):
    """Add the drag of every inner node."""
    if p[CD] == 0.0:
        return 0.0
    m, k, power = n + 1, 0.5 * p[DENSITY] * p[CD] * p[DIAMETER] * p[ELEMENT], 0.0
    for i in range(1, n - 1):
        nx, ny, u = normal_velocity(n, p, v, w, q[m + i], i)
        push = -k * abs(u) * u
        f[i] += push * nx
        f[m + i] += push * ny
        power += push * (nx * v[i] + ny * v[m + i])
    return power


@kernel
def drag_tangent(n, t, p, q, v, w, A, weights):
    """Damping 2 k |v_n| n n' of every inner node."""
    if p[CD] == 0.0:
        return
    m, k, cc = n + 1, 0.5 * p[DENSITY] * p[CD] * p[DIAMETER] * p[ELEMENT], weights.cc
    for i in range(1, n - 1):
        nx, ny, u = normal_velocity(n, p, v, w, q[m + i], i)
        damping = 2.0 * cc * k * abs(u)
        A[DXX * m + i] += damping * nx * nx
        A[DXY * m + i] += damping * nx * ny
        A[DYY * m + i] += damping * ny * ny


acts(AirDrag, forces=drag, tangents=drag_tangent)
