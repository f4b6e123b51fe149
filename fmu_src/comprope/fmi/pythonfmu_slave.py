"""A pythonfmu slave for any model: it forwards calls to an `Instance` and reports every error."""

import sys
from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any, ClassVar, NoReturn, ParamSpec, TypeVar

from pythonfmu import Boolean, Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Integer, Real, String

from . import error_reporting
from .instance import Instance
from .model_interface import ModelInterface, Value, Variable
from .pythonfmu_workarounds import keep_alive, leave_cleanly

P = ParamSpec("P")
R = TypeVar("R")

_FMI_TYPES = {"real": Real, "integer": Integer, "boolean": Boolean, "string": String}
_INITIAL = {"parameter": Fmi2Initial.exact, "output": Fmi2Initial.calculated, "input": None}


def slave_class(interface: ModelInterface) -> type["ModelSlave"]:
    """The slave of a model; an FMU's script subclasses it under the model's name."""
    return type("Slave", (ModelSlave,), {"interface": interface, "__doc__": interface.description})


def guarded(method: Callable[P, R]) -> Callable[P, R]:
    """Turn every exception of a method that pythonfmu calls into a `SlaveError`."""

    @wraps(method)
    def call(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            return method(*args, **kwargs)
        except BaseException as error:
            slave: ModelSlave = args[0]  # type: ignore[assignment]
            slave.fail(error)

    return call


class ModelSlave(Fmi2Slave):
    """One instance of a model as an FMI slave.

    Every error raises a `SlaveError`, which importers see as fmi2Fatal (see `error_reporting`), and
    prevents further steps and outputs until the instance is reset or an earlier state is restored.
    """

    interface: ClassVar[ModelInterface]

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if "logger" in kwargs:  # inside an FMU
            leave_cleanly(self.resources, type(self).__name__)
            if self.resources in sys.path:  # put there to load this module; all is imported by now
                sys.path.remove(self.resources)
        self._instance = Instance(self.interface)
        for one in self.interface.variables:
            self.register_variable(_pythonfmu_variable(one), nested=False)

    @guarded
    def setup_experiment(self, start_time: float, stop_time: float | None = None, tolerance: float | None = None) -> None:
        """Set start and stop time [s]; the tolerance is not used, since the model's parameters set its accuracy."""
        self._instance.setup_experiment(start_time, stop_time)

    @guarded
    def exit_initialization_mode(self) -> None:
        """Create the simulator from the values set; refuses invalid ones, all problems in one sentence."""
        self._instance.exit_initialization()

    @guarded
    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance the model by `step_size` [s]."""
        self._instance.do_step(current_time, step_size)
        return True

    @guarded
    def get_real(self, vrs: Sequence[int]) -> list[Value]:
        """Real values by reference."""
        return self._instance.get_values("real", vrs)

    @guarded
    def get_integer(self, vrs: Sequence[int]) -> list[Value]:
        """Integer values by reference."""
        return self._instance.get_values("integer", vrs)

    @guarded
    def get_boolean(self, vrs: Sequence[int]) -> list[Value]:
        """Boolean values by reference."""
        return self._instance.get_values("boolean", vrs)

    @guarded
    def get_string(self, vrs: Sequence[int]) -> list[Value]:
        """Strings by reference."""
        return self._instance.get_values("string", vrs)

    @guarded
    def set_real(self, vrs: Sequence[int], values: Sequence[float]) -> None:
        """Set Real values by reference, all or none."""
        self._instance.set_values("real", vrs, values)

    @guarded
    def set_integer(self, vrs: Sequence[int], values: Sequence[int]) -> None:
        """Set Integer values by reference, all or none."""
        self._instance.set_values("integer", vrs, values)

    @guarded
    def set_boolean(self, vrs: Sequence[int], values: Sequence[bool]) -> None:
        """Set Boolean values by reference, all or none."""
        self._instance.set_values("boolean", vrs, values)

    @guarded
    def set_string(self, vrs: Sequence[int], values: Sequence[str]) -> None:
        """Set strings by reference, all or none."""
        self._instance.set_values("string", vrs, values)

    @guarded
    def _get_fmu_state(self) -> bytes:
        return self._instance.save_state(self._identity())

    @guarded
    def _set_fmu_state(self, state: bytes) -> None:
        self._instance.restore_state(state, self._identity())

    # These two are called on the class, where there is no instance to keep alive after an
    # exception (see `pythonfmu_workarounds`); hence states are always bytes, checked when set.

    @staticmethod
    def _fmu_state_to_bytes(state: bytes) -> bytes:
        return state

    @staticmethod
    def _fmu_state_from_bytes(state: bytes) -> bytes:
        return state

    def fail(self, error: BaseException) -> NoReturn:
        """Report an error, prevent further steps and outputs, and raise it as a `SlaveError`."""
        what = error_reporting.sentence(error)
        text = f"{self.interface.name} '{self.instance_name}' at t = {self._instance.time:.9g} s: {what}"
        if self._instance.failure is None:
            error_reporting.report(text)
            self._instance.failure = what
        keep_alive(type(self), self, self.log_queue)
        raise error_reporting.SlaveError(text) from None

    def _identity(self) -> str:
        """Model and package; inside an FMU the package is named by its content, hence different for every build."""
        return f"{self.interface.name} of {__name__.split('.')[0]}"


def _pythonfmu_variable(variable: Variable) -> Any:
    return _FMI_TYPES[variable.kind](
        variable.name,
        causality=Fmi2Causality[variable.role],
        variability=Fmi2Variability[variable.variability],
        initial=_INITIAL[variable.role],
        description=variable.help,
    )
