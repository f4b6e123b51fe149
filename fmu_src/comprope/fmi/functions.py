"""The functions of FMI 2.0 for co-simulation as pointers that the FMU's binary calls (see binary/python_slave.c).

Each translates the importer's types and makes one call of a `Component`. No exception leaves a function: it is logged as one
sentence and becomes the status "error".
"""

import ctypes
from collections.abc import Callable, Iterator
from ctypes import CFUNCTYPE, POINTER, c_byte, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p
from itertools import count
from typing import Any

from ..errors import InputError
from . import error_reporting
from .component import Component, Log
from .model_interface import Kind, ModelInterface

OK, ERROR = 0, 3
_COSIMULATION = 1
_CATEGORY = b"logStatusError"
_Logger = CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p)
# Of the importer's callbacks: logger, functions for memory, a notice of finished steps, and what the logger is called with.
_CALLBACKS, _LOGGER, _ENVIRONMENT = c_void_p * 5, 0, 4
_TYPES: dict[Kind, Any] = {"real": c_double, "integer": c_int, "boolean": c_int, "string": c_char_p}


class Functions:
    """The functions for one model; `identity` names the model and the build that saved states belong to.

    `pointers` is the table that the binary needs. It must outlive all instances.
    """

    def __init__(self, interface: ModelInterface, identity: str, guid: str) -> None:
        self._interface, self._identity, self._guid = interface, identity, guid
        self._components: dict[int, Component] = {}
        self._numbers = count(1)
        self._callbacks = list(self._listed())
        self.pointers = (c_void_p * len(self._callbacks))(*(ctypes.cast(one, c_void_p).value for one in self._callbacks))

    def _listed(self) -> Iterator[Any]:
        """The functions in the order of `enum function` in python_slave.c."""
        instantiate = CFUNCTYPE(c_void_p, c_char_p, c_int, c_char_p, c_char_p, c_void_p, c_int, c_int)
        yield instantiate(self._instantiate)
        yield CFUNCTYPE(None, c_void_p)(self._free_instance)
        yield self._function(_setup_experiment, c_double, c_int, c_double)
        yield self._function(Component.enter_initialization)
        yield self._function(Component.exit_initialization)
        yield self._function(Component.do_step, c_double, c_double)
        yield self._function(Component.terminate)
        yield self._function(Component.reset)
        yield from (self._function(_getter(kind), c_void_p, c_size_t, c_void_p) for kind in _TYPES)
        yield from (self._function(_setter(kind), c_void_p, c_size_t, c_void_p) for kind in _TYPES)
        yield self._function(_get_state, POINTER(c_void_p))
        yield self._function(lambda one, state: one.restore_state(state or 0), c_void_p)
        yield self._function(_free_state, POINTER(c_void_p))
        yield self._function(_state_size, c_void_p, POINTER(c_size_t))
        yield self._function(_serialize, c_void_p, c_void_p, c_size_t)
        yield self._function(_deserialize, c_void_p, c_size_t, POINTER(c_void_p))
        yield self._function(_last_time, POINTER(c_double))
        yield self._function(_refuse, c_char_p)

    def _function(self, action: Callable[..., None], *types: Any) -> Any:
        """A function whose first argument is the instance; it returns a status."""

        def call(number: int | None, *arguments: Any) -> int:
            component = self._components.get(number or 0)
            if component is None:
                return ERROR
            try:
                action(component, *arguments)
            except BaseException as error:
                component.fail(error)
                return ERROR
            return OK

        return CFUNCTYPE(c_int, c_void_p, *types)(call)

    def _instantiate(
        self, name: bytes | None, kind: int, guid: bytes | None, _resources: bytes, callbacks: int | None, *_: int
    ) -> int | None:
        shown = (name or b"").decode("utf-8", "replace")
        try:
            log = _log(callbacks, name or b"")
            refusal = self._refusal(shown, kind, guid)
            if refusal:
                log(refusal)
                return None
            component = Component(self._interface, shown, self._identity, log)
        except BaseException as error:
            error_reporting.report(error_reporting.sentence(error))
            return None
        number = next(self._numbers)
        self._components[number] = component
        return number

    def _refusal(self, name: str, kind: int, guid: bytes | None) -> str | None:
        """Why there will be no instance."""
        if not name:
            return "an instance needs a name"
        if kind != _COSIMULATION:
            return "this FMU is for co-simulation only"
        if guid is None or guid.decode("utf-8", "replace") != self._guid:
            return "the GUID is not this FMU's: resources and modelDescription.xml do not belong together"
        return None

    def _free_instance(self, number: int | None) -> None:
        self._components.pop(number or 0, None)


def _log(callbacks: int | None, name: bytes) -> Log:
    """What passes a sentence to the importer's logger or, where there is none, to standard error."""
    found = _CALLBACKS.from_address(callbacks) if callbacks else (None,) * 5
    if not found[_LOGGER]:
        return error_reporting.report
    logger, environment = _Logger(found[_LOGGER] or 0), found[_ENVIRONMENT]
    # The logger takes the sentence as a format.
    return lambda text: logger(environment, name, ERROR, _CATEGORY, text.replace("%", "%%").encode())


def _setup_experiment(component: Component, start: float, stop_defined: int, stop: float) -> None:
    component.setup_experiment(start, stop if stop_defined else None)


def _array(item: Any, address: int | None, length: int) -> Any:
    """The importer's array."""
    if length and not address:
        raise InputError("one value reference and one value are needed for each variable")
    return (item * length).from_address(address) if length else ()


def _getter(kind: Kind) -> Callable[..., None]:
    def get(component: Component, references: int | None, length: int, values: int | None) -> None:
        target = _array(_TYPES[kind], values, length)
        found: list[Any] = component.get_values(kind, _array(c_uint, references, length))
        if kind == "string":
            component.strings = found = [str(one).encode() for one in found]
        if length:
            target[:] = found

    return get


def _setter(kind: Kind) -> Callable[..., None]:
    def convert(value: Any) -> Any:
        if kind == "string":
            return (value or b"").decode("utf-8", "replace")
        return bool(value) if kind == "boolean" else value

    def put(component: Component, references: int | None, length: int, values: int | None) -> None:
        given = _array(_TYPES[kind], values, length)
        component.set_values(kind, list(_array(c_uint, references, length)), [convert(one) for one in given])

    return put


def _place(pointer: Any, what: str) -> Any:
    if not pointer:
        raise InputError(f"no place for {what} is given")
    return pointer


def _get_state(component: Component, state: Any) -> None:
    _place(state, "a state")[0] = component.save_state(state[0] or 0)


def _free_state(component: Component, state: Any) -> None:
    if state and state[0]:
        component.free_state(state[0])
        state[0] = None


def _state_size(component: Component, state: int | None, size: Any) -> None:
    _place(size, "a size")[0] = len(component.state(state or 0))


def _serialize(component: Component, state: int | None, data: int | None, size: int) -> None:
    saved = component.state(state or 0)
    if size < len(saved):
        raise InputError(f"saved state: needs {len(saved)} bytes, {size} are given")
    ctypes.memmove(_place(data, "the bytes"), saved, len(saved))


def _deserialize(component: Component, data: int | None, size: int, state: Any) -> None:
    found = bytes((c_byte * size).from_address(_place(data, "the bytes")))
    _place(state, "a state")[0] = component.add_state(found)


def _last_time(component: Component, time: Any) -> None:
    time[0] = component.instance.time


def _refuse(_component: Component, reason: bytes) -> None:
    raise InputError(reason.decode())
