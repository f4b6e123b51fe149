"""What a model must offer to be simulated through FMI: named variables, and a simulator."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, Protocol

from ..quantities import Component, quantities

Kind = Literal["real", "integer", "boolean", "string"]
Role = Literal["parameter", "input", "output"]
Value = float | int | bool | str

TYPES: dict[str, type] = {"real": float, "integer": int, "boolean": bool, "string": str}


@dataclass(frozen=True)
class Variable:
    """One variable of a model, in SI units.

    A parameter is fixed once the steps have begun, unless it is `tunable`. Parameters and inputs have a start value.
    `depends_on` names, for an output, the inputs with direct feedthrough while stepping, and `initial_depends_on` those that it
    depends on at the start; None: any. `array` describes the array that it is an element of in FMI 3.0, if it is one (see
    `arrays`).
    """

    name: str
    kind: Kind
    role: Role
    help: str
    unit: str = "1"
    start: Value | None = None
    minimum: float | None = None
    maximum: float | None = None
    nominal: float | None = None
    depends_on: tuple[str, ...] = ()
    display_unit: str | None = None
    initial_depends_on: tuple[str, ...] | None = None
    tunable: bool = False
    array: str = ""

    @property
    def changeable(self) -> bool:
        """Whether it may be set between steps."""
        return self.role == "input" or self.tunable

    @property
    def variability(self) -> str:
        """Variability as defined by FMI."""
        if self.role == "parameter":
            return "tunable" if self.tunable else "fixed"
        return "continuous" if self.kind == "real" else "discrete"

    def cast(self, value: Any) -> Value:
        """The value as the Python type of this variable."""
        return TYPES[self.kind](value)


class Simulator(Protocol):
    """Simulation of a model with given parameters; it owns the whole state."""

    def step(self, time: float, dt: float, inputs: Mapping[str, Any]) -> None:
        """Advance from `time` to `time + dt` [s]; raises a `CompropeError` that says what, where and when.

        `inputs` has the tunable parameters as well.
        """

    def outputs(self) -> Mapping[str, Any]:
        """Every output by name, at the time reached."""

    def get_state(self) -> bytes:
        """The whole state, for a bitwise equal restart in any process."""

    def set_state(self, state: bytes) -> None:
        """Restore a state of `get_state` of a simulator with the same parameters."""


@dataclass(frozen=True)
class Terminal:
    """Variables that are connected together; each belongs to that of the same name in the terminal of another model."""

    name: str
    help: str
    members: tuple[str, ...]


@dataclass(frozen=True)
class ModelInterface:
    """A model as slave, package and documentation need it.

    `create(parameters, inputs, start_time)` makes a simulator from values by name; it raises
    `InputError` with one sentence that holds all problems, joined by "; ".
    `stop_time` and `step_size` [s] are the defaults for an importer. `pictures` are SVG files that show what the
    variables are, `icon` is a name of `icon.py`. `reference_inputs(time)` gives real inputs by name for the simulation of
    4 s whose result is kept as a reference; other inputs hold their start values. FMI 3.0 has the `terminals`.
    """

    name: str
    description: str
    variables: tuple[Variable, ...]
    create: Callable[[Mapping[str, Any], Mapping[str, Any], float], Simulator]
    stop_time: float = 10.0
    step_size: float = 0.001
    pictures: tuple[Path, ...] = ()
    reference_inputs: Callable[[float], Mapping[str, float]] = lambda _time: {}
    terminals: tuple[Terminal, ...] = ()
    icon: str = "sheave"

    def of_role(self, role: Role) -> tuple[Variable, ...]:
        """The variables of one role, in their order."""
        return tuple(variable for variable in self.variables if variable.role == role)


def parameters_of(
    prefix: str, component: type[Component], values: Mapping[str, float], tunable: Collection[str] = ()
) -> tuple[Variable, ...]:
    """The declared quantities of a component as parameters `prefix.name`.

    `values` gives start values by quantity name; others start at their neutral values. `tunable` are full names.
    """
    return tuple(
        Variable(
            name=f"{prefix}.{one.name}",
            kind="real",
            role="parameter",
            help=one.help,
            unit=one.unit,
            start=float(values.get(one.name, one.neutral)),
            minimum=one.minimum,
            maximum=one.maximum,
            nominal=one.nominal,
            tunable=f"{prefix}.{one.name}" in tunable,
        )
        for one in quantities(component)
    )
