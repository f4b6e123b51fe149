"""An FMU and the model itself side by side: every call goes to both, and they must agree, bit for bit or in refusing it."""

import math
import random
import shutil
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    FMU2Slave,
    calloc,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
    free,
)

from comprope.errors import CompropeError, InputError
from comprope.fmi.instance import Instance
from comprope.fmi.model_interface import ModelInterface

ERROR = 3  # status of FMI


class Oracle:
    """What an FMU should do: an `Instance` that stays out of action after an error and knows the order of calls."""

    def __init__(self, interface: ModelInterface) -> None:
        self.interface = interface
        self.reset()

    def reset(self) -> None:
        self.instance, self.phase = Instance(self.interface), 0

    def attempt(self, action: Callable[[], Any]) -> Any:
        """What the action gives; `CompropeError` is noted as the real thing does."""
        try:
            return action()
        except CompropeError as error:
            self.instance.failure = self.instance.failure or str(error)
            raise

    def require(self, *phases: int) -> None:
        if self.phase not in phases:
            raise InputError("not now")

    def enter_phase(self, phase: int, needed: int) -> None:
        self.require(needed)
        self.phase = phase


class Pair:
    """One instance of an FMU and its oracle. Each method makes a call; a disagreement is an `AssertionError`."""

    def __init__(self, fmu: Path, interface: ModelInterface) -> None:
        self.folder, self.description = extract(str(fmu)), read_model_description(str(fmu))
        self.oracle, self.messages, self.states = Oracle(interface), list[str](), list[tuple[Any, bytes, int]]()
        self.references = {one.name: place for place, one in enumerate(interface.variables)}
        self.calls = self.refusals = 0
        self._instantiate()

    def _instantiate(self) -> None:
        self.instance = FMU2Slave(
            guid=self.description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="pair",
        )
        self._callbacks = fmi2CallbackFunctions()
        self._callbacks.logger = fmi2CallbackLoggerTYPE(self._log)
        self._callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(calloc)
        self._callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
        self.instance.instantiate(callbacks=self._callbacks, loggingOn=True)

    def _log(self, _environment: Any, _name: bytes, status: int, _category: bytes, message: bytes) -> None:
        self.messages.append(f"{status} {message.decode()}")

    def both(self, call: Callable[[], Any], expected: Callable[[], Any]) -> Any:
        """Make a call; returns what it gave and what the oracle gave, or None if both refused."""
        self.calls += 1
        self.messages.clear()
        try:
            answer = self.oracle.attempt(expected)
        except CompropeError as error:
            self._refused(call, error)
            return None
        return call(), answer

    def _refused(self, call: Callable[[], Any], why: CompropeError) -> None:
        self.refusals += 1
        try:
            call()
        except FMICallException as error:
            assert error.status == ERROR, error
            assert self.messages and self.messages[0].startswith(f"{ERROR} "), self.messages
        else:
            raise AssertionError(f"accepted, though: {why}")

    def free(self) -> None:
        """Free the instance and its unpacked files."""
        for state, _, _ in self.states:
            self.instance.freeFMUState(state)
        self.instance.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)

    # -- calls -----------------------------------------------------------------------------------

    def instantiate_again(self) -> None:
        """Free the instance with whatever states it has, and make another."""
        self.instance.freeInstance()
        self.states.clear()
        self.oracle.reset()
        self._instantiate()

    def reset(self) -> None:
        self.both(self.instance.reset, self.oracle.reset)

    def setup_experiment(self, start: float, stop: float | None) -> None:
        def expected() -> None:
            self.oracle.require(0)
            self.oracle.instance.setup_experiment(start, stop)

        self.both(lambda: self.instance.setupExperiment(startTime=start, stopTime=stop), expected)

    def enter_initialization(self) -> None:
        self.both(self.instance.enterInitializationMode, lambda: self.oracle.enter_phase(1, 0))

    def exit_initialization(self) -> None:
        def expected() -> None:
            self.oracle.require(1)
            self.oracle.instance.exit_initialization()
            self.oracle.phase = 2

        self.both(self.instance.exitInitializationMode, expected)

    def terminate(self) -> None:
        self.both(self.instance.terminate, lambda: self.oracle.enter_phase(3, 2))

    def do_step(self, dt: float, late: float = 0.0) -> None:
        time = self.oracle.instance.time + late

        def expected() -> None:
            self.oracle.require(0, 1, 2)
            self.oracle.instance.do_step(time, dt)

        self.both(lambda: self.instance.doStep(time, dt), expected)

    def set_reals(self, names: Sequence[str], values: Sequence[float]) -> None:
        """Set real values."""
        references = [self.references[name] for name in names]

        def expected() -> None:
            self.oracle.require(0, 1, 2)
            self.oracle.instance.set_values("real", references, values)

        self.both(lambda: self.instance.setReal(references, values), expected)

    def set_boolean(self, name: str, value: bool) -> None:
        """Set a boolean value."""
        reference = [self.references[name]]

        def expected() -> None:
            self.oracle.require(0, 1, 2)
            self.oracle.instance.set_values("boolean", reference, [value])

        self.both(lambda: self.instance.setBoolean(reference, [value]), expected)

    def get_all(self) -> None:
        """Read every variable; outputs come last, so that a refusal of theirs is one of the others as well."""
        for kind, getter in (("real", "Real"), ("integer", "Integer"), ("boolean", "Boolean")):
            chosen = [place for place, one in enumerate(self.oracle.interface.variables) if one.kind == kind]
            get = getattr(self.instance, f"get{getter}")
            found = self.both(partial(get, chosen), partial(self.oracle.instance.get_values, kind, chosen))
            assert found is None or self.agree(chosen, *map(list, found))
            assert found is None or all(math.isfinite(value) for value in found[0])

    def agree(self, references: list[int], found: list[Any], expected: list[Any]) -> bool:
        """Whether values agree: bit for bit."""
        return found == expected

    def get_any_reference(self, reference: int) -> None:
        """Read by a reference that may not exist, as every type in turn."""
        for kind in ("real", "integer", "boolean"):
            getter = getattr(self.instance, f"get{kind.capitalize()}")
            self.both(partial(getter, [reference]), partial(self.oracle.instance.get_values, kind, [reference]))

    def save_state(self) -> None:
        found = self.both(self.instance.getFMUState, lambda: self.oracle.instance.save_state("one"))
        self.states.append((*found, self.oracle.phase))

    def require_flipped_bits_refused(self) -> None:
        """Of the serialised present state, one flipped bit is refused, wherever it is."""
        data = self.instance.serializeFMUState(self.instance.getFMUState())
        for bit in random.Random(3).sample(range(8 * len(data)), 200):
            changed = bytearray(data)
            changed[bit // 8] ^= 1 << bit % 8
            with pytest.raises(FMICallException):
                self.instance.deserializeFMUState(bytes(changed))

    def restore_state(self, place: int, serialized: bool) -> None:
        """Restore a saved state, if wanted from its bytes."""
        if not self.states:
            return
        state, expected, phase = self.states[place % len(self.states)]
        if serialized:
            copy = self.instance.deserializeFMUState(self.instance.serializeFMUState(state))
            self.both(lambda: self.instance.setFMUState(copy), lambda: self.oracle.instance.restore_state(expected, "one"))
            self.instance.freeFMUState(copy)
        else:
            self.both(lambda: self.instance.setFMUState(state), lambda: self.oracle.instance.restore_state(expected, "one"))
        self.oracle.phase = phase

    def free_state(self, place: int) -> None:
        """Free a saved state."""
        if self.states:
            state, _, _ = self.states.pop(place % len(self.states))
            self.instance.freeFMUState(state)

    def start(self, values: dict[str, float]) -> None:
        """From anywhere to a run that steps."""
        self.reset()
        self.start_with(values)

    def start_with(self, values: dict[str, float]) -> None:
        """From a new instance to a run that steps."""
        self.setup_experiment(0.0, None)
        self.set_reals(list(values), list(values.values()))
        self.enter_initialization()
        self.exit_initialization()


# A shaft of one metre, so that a call takes microseconds.
SMALL = {
    "shaft.height": 1.0, "shaft.pit": 0.6, "rope.element_length": 0.1, "sheave.radius": 0.4, "counterweight_position": 1.0,
}  # fmt: skip
STEPS = (0.01, 0.01, 0.01, 0.004, 0.013, 0.02, 0.0, -0.01, math.nan, math.inf, 1e300)
ODD = (math.nan, math.inf, -math.inf, -1.0, 1e9, -1e300, 0.0)


def random_call(pair: Pair, random: random.Random) -> None:
    """One call of any kind; most make sense, so that runs get somewhere."""
    if (pair.oracle.instance.failure or pair.oracle.phase != 2) and random.random() < 0.3:
        pair.start(SMALL)
    kinds = [
        (40, lambda: _move(pair, random)),
        (20, lambda: pair.do_step(random.choice(STEPS[:6]))),
        (12, pair.get_all),
        (3, lambda: pair.start(SMALL)),
        (4, pair.save_state),
        (5, lambda: pair.restore_state(random.randrange(9), random.random() < 0.5)),
        (3, lambda: pair.free_state(random.randrange(9))),
        (2, lambda: pair.do_step(random.choice(STEPS), random.choice((0.0, 0.0, 1.0, -0.01, math.nan)))),
        (4, lambda: _set_any(pair, random)),
        (1, lambda: pair.get_any_reference(random.choice((0, 5, 60, 70, 100, 2**32 - 1)))),
        (1, lambda: pair.set_boolean(random.choice(("derivative_inputs", "inputs_at_end")), random.random() < 0.5)),
        (1, pair.enter_initialization), (1, pair.exit_initialization), (1, pair.terminate), (1, pair.reset),
        (1, pair.instantiate_again),
        (1, lambda: pair.setup_experiment(random.choice((0.0, 5.0)), random.choice((None, 5.1)))),
    ]  # fmt: skip
    random.choices([call for _, call in kinds], [weight for weight, _ in kinds])[0]()


def _move(pair: Pair, random: random.Random) -> None:
    """Move the ends a little, together or apart, and step."""
    values = pair.oracle.instance.get_values(
        "real", [pair.references[name] for name in ("car_position", "counterweight_position")]
    )
    moved = [float(value) + random.uniform(-0.01, 0.01) for value in values]
    pair.set_reals(["car_position", "counterweight_position"], moved)
    pair.do_step(random.choice(STEPS[:6]))


def _set_any(pair: Pair, random: random.Random) -> None:
    """Set some real variable to its start, within its range or to nonsense; the mesh stays small."""
    one = random.choice([one for one in pair.oracle.interface.variables if one.kind == "real"])
    low, high = one.minimum, one.maximum
    value = random.choice(ODD)
    if low is not None and high is not None and random.random() < 0.7:
        small = one.name in ("shaft.height", "shaft.pit", "rope.element_length", "solver.step")
        value = (
            float(one.start or low) if small else random.choice((low, high, random.uniform(low, high), float(one.start or 0.0)))
        )
    pair.set_reals([one.name], [value])
