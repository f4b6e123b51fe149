"""One instance of a model as an importer sees it: the order of calls, its saved states, and its errors.

A refused call marks the instance as failed: there are no steps and no outputs until it is reset or an earlier state is restored.
"""

from collections.abc import Callable, Sequence
from itertools import count
from typing import Any

from ..errors import InputError
from . import error_reporting
from .instance import INITIALIZING, INSTANTIATED, STEPPING, TERMINATED, Instance, unpack
from .model_interface import Kind, ModelInterface, Value

# What must be reached for a call, as messages put it.
_WHEN = {
    INSTANTIATED: "before initialization",
    INITIALIZING: "in initialization mode",
    STEPPING: "between the end of initialization and termination",
}

Log = Callable[[str], None]


class Component:
    """An `Instance` of a model with a name, the phase it is in, and its saved states by handle.

    `identity` names the model and the build that saved states belong to; `log` passes a sentence to the importer.
    """

    _handles = count(1)

    def __init__(self, interface: ModelInterface, name: str, identity: str, log: Log) -> None:
        self.interface, self.name, self.identity = interface, name, identity
        self.instance = Instance(interface)
        self.strings: list[bytes] = []  # those returned last, which the importer may still read
        self._log, self._states = log, dict[int, bytes]()

    # -- the order of calls --------------------------------------------------------------------

    def setup_experiment(self, start: float, stop: float | None) -> None:
        """Set start and stop time [s]."""
        self._require(INSTANTIATED)
        self.instance.setup_experiment(start, stop)

    def enter_initialization(self) -> None:
        """Enter initialization mode."""
        self._require(INSTANTIATED)
        self.instance.phase = INITIALIZING

    def exit_initialization(self) -> None:
        """Create the simulator from the values set; refuses invalid ones, all problems in one sentence."""
        self._require(INITIALIZING)
        self.instance.exit_initialization()

    def do_step(self, time: float, dt: float) -> None:
        """Advance from `time` by `dt` [s]."""
        self.instance.require_not_failed()
        self._require(STEPPING)
        self.instance.do_step(time, dt)

    def terminate(self) -> None:
        """End the run."""
        self._require(STEPPING)
        self.instance.phase = TERMINATED

    def reset(self) -> None:
        """Back to the start values of all variables."""
        self.instance = Instance(self.interface)

    def set_values(self, kind: Kind, references: Sequence[int], values: Sequence[Any]) -> None:
        """Set values by reference, all or none."""
        if self.instance.phase == TERMINATED:
            raise InputError("values cannot be set: the run has ended")
        self.instance.set_values(kind, references, values)

    def get_values(self, kind: Kind, references: Sequence[int]) -> list[Value]:
        """Values by reference."""
        return self.instance.get_values(kind, references)

    def _require(self, phase: int) -> None:
        if self.instance.phase != phase:
            raise InputError(f"this call is possible only {_WHEN[phase]}")

    # -- saved states --------------------------------------------------------------------------

    def save_state(self, handle: int) -> int:
        """Save the whole state in place of the one with this handle, or as a new one if it is 0; returns the handle."""
        if handle:
            self.state(handle)
        return self._keep(self.instance.save_state(self.identity), handle)

    def restore_state(self, handle: int) -> None:
        """Return to a saved state, bit for bit."""
        self.instance.restore_state(self.state(handle), self.identity)

    def state(self, handle: int) -> bytes:
        """A saved state, valid in any process that has the same FMU."""
        if handle not in self._states:
            raise InputError("saved state: not one of this instance, or freed already")
        return self._states[handle]

    def add_state(self, data: bytes) -> int:
        """Take a state from its bytes; returns its handle."""
        unpack(data, self.identity)
        return self._keep(data, 0)

    def free_state(self, handle: int) -> None:
        """Forget a saved state."""
        self.state(handle)
        del self._states[handle]

    def _keep(self, data: bytes, handle: int) -> int:
        chosen = handle or next(self._handles)
        self._states[chosen] = data
        return chosen

    # -- errors --------------------------------------------------------------------------------

    def fail(self, error: BaseException) -> None:
        """Report an error to the importer and prevent further steps and outputs."""
        what = error_reporting.sentence(error)
        self.instance.failure = self.instance.failure or what
        self._log(f"{self.interface.name} '{self.name}' at t = {self.instance.time:.9g} s: {what}")
