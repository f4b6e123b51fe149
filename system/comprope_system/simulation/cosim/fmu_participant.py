"""An FMU as a participant, through fmpy; errors carry the message of the FMU."""

import io
import shutil
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, redirect_stderr, suppress
from ctypes import byref
from itertools import count
from pathlib import Path
from typing import Any

import fmpy
from fmpy import fmi2
from fmpy.fmi1 import FMICallException

from comprope.errors import CompropeError, InputError, SimulationError

_CASTS: dict[str, Callable[[Any], Any]] = {"Real": float, "Integer": int, "Boolean": bool, "String": str}


class FmuParticipant:
    """One instance of an FMI 2.0 co-simulation FMU, a context manager.

    Raises `InputError` for unknown or rejected parameters, `SimulationError` if it cannot
    be loaded or a step fails.
    """

    def __init__(self, name: str, path: Path, start: Mapping[str, Any]) -> None:
        """`start` contains values of parameters and inputs by name; others have the start values of the FMU."""
        self.name = name
        self._start = dict(start)
        self._messages: list[str] = []
        self._number = next(_NUMBERS)
        _RECEIVERS[self._number] = self._messages
        self._running = self._failed = False
        self._folder = fmpy.extract(str(path))
        try:
            description = fmpy.read_model_description(self._folder)
            self._variables = {one.name: one for one in description.modelVariables}
            self._outputs = [one.name for one in description.modelVariables if one.causality == "output"]
            self._instance = self._instantiated(description)
        except BaseException:
            shutil.rmtree(self._folder, ignore_errors=True)
            del _RECEIVERS[self._number]
            raise

    def __enter__(self) -> "FmuParticipant":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def enter_initialization(self, start: float) -> None:
        """See `Participant`."""
        with self._calls():
            self._instance.setupExperiment(startTime=start)
        self.set(self._start)
        with self._calls():
            self._instance.enterInitializationMode()

    def set(self, values: Mapping[str, Any]) -> None:
        """See `Participant`."""
        for kind, names in self._by_kind(list(values)).items():
            with self._calls():
                setter = getattr(self._instance, f"set{kind}")
                setter(self._references(names), [_CASTS[kind](values[name]) for name in names])

    def outputs(self) -> dict[str, Any]:
        """See `Participant`."""
        values: dict[str, Any] = {}
        for kind, names in self._by_kind(self._outputs).items():
            with self._calls():
                got = getattr(self._instance, f"get{kind}")(self._references(names))
            values |= {name: _CASTS[kind](value) for name, value in zip(names, got, strict=True)}
        return values

    def exit_initialization(self) -> None:
        """See `Participant`."""
        with self._calls():
            self._instance.exitInitializationMode()
        self._running = True

    def step(self, time: float, dt: float) -> None:
        """See `Participant`."""
        with self._calls():
            self._instance.doStep(currentCommunicationPoint=time, communicationStepSize=dt)

    def close(self) -> None:
        """Free the instance and remove its unpacked files; may be called repeatedly."""
        instance, self._instance = self._instance, None
        if instance is None:
            return
        with redirect_stderr(io.StringIO()), suppress(Exception):
            if self._running and not self._failed:
                instance.terminate()
        with redirect_stderr(io.StringIO()), suppress(Exception):
            instance.freeInstance()
        del _RECEIVERS[self._number]
        shutil.rmtree(self._folder, ignore_errors=True)

    def _instantiated(self, description: Any) -> Any:
        instance = fmi2.FMU2Slave(
            guid=description.guid,
            unzipDirectory=self._folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=self.name,
        )
        self._callbacks = _callbacks(self._number)
        errors = io.StringIO()
        try:
            with redirect_stderr(errors):
                instance.instantiate(callbacks=self._callbacks, loggingOn=True)
        except Exception as error:
            raise SimulationError(f"{self.name}: the FMU cannot be instantiated: {self._told(errors, error)}") from None
        return instance

    @contextmanager
    def _calls(self) -> Iterator[None]:
        """Turn a failed call into an error with the FMU's own message.

        The message comes from the logger; the FMU's output to standard error only repeats it.
        """
        self._messages.clear()
        errors = io.StringIO()
        try:
            with redirect_stderr(errors):
                yield
        except FMICallException as error:
            self._failed = True
            kind: type[CompropeError] = SimulationError if self._running else InputError
            raise kind(f"{self.name}: {self._told(errors, error)}") from None

    def _told(self, errors: io.StringIO, error: Exception) -> str:
        """The last line logged by the FMU, else written to standard error, else fmpy's message."""
        lines = [line for text in (str(error), errors.getvalue(), *self._messages) for line in text.splitlines() if line.strip()]
        return lines[-1].strip()

    def _by_kind(self, names: list[str]) -> dict[str, list[str]]:
        groups: dict[str, list[str]] = defaultdict(list)
        for name in names:
            if name not in self._variables:
                raise InputError(f"{self.name}: {name} is not one of the FMU's variables")
            groups[self._variables[name].type].append(name)
        return groups

    def _references(self, names: list[str]) -> list[int]:
        return [self._variables[name].valueReference for name in names]


# Messages by the number that an instance has as its environment; fmpy's proxy sends those of all instances to one logger.
_RECEIVERS: dict[int, list[str]] = {}
_NUMBERS = count(1)


def _log(environment: int | None, instance: bytes, status: int, category: bytes, message: bytes) -> None:
    """Keep a warning or an error of one of our instances; what others log is printed, as fmpy does."""
    receiver = _RECEIVERS.get(environment or 0)
    if receiver is None:
        fmi2.printLogMessage(environment, instance, status, category, message)
    elif status != fmi2.fmi2OK:
        receiver.append((message or b"").decode("utf-8", "replace").strip())


_LOGGER = fmi2.fmi2CallbackLoggerTYPE(_log)  # never freed: the proxy keeps it for FMUs that are instantiated later


def _callbacks(number: int) -> Any:
    """FMI callbacks of the instance with this number."""
    callbacks = fmi2.fmi2CallbackFunctions()
    callbacks.logger, callbacks.componentEnvironment = _LOGGER, number
    callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(fmi2.calloc)
    callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(fmi2.free)
    with suppress(Exception):  # where fmpy has no such proxy, a message's arguments stay unformatted
        from fmpy.logging import addLoggerProxy

        addLoggerProxy(byref(callbacks))
    return callbacks
