"""One instance of a model, from start values to the last step: which call is allowed when, and its saved states."""

import json
import struct
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any
from zlib import crc32

from ..errors import InputError, SimulationError
from . import validation
from .model_interface import Kind, ModelInterface, Role, Simulator, Value, Variable

_MAGIC = b"comprope run 2\n"
_HEAD = struct.Struct("<QQI")  # lengths of the two parts, and their checksum
INSTANTIATED, INITIALIZING, STEPPING, TERMINATED = range(4)  # phases of an instance


@dataclass(frozen=True)
class InstanceState:
    """The state of an instance apart from its simulator. Floats keep every bit: they are written with all digits needed."""

    model: str
    values: dict[str, Any]
    first_inputs: dict[str, Any]
    outputs: dict[str, Any]
    start: float
    stop: float | None
    time: float
    phase: int
    failure: str | None


def pack(state: InstanceState, simulator: bytes) -> bytes:
    """The state of instance and simulator as bytes, valid in any process that has the same FMU."""
    head = json.dumps(asdict(state)).encode()
    return _MAGIC + _HEAD.pack(len(head), len(simulator), crc32(head + simulator)) + head + simulator


def unpack(data: bytes, model: str) -> tuple[InstanceState, bytes]:
    """The states of instance and simulator; raises `InputError` for bytes that are not a state of `model`."""
    try:
        state, simulator = _parts(data)
    except (ValueError, TypeError, struct.error) as error:
        raise InputError(f"saved state: {len(data)} bytes that are not a whole state of this FMU") from error
    if state.model != model:
        raise InputError(f"saved state: made by {state.model}; only states of {model} are accepted")
    return state, simulator


def _parts(data: bytes) -> tuple[InstanceState, bytes]:
    if not data.startswith(_MAGIC):
        raise ValueError("no saved state")
    start = len(_MAGIC) + _HEAD.size
    head, simulator, checksum = _HEAD.unpack(data[len(_MAGIC) : start])
    if len(data) != start + head + simulator or crc32(data[start:]) != checksum:
        raise ValueError("wrong length or checksum")
    return InstanceState(**json.loads(data[start : start + head])), data[start + head :]


