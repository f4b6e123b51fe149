"""A host process for FMUs, run by the tests: a crash of it is a result, not the end of the tests.

Usage: host.py SCENARIO FMU...; prints what happens, one line each, and at last ALIVE.
"""

# ruff: noqa: T201 -- printing is how it tells

import math
import sys
from collections.abc import Callable
from ctypes import CDLL, CFUNCTYPE, Structure, byref, c_char_p, c_int, c_void_p, cast
from typing import Any
from urllib.parse import quote

from fmpy import extract, platform, read_model_description, sharedLibraryExtension
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave


class Host:
    """An instance whose variables have names; what it lacks is fmpy's."""

    def __init__(self, path: str) -> None:
        folder = path if not path.endswith(".fmu") else extract(path)
        description = read_model_description(folder)
        self.refs = {one.name: one.valueReference for one in description.modelVariables}
        identifier = description.coSimulation.modelIdentifier
        self.fmu = FMU2Slave(guid=description.guid, unzipDirectory=folder, modelIdentifier=identifier, instanceName="one")
        self.fmu.instantiate(loggingOn=LOGGING)
        self.fmu.setupExperiment(startTime=0.0)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.fmu, name)

    def put(self, name: str, value: float) -> None:
        self.fmu.setReal([self.refs[name]], [value])

    def real(self, name: str) -> float:
        return float(self.fmu.getReal([self.refs[name]])[0])

    def begin(self) -> "Host":
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        return self

    def steps(self, first: int, last: int) -> "Host":
        for count in range(first, last):
            self.fmu.doStep(count * 0.01, 0.01)
        return self


LOGGING = "logging" in sys.argv


def attempt(action: Callable[[], Any]) -> None:
    """Print the status that an action ends in, as the importer sees it."""
    try:
        action()
    except FMICallException as error:
        print("STATUS", error.status)
    else:
        print("STATUS", 0)


def parameters(path: str) -> None:
    host = Host(path)
    host.put("spring.mass", -3.0)
    host.put("spring.stiffness", 1e9)
    attempt(host.begin)
    host.reset()
    host.setupExperiment(startTime=0.0)
    host.begin().steps(0, 3)
    print("VALUE", host.real("spring.mass"), host.real("place[1]"))
    host.freeInstance()


def refused_by_model(path: str) -> None:
    host = Host(path)
    host.put("spring.mass", 2.0)
    host.put("spring.stiffness", 2.0)
    attempt(host.begin)
    host.freeInstance()


def fixed(path: str) -> None:
    host = Host(path).begin()
    attempt(lambda: host.put("spring.mass", 3.0))
    print("VALUE", host.real("spring.mass"))
    host.freeInstance()


def nan(path: str) -> None:
    host = Host(path).begin().steps(0, 5)
    attempt(lambda: host.put("force", math.nan))
    print("VALUE", host.real("force"))
    host.freeInstance()


def _force(value: float) -> Callable[[str], None]:
    def scenario(path: str) -> None:
        host = Host(path).begin().steps(0, 5)
        state = host.getFMUState()
        host.put("force", value)
        for _ in range(3):
            attempt(lambda: host.doStep(0.05, 0.01))
        attempt(lambda: host.real("place[1]"))
        host.setFMUState(state)
        host.steps(5, 8)
        print("VALUE", host.real("force"), host.real("place[1]"))
        host.terminate()
        host.freeInstance()

    return scenario


diverging, internal, not_finite = _force(666.0), _force(667.0), _force(668.0)


def times(path: str) -> None:
    for time, step in ((0.0, 0.0), (0.0, -1.0), (0.0, math.nan), (0.5, 0.01)):
        host = Host(path).begin()
        attempt(lambda host=host, time=time, step=step: host.doStep(time, step))
        host.freeInstance()
    host = Host(path)
    host.setupExperiment(startTime=0.0, stopTime=0.1)
    host.begin().steps(0, 10)
    attempt(lambda: host.doStep(0.1, 0.01))
    host.freeInstance()


