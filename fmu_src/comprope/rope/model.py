"""The rope as an object: settle it, move its ends, read what a sensor sees."""

from collections.abc import Mapping
from math import ceil, pi
from typing import Any

import numpy as np

from ..declare import quantities
from ..errors import InputError, SimulationError
from . import ledger, work
from .bound import Bound
from .effects.base import REGISTRY
from .ends import PATH, PATHS
from .newmark import DEEPEST, HALVED, NEWTON, STEPS, WORST
from .parameters import Base
from .slots import COMPONENTS, vector
from .state import Array, State

SIDES = {"car": -1, "counterweight": 1}
FEWEST = 16  # elements


def values_of(model: Base) -> dict[str, float]:
    """Every number of a model by its name in the model file, effects included."""
    parts: dict[str, Any] = {name: getattr(model, name) for name in COMPONENTS}
    effects = getattr(model, "effects", None)
    parts |= {f"effects.{name}": part for name in REGISTRY if (part := getattr(effects, name, None)) is not None}
    return {f"{name}.{one.name}": getattr(part, one.name) for name, part in parts.items() for one in quantities(type(part))}


class CompensationRope:
    """One rope on its sheave.

    `settle` puts it at rest; `step` moves its ends along smooth paths; outputs are read between steps.
    Heights are metres above the bottom landing, up positive; lateral displacements are outward.
    """

    def __init__(self, model: Base) -> None:
        self.model = model
        self.n = max(round(model.rope_length / model.rope.element_length), FEWEST) + 1
        self.element = model.rope_length / (self.n - 1)
        self.p = np.array(vector(values_of(model) | {"derived.element": self.element}))
        self._do = Bound(self.n, self.p)

    @property
    def state(self) -> State:
        """The present state; overwrite it by `State.from_bytes`."""
        return self._do.state

    # -- at rest ---------------------------------------------------------------------------------

    def settle(self, car: float, counterweight: float, outward: tuple[float, float] = (0.0, 0.0), time: float = 0.0) -> None:
        """Hang the rope at rest with its ends at the heights `car`, `counterweight` [m].

        `outward` are lateral displacements of the two ends [m]. Raises InputError when the rope cannot
        reach, SimulationError when no shape at rest is found.
        """
        self.check_reach(car, counterweight, time)
        s = self._do.renew(time)
        s.q[:] = self._guess(car, counterweight)
        self._do.path[:] = still(car, counterweight, outward, self.model.sheave.radius)
        self._do.place(t=time, dt=1.0, s=0.0)
        s.v[:] = 0.0
        s.a[:] = 0.0
        if self._do.hang(element=self.element) < 0.0:
            raise SimulationError(
                f"no shape at rest was found with car end at {car:g} m, counterweight end at {counterweight:g} m "
                f"and sheave.mass = {self.model.sheave.mass:g} kg"
            )
        self._evaluate()
        self._do.begin()
        self._evaluate()
        s.f[:] = self._do.f
        self._do.open_ledger()

    def check_reach(self, car: float, counterweight: float, time: float) -> None:
        """Refuse ends [m] between which the rope cannot hang; raises InputError."""
        m = self.model
        lowest = 0.5 * (car + counterweight - (m.rope_length - pi * m.sheave.radius))
        if min(car, counterweight) - lowest < m.sheave.radius:
            raise InputError(
                f"car_position = {car:g} m with counterweight_position = {counterweight:g} m at t = {time:g} s: the rope of "
                f"{m.rope_length:g} m would hang the axle at {lowest:g} m; both ends at least sheave.radius = "
                f"{m.sheave.radius:g} m above it are accepted"
            )

    def _guess(self, car: float, counterweight: float) -> Array:
        """Straight sides and a half circle that hold the natural length."""
        n, R = self.n, self.model.sheave.radius
        axle = 0.5 * (self.model.rope_length - pi * R - car - counterweight)
        s = np.arange(n) * self.element
        left = car + axle
        angle = np.clip((s - left) / R, 0.0, pi)
        x = np.where(s < left, s - car, axle + R * np.sin(angle))
        right = s > left + pi * R
        x[right] = axle - (s[right] - left - pi * R)
        return np.concatenate([x, [axle], -R * np.cos(angle), [0.0]])

    # -- in motion -------------------------------------------------------------------------------

    def step(self, dt: float, path: Array) -> None:
        """Advance by dt [s] while the ends follow `path` (see `ends`; PATHS * PATH numbers).

        Raises SimulationError where a time step could not be saved by halving it; the rope then stands
        at the last accepted one.
        """
        time = float(self.state.time[0])
        steps = max(1, ceil(dt / self.model.solver.step * (1.0 - 1e-9)))
        self._do.path[:] = path
        reached = self._do.advance(t0=time, dt=dt, steps=steps)
        if reached < 1.0:
            raise SimulationError(self._where(time + reached * dt, dt / steps))
        self.state.time[0] = time + dt

    def _where(self, time: float, step: float) -> str:
        worst = int(self.state.count[WORST]) % (self.n + 1)
        place = "the sheave" if worst == self.n else f"{worst * self.element:.2f} m along the rope from the car"
        return (
            f"the time step at t = {time:.6f} s did not converge even when halved to {step / 2**DEEPEST:.1e} s; "
            f"worst at {place}, height {-self.state.q[worst]:.3f} m"
        )

    def _evaluate(self) -> None:
        """Forces and workspace at the present state."""
        self._do.evaluate(t=float(self.state.time[0]), ck=0.0, cc=0.0, tangent=False)

    # -- what it shows ---------------------------------------------------------------------------

    def lateral_displacement(self, side: str, height: float) -> tuple[float, bool]:
        """Outward displacement [m] at a height on a side, and whether the rope is there.

        Where the rope's end, or its lowest point, has passed the height, the value is that of the end
        or of the lowest point.
        """
        self._do.sight(side=SIDES[side], x=-height)
        y, seen = self._do.seen
        return SIDES[side] * float(y) - self.model.sheave.radius, bool(seen)

    def maximum(self, side: str) -> tuple[float, float]:
        """Largest outward displacement [m] on a side above the axle, and its height [m]."""
        self._do.side_maximum(side=SIDES[side])
        y, x = self._do.seen
        return float(y) - self.model.sheave.radius, -float(x)

    def outputs(self) -> Mapping[str, float]:
        """Forces and motions of sheave and ends, in SI units, up positive."""
        self._evaluate()
        self._do.hold()
        return {
            "sheave_force": -float(self._do.touch[work.FORCE_X]),
            **self.sheave(),
            "car_end_tension": -float(self._do.P[0]),
            "counterweight_end_tension": -float(self._do.P[2]),
        }

    def sheave(self) -> dict[str, float]:
        """Motion of the sheave, in SI units, up positive; the angle is positive while the car goes up."""
        n, q, v = self.n, self.state.q, self.state.v
        return {
            "sheave_displacement": self.model.shaft.pit - float(q[n]),
            "sheave_velocity": -float(v[n]),
            "sheave_angle": float(q[2 * n + 1]),
            "sheave_angular_velocity": float(v[2 * n + 1]),
        }

    def energies(self) -> dict[str, float]:
        """The ledger [J]: stored energies, works and losses by name."""
        names = [*ledger.STORED, "ends", *ledger.SPENT, *(f"effects.{name}" for name in REGISTRY)]
        return dict(zip(names, self.state.energy.tolist(), strict=True))

    @property
    def energy_residual(self) -> float:
        """Stored energy less its start, less work put in, plus losses [J]; zero for an exact run."""
        e, stored, spent = self.state.energy, len(ledger.STORED), len(ledger.SPENT)
        losses = e[ledger.LOSSES : ledger.LOSSES + spent].sum()
        return float(e[:stored].sum() - self.state.start[0] - e[ledger.ENDS_WORK] + losses - e[ledger.EFFECTS :].sum())

    @property
    def count(self) -> dict[str, int]:
        """Time steps, Newton iterations and halvings so far."""
        return {name: int(self.state.count[k]) for name, k in (("steps", STEPS), ("newton", NEWTON), ("halved", HALVED))}


def still(car: float, counterweight: float, outward: tuple[float, float], radius: float) -> Array:
    """A path on which the ends stay where they are."""
    path = np.zeros((PATHS, PATH))
    path[:, 0] = path[:, 3] = (-car, -radius - outward[0], -counterweight, radius + outward[1])
    return path.ravel()
