"""The rope as an object: static equilibrium, time steps, sensors and outputs."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...errors import SimulationError
from ...quantities import quantities
from ..compiler.entry_points import compiled
from ..compiler.workspace import RopeWorkspace
from ..effects import REGISTRY, names_of
from ..integration.inputs import CAR, CAR_OUT, COUNTERWEIGHT, COUNTERWEIGHT_OUT
from ..integration.newmark import HALVED, NEWTON, STEPS
from ..integration.outputs import OUTPUTS
from ..mechanics import energy
from ..parameters import Base
from ..parameters.parameter_vector import COMPONENTS, ELEMENT, vector
from ..runtime.kernel_arguments import Array, RopeData, State
from ..runtime.status import require_success

SIDES = {"car": -1, "counterweight": 1}
FORCES_AND_MOTIONS = OUTPUTS[: OUTPUTS.index("car_side_max_displacement")]  # what `outputs` gives


def values_of(model: Base) -> dict[str, float]:
    """Every number of a model by its name in the model file, effects included."""
    parts: dict[str, Any] = {name: getattr(model, name) for name in COMPONENTS}
    effects = getattr(model, "effects", None)
    parts |= {f"effects.{name}": part for name in REGISTRY if (part := getattr(effects, name, None)) is not None}
    return {f"{name}.{one.name}": getattr(part, one.name) for name, part in parts.items() for one in quantities(type(part))}


class CompensationRope:
    """One rope on its sheave.

    `solve_equilibrium` brings it to rest; `step` moves its ends along smooth paths; outputs are read between steps.
    Heights are metres above the bottom landing, up positive; lateral displacements are outward.
    """

    def __init__(self, model: Base) -> None:
        self.model = model
        self.p = np.array(vector(values_of(model)))
        effects = names_of(model)
        self.n = int(compiled(effects)["generate_mesh"].bind(RopeData(0, 0, 0, self.p, self.p))())
        self.element = float(self.p[ELEMENT])
        sensors = [(sensor.height, sensor.side == "counterweight") for sensor in model.sensors]
        self.workspace = RopeWorkspace(self.n, self.p, np.array(sensors, float).ravel(), effects)

    @property
    def state(self) -> State:
        """The present state; overwrite it by `State.from_bytes`."""
        return self.workspace.state

    # -- at rest ---------------------------------------------------------------------------------

    def solve_equilibrium(
        self, car: float, counterweight: float, outward: tuple[float, float] = (0.0, 0.0), time: float = 0.0
    ) -> None:
        """Bring the rope to static equilibrium with its ends at the heights `car`, `counterweight` [m].

        `outward` are lateral displacements of the two ends [m]. Raises InputError when the rope cannot
        reach, SimulationError when no shape at rest is found.
        """
        self.check_reach(car, counterweight, time)
        self.workspace.ends.u[[CAR_OUT, COUNTERWEIGHT_OUT]] = outward
        self.workspace.clear_state(time)
        self.require_success(self.workspace.start_at_rest(t=time))

    def check_reach(self, car: float, counterweight: float, time: float) -> None:
        """Raise `InputError` for positions of the ends [m] that the rope cannot have."""
        self.workspace.ends.u[[CAR, COUNTERWEIGHT]] = car, counterweight
        require_success(self.workspace.check_reach(t=time), self.workspace.work.message)

    def check_start(self, car: float, counterweight: float, time: float) -> None:
        """Raise `InputError` for positions of the ends [m] at the start that do not fit the shaft."""
        self.check_reach(car, counterweight, time)
        require_success(self.workspace.check_start(), self.workspace.work.message)

    # -- in motion -------------------------------------------------------------------------------

    def step(self, dt: float, path: Array, base: tuple[float, float] = (0.0, 0.0)) -> None:
        """Advance by dt [s] while the ends follow `path` (see `end_conditions`; PATHS * PATH numbers).

        `base` is the acceleration of the building's base towards the counterweight's side [m/s2] at the start and at the end.
        Raises SimulationError where a time step did not converge even when halved; the state is then that
        of the last accepted one.
        """
        self.workspace.ends.path[:] = path
        self.workspace.ends.base[:] = base
        self.require_success(self.workspace.advance(dt=dt))

    def require_success(self, status: float) -> None:
        """Raise the error that a kernel's status stands for, and name a user's own effect whose forces are not finite."""
        try:
            require_success(status, self.workspace.work.message)
        except SimulationError as error:
            power = self.workspace.work.power
            lost = [REGISTRY[name] for k, name in enumerate(self.workspace.effects) if not np.isfinite(power[k])]
            own = [f"{one.name} ({one.source})" for one in lost if one.source]
            raise SimulationError(f"{error}; not finite are the forces of {', '.join(own)}" if own else str(error)) from None

    # -- outputs ---------------------------------------------------------------------------------

    def lateral_displacement(self, side: str, height: float) -> tuple[float, bool]:
        """Outward displacement [m] at a height on a side, and whether the rope is there.

        Where the rope's end, or its lowest point, has passed the height, the value is that of the end
        or of the lowest point.
        """
        self.workspace.read_displacement(side=SIDES[side], x=-height)
        y, in_view = self.workspace.outputs.reading
        return SIDES[side] * float(y) - self.model.sheave.radius, bool(in_view)

    def maximum(self, side: str) -> tuple[float, float]:
        """Largest outward displacement [m] on a side above the axle, and its height [m]."""
        self.workspace.read_side_maximum(side=SIDES[side])
        y, x = self.workspace.outputs.reading
        return float(y) - self.model.sheave.radius, -float(x)

    def outputs(self) -> Mapping[str, float]:
        """Forces and motions of sheave and ends, in SI units, up positive."""
        self.workspace.evaluate_outputs(sensors=0)
        return dict(zip(FORCES_AND_MOTIONS, self.workspace.outputs.y.tolist(), strict=False))

    def all_outputs(self) -> dict[str, float]:
        """Sensors and outputs, by the names of the FMU's outputs."""
        sensors = len(self.model.sensors)
        self.workspace.evaluate_outputs(sensors=sensors)
        names = [f"{name}[{k}]" for k in range(1, sensors + 1) for name in ("lateral_displacement", "in_view")]
        return dict(zip([*names, *OUTPUTS], self.workspace.outputs.y.tolist(), strict=True))

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
        """The energy balance [J]: stored energies, works and losses by name."""
        names = [*energy.STORED, "ends", *energy.SPENT, *(f"effects.{name}" for name in self.workspace.effects)]
        return dict(zip(names, self.state.energy.tolist(), strict=True))

    @property
    def energy_residual(self) -> float:
        """Stored energy less its start, less work put in, plus losses [J]; zero for an exact run."""
        return float(self.workspace.energy_residual())

    @property
    def count(self) -> dict[str, int]:
        """Time steps, Newton iterations and halvings so far."""
        return {name: int(self.state.counters[k]) for name, k in (("steps", STEPS), ("newton", NEWTON), ("halved", HALVED))}