def foreign_state(path: str) -> None:
    host = Host(path).begin()
    attempt(lambda: host.deserializeFMUState(b"not a state"))
    host.freeInstance()


def many(path: str) -> None:
    references = []
    for _ in range(300):
        host = Host(path).begin().steps(0, 2)
        host.terminate()
        host.freeInstance()
        package = next(module for name, module in sys.modules.items() if name.startswith("comprope_spring_"))
        references.append(sys.getrefcount(package.__dict__))
    print("PATHS", sum("resources" in name for name in sys.path))
    print("REFERENCES", len(set(references)))


def together(*paths: str) -> None:
    hosts = [Host(path).begin() for path in paths]
    for host in hosts:
        print("VALUE", host.getString([host.refs["word"]])[0].decode(), host.steps(0, 9).real("place[1]"))


def save(path: str) -> None:
    host = Host(path)
    host.put("spring.mass", 1.0 / 3.0)
    host.put("force", 0.7)
    host.begin().steps(0, 17)
    print("STATE", host.serializeFMUState(host.getFMUState()).hex())
    print("VALUE", host.steps(17, 40).real("place[1]").hex())


def load(path: str) -> None:
    host = Host(path).begin()
    host.setFMUState(host.deserializeFMUState(bytes.fromhex(sys.stdin.read())))
    print("VALUE", host.steps(17, 40).real("place[1]").hex(), host.real("spring.mass"), host.real("force"))


def saved_often(path: str) -> None:
    host = Host(path).begin()
    state, seen = c_void_p(), set()
    for count in range(3000):
        host.fmu.fmi2GetFMUstate(host.fmu.component, byref(state))
        seen.add(state.value)
        if count == 1000:
            host.steps(0, 5)
    print("HANDLES", len(seen))
    host.steps(5, 9)
    host.setFMUState(state)
    print("VALUE", host.steps(5, 9).real("place[1]"))


class _Callbacks(Structure):
    _fields_ = (("logger", c_void_p), ("memory", c_void_p * 3), ("environment", c_void_p))


@CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p)
def _log(_environment: Any, _name: bytes, _status: int, _category: bytes, message: bytes) -> None:
    print("LOG", message.decode())


def _instantiate(folder: str, uri: str | None = "", callbacks: bool = True, **changed: Any) -> bool:
    description = read_model_description(folder)
    name = description.coSimulation.modelIdentifier
    library = CDLL(f"{folder}/binaries/{platform}/{name}{sharedLibraryExtension}")
    library.fmi2Instantiate.restype = c_void_p
    own = {"name": b"one", "kind": 1, "guid": description.guid.encode()} | changed
    found = byref(_Callbacks(cast(_log, c_void_p).value, (c_void_p * 3)(), None)) if callbacks else None
    resources = None if uri is None else (uri or f"file://{quote(folder)}/resources").encode()
    made = library.fmi2Instantiate(own["name"], own["kind"], own["guid"], resources, found, 0, 0)
    library.fmi2FreeInstance(c_void_p(made))
    return bool(made)


def instantiate(folder: str, uri: str, bare: str = "") -> None:
    print("INSTANCE", _instantiate(folder, None if uri == "NONE" else uri, not bare))


def refused(folder: str) -> None:
    for changed in ({"name": None}, {"name": b""}, {"kind": 0}, {"guid": b"another"}):
        print("INSTANCE", _instantiate(folder, **changed))


def interrupted(path: str) -> None:
    host = Host(path).begin()
    host.put("force", 669.0)
    attempt(lambda: host.doStep(0.0, 0.01))
    host.freeInstance()


def without_package(path: str) -> None:
    sys.modules["pydantic"] = None  # type: ignore[assignment]
    try:
        Host(path)
    except Exception as error:
        print("REFUSED", error)


if __name__ == "__main__":
    globals()[sys.argv[1]](*(argument for argument in sys.argv[2:] if argument != "logging"))
    print("ALIVE", flush=True)