class Instance:
    """A model's values by reference (their index among its variables), and its simulator once created.

    Before the steps begin the simulator is created when an output is read, and again after a value has changed.
    A refused call raises `InputError` and changes nothing. While `failure` holds a sentence there are no steps and no
    outputs, so that not even an importer that ignores errors can take old values for new ones.
    """

    def __init__(self, interface: ModelInterface) -> None:
        self.interface = interface
        self.time = 0.0
        self.failure: str | None = None
        self._start = 0.0
        self._stop: float | None = None
        self._settable = interface.of_role("parameter") + interface.of_role("input")
        self._changeable = [one for one in self._settable if one.changeable]
        self._values: dict[str, Value] = {one.name: one.cast(one.start) for one in self._settable}
        self._first_inputs: dict[str, Value] = {}
        self._outputs: dict[str, Value] = {}
        self._simulator: Simulator | None = None
        self.phase = INSTANTIATED

    @property
    def _running(self) -> bool:
        """Whether initialization has ended."""
        return self.phase >= STEPPING

    @property
    def simulator(self) -> Simulator:
        """The model's simulator, created from the present values if there is none."""
        return self._ensure_simulator()

    def setup_experiment(self, start: float, stop: float | None) -> None:
        """Set the start time and, if there is one, the stop time [s]; refused once steps have begun."""
        if self._running:
            raise InputError("start and stop time are accepted only before the run begins")
        self._start = self.time = start
        self._stop = stop
        self._simulator = None

    def get_values(self, kind: Kind, refs: Sequence[int]) -> list[Value]:
        """Values by reference; all must be of one kind."""
        return [self._value(self._variable(kind, ref)) for ref in refs]

    def set_values(self, kind: Kind, refs: Sequence[int], values: Sequence[Any]) -> None:
        """Set values by reference, all or none."""
        pairs = [(self._variable(kind, ref), value) for ref, value in zip(refs, values, strict=True)]
        if problems := [text for one, value in pairs if (text := self._set_problem(one, value))]:
            raise InputError("; ".join(problems))
        changed = self._values | {one.name: one.cast(value) for one, value in pairs}
        if not self._running and changed != self._values:
            self._simulator = None
        self._values = changed

    def exit_initialization(self) -> None:
        """Fix the parameters and create the simulator; refuses invalid values, all problems in one sentence."""
        self._ensure_simulator()
        self.phase = STEPPING

    def do_step(self, time: float, dt: float) -> None:
        """Advance from `time` by `dt` [s]; raises `SimulationError` if the model fails or an output is not finite."""
        self.require_not_failed()
        if not self._running:
            raise InputError("a step is possible only after initialization has ended")
        if problem := validation.step_problem(time, dt, self.time, self._stop):
            raise InputError(problem)
        if problems := validation.range_problems(self._changeable, self._values):
            raise InputError("; ".join(problems))
        simulator = self._ensure_simulator()
        simulator.step(time, dt, {one.name: self._values[one.name] for one in self._changeable})
        self._outputs = self._checked_outputs(simulator)
        self.time = time + dt

    def save_state(self, model: str) -> bytes:
        """The whole state as bytes that only `model` accepts."""
        simulator = self._simulator.get_state() if self._running and self._simulator is not None else b""
        state = InstanceState(
            model=model,
            values=self._values,
            first_inputs=self._first_inputs,
            outputs=self._outputs,
            start=self._start,
            stop=self._stop,
            time=self.time,
            phase=self.phase,
            failure=self.failure,
        )
        return pack(state, simulator)

    def restore_state(self, data: bytes, model: str) -> None:
        """Return to a saved state, bit for bit."""
        state, simulator_state = unpack(data, model)
        simulator = self._simulator_in_state(state, simulator_state) if state.phase >= STEPPING else None
        self._values, self._first_inputs, self._outputs = state.values, state.first_inputs, state.outputs
        self._start, self._stop, self.time = state.start, state.stop, state.time
        self._simulator, self.phase, self.failure = simulator, state.phase, state.failure

    def require_not_failed(self) -> None:
        """Raise `InputError` after an error, unless reset or restored."""
        if self.failure:
            raise InputError(f"no steps and outputs after an error, unless reset or restored; the error was: {self.failure}")

    def _variable(self, kind: Kind, ref: int) -> Variable:
        variables = self.interface.variables
        if not 0 <= ref < len(variables) or variables[ref].kind != kind:
            raise InputError(f"value reference {ref}: not of type {kind}")
        return variables[ref]

    def _value(self, variable: Variable) -> Value:
        if variable.role != "output":
            return self._values[variable.name]
        self.require_not_failed()
        self._ensure_simulator()
        return self._outputs[variable.name]

    def _set_problem(self, variable: Variable, value: Any) -> str | None:
        if variable.role == "output":
            return f"output {variable.name} = {value}: an output cannot be set"
        if not variable.changeable and self._running:
            return f"parameter {variable.name} = {value}: fixed once the run has started; reset the FMU to change it"
        return validation.finite_problem(variable, value)

    def _ensure_simulator(self) -> Simulator:
        """The simulator, created from the present values if there is none."""
        if self._simulator is None:
            if problems := validation.range_problems(self._settable, self._values):
                raise InputError("; ".join(problems))
            inputs = self._of_role("input")
            simulator = self.interface.create(self._of_role("parameter"), inputs, self._start)
            self._outputs = self._checked_outputs(simulator)
            self._simulator, self._first_inputs = simulator, inputs
        return self._simulator

    def _simulator_in_state(self, state: InstanceState, simulator_state: bytes) -> Simulator:
        """A simulator in a saved state: the present one if that has the same parameters, else a new one."""
        parameters = self._of_role("parameter", state.values)
        same = self._running and parameters == self._of_role("parameter") and state.start == self._start
        simulator = self._simulator if same else None
        if simulator is None:
            simulator = self.interface.create(parameters, state.first_inputs, state.start)
        simulator.set_state(simulator_state)
        return simulator

    def _of_role(self, role: Role, values: Mapping[str, Value] | None = None) -> dict[str, Value]:
        source = self._values if values is None else values
        return {one.name: source[one.name] for one in self.interface.of_role(role)}

    def _checked_outputs(self, simulator: Simulator) -> dict[str, Value]:
        """The simulator's outputs; raises `SimulationError` unless all are finite."""
        raw = simulator.outputs()
        outputs = self.interface.of_role("output")
        values = {one.name: one.cast(raw[one.name]) for one in outputs}
        if bad := [f"{one.name} = {values[one.name]}" for one in outputs if validation.finite_problem(one, values[one.name])]:
            raise SimulationError(f"the model gave {', '.join(bad)}; the step is too large or the model unstable")
        return values
