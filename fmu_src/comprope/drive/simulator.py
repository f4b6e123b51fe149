"""Time simulation of the drive in Python: the kernels that the native FMU has, with a design by python-control."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from ..errors import InputError
from ..kernels.status import MESSAGE_VALUES, SUCCESS, require_success, sentence
from .control.scheduled_plant import scheduled_plant
from .control.servo_control import design_servo
from .control.stability_margins import unstable_positions
from .kernels.arguments import (
    CLOCK,
    EMERGENCY,
    FEEDFORWARD,
    GAIN,
    GAINS,
    INPUT_GAIN,
    MATRIX,
    OUTPUT_GAIN,
    RATES,
    REALS,
    ROW,
    SERVO,
    TRIP,
    Design,
    Inputs,
    Outputs,
    Parameters,
    State,
    Workspace,
)
from .kernels.checks import INPUT_CHECKS, START_CHECK, TORQUE_CHECK
from .kernels.entry_points import compiled
from .kernels.parameter_vector import vector
from .parameters import Drive
from .status import MESSAGES, UNSTABLE
from .variables import FLAGS, INPUTS, REAL_OUTPUTS

_MARK = b"drive 3\0"


class DriveSimulator:
    """Simulator of one drive, initially at rest; inputs and outputs as in `cosimulation.interface`."""

    def __init__(self, drive: Drive, inputs: Mapping[str, Any], start_time: float) -> None:
        """Equilibrium at `start_time` [s], the motor holding car and counterweight against the tensions in `inputs`.

        Raises `InputError` with all problems: inputs or times that are impossible, a motor too weak, unstable gains.
        """
        self._inputs, self._work = Inputs(np.zeros(len(INPUTS))), empty_workspace()
        self._state, self._outputs = empty_state(), Outputs(np.zeros(REALS + len(FLAGS)))
        self._parameters = Parameters(np.array(vector(drive)))
        memory = (self._parameters, self._inputs, self._state, self._work, self._outputs)
        self._check = compiled()["check"].bind(*memory)
        self._read(inputs)
        self._require((*range(INPUT_CHECKS, START_CHECK), START_CHECK), start_time)
        self._require((TORQUE_CHECK,), start_time, gain_problems(drive))
        entries, groups = compiled(), (*memory, python_control_design(drive))
        self._advance, self._evaluate = (entries[name].bind(*groups) for name in ("advance_drive", "evaluate_drive"))
        entries["start_at_rest"].bind(*groups)(t=start_time)

    def step(self, time: float, dt: float, inputs: Mapping[str, Any]) -> None:
        """Advance from `time` to `time + dt` [s] with inputs held.

        The equilibrium at the start is that with the first tensions that are not zero. Raises `InputError` for a destination
        outside the shaft, a tension that is not finite, a motor too weak to hold the car or a step of more than a million
        sample periods; `SimulationError` when the motor cannot keep the car in the shaft.
        """
        self._read(inputs)
        self._require(range(INPUT_CHECKS, START_CHECK), time)
        require_success(MESSAGES, self._advance(t=time, dt=dt), self._work.message)

    def outputs(self) -> dict[str, Any]:
        """All outputs by name at the current time."""
        self._evaluate()
        values = self._outputs.y.tolist()
        reals = {name: value for (name, *_), value in zip(REAL_OUTPUTS, values, strict=False)}
        return reals | {name: value != 0.0 for (name, _), value in zip(FLAGS, values[REALS:], strict=True)}

    def get_state(self) -> bytes:
        """The complete state, for a bitwise equal restart in any process."""
        return _MARK + b"".join(array.tobytes() for array in self._state)

    def set_state(self, state: bytes) -> None:
        """Restore a state of `get_state` of a simulator with the same parameters and start time; refuses any other bytes."""
        numbers = sum(array.size for array in self._state)
        if len(state) != len(_MARK) + 8 * numbers or not state.startswith(_MARK):
            raise InputError(f"state of {len(state)} bytes: only a state saved by this version of the drive is accepted")
        at = len(_MARK)
        for array in self._state:
            array[:] = np.frombuffer(state, np.float64, array.size, at)
            at += array.nbytes

    def _read(self, inputs: Mapping[str, Any]) -> None:
        self._inputs.u[:] = [inputs[name] for name in INPUTS]

    def _require(self, checks: Iterable[int], time: float, others: Iterable[str] = ()) -> None:
        """Raise `InputError` with the sentences of all checks that fail, and others."""
        statuses = ((self._check(number=number, t=time), self._work.message) for number in checks)
        found = [sentence(MESSAGES, status, message) for status, message in statuses if status != SUCCESS]
        if problems := [*found, *others]:
            raise InputError("; ".join(problems))


def gain_problems(drive: Drive) -> list[str]:
    """A sentence if the closed loop is unstable, by python-control's poles."""
    positions = unstable_positions(drive)
    if not positions:
        return []
    servo = drive.servo
    values = (servo.position_bandwidth, servo.speed_bandwidth, servo.speed_damping, servo.sample_period, *positions)
    return [sentence(MESSAGES, UNSTABLE + len(positions) - 1, values)]


def python_control_design(drive: Drive) -> Design:
    """Gains and sampled hoist of a drive, designed with python-control, as the kernels take them."""
    servo, plant = design_servo(drive), scheduled_plant(drive)
    gains = np.zeros(GAINS)
    gains[[GAIN, INPUT_GAIN, OUTPUT_GAIN]] = servo.speed.gain, servo.speed.input_gain, servo.speed.output_gain
    gains[FEEDFORWARD] = servo.acceleration_feedforward
    rates, steps = (np.ascontiguousarray(one).ravel() for one in (plant.rate_matrices, plant.step_matrices))
    return Design(len(plant.rate_matrices), gains, np.append(plant.boundaries, np.inf), rates, steps)


def empty_state() -> State:
    """A state of zeros."""
    return State(np.zeros(CLOCK), np.zeros(SERVO), np.zeros(TRIP), np.zeros(ROW), np.zeros(EMERGENCY))


def empty_design(points: int) -> Design:
    """A design of zeros for a number of operating points."""
    return Design(points, np.zeros(GAINS), np.zeros(points), np.zeros(points * RATES), np.zeros(points * RATES))


def empty_workspace() -> Workspace:
    """A workspace of zeros."""
    return Workspace(np.zeros(4 * MATRIX + ROW), np.zeros(MESSAGE_VALUES))
