"""The native FMU for FMI 3.0: valid, and the same rope as for FMI 2.0 to the last bit."""

import ctypes
import random
import re
import subprocess
import sys
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Model
from fmpy.util import read_csv
from fmpy.validation import validate_fmu
from lxml import etree

from comprope.fmi.reference_result import INPUT_FILE, OUTPUT_FILE

from .fmi3_pair import Pair3, Slave
from .fmi_pair import SMALL, random_call
from .native_fmu import compiler, native_fmu, tower

FMPY = Path(fmpy.__file__).parent
TIME = len(tower().variables)  # the reference of the time
HEIGHT = 0  # that of a Float64

pytestmark = compiler


@pytest.fixture(scope="module")
def fmu() -> Path:
    return native_fmu("native_fmi3")


@pytest.fixture
def pair(fmu: Path) -> Iterator[Pair3]:
    made = Pair3(fmu, tower())
    yield made
    made.free()


def test_valid_and_complete(fmu: Path) -> None:
    assert validate_fmu(str(fmu)) == []
    with zipfile.ZipFile(fmu) as archive:
        names = set(archive.namelist())
        page = archive.read("documentation/index.html").decode()
        icons = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
    etree.XMLSchema(etree.parse(FMPY / "schema" / "fmi3" / "fmi3TerminalsAndIcons.xsd")).assertValid(icons)
    assert {"terminalsAndIcons/icon.png", "documentation/licenses/license.txt"} <= names
    assert "FMI 3.0 co-simulation" in page and "fmi3Error" in page and "fmi2" not in page


def test_the_terminals_of_drive_and_rope_fit_each_other() -> None:
    """By the rule "plug": as many members of the same names; an output on one side is an input on the other."""
    found = {}
    for name in ("CompensationRope", "ElevatorDrive"):
        path = native_fmu("native_fmi3", name)
        with zipfile.ZipFile(path) as archive:
            (terminal,) = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml")).iter("Terminal")
        roles = {one.name: one.causality for one in read_model_description(str(path)).modelVariables}
        assert terminal.get("matchingRule") == "plug"
        found[name] = {one.get("memberName"): roles[one.get("variableName")] for one in terminal}
    rope, drive = found.values()
    assert set(rope) == set(drive) and len(rope) == 8
    assert all({rope[name], drive[name]} == {"input", "output"} for name in rope)


def test_every_function_of_the_standard_is_there(fmu: Path) -> None:
    """The standard demands even those of interface types that an FMU does not have."""
    header = (FMPY / "c-code" / "fmi3Functions.h").read_text()
    declared = set(re.findall(r"^FMI3_Export fmi3\w+TYPE +(fmi3\w+);", header, re.MULTILINE))
    binary = ctypes.CDLL(str(next(Path(extract(str(fmu))).glob("binaries/*/*"))))
    assert len(declared) > 70 and [name for name in sorted(declared) if not hasattr(binary, name)] == []


def test_the_same_variables_as_in_fmi_2(fmu: Path) -> None:
    told = ("valueReference", "description", "causality", "variability", "initial", "unit", "start", "min", "max", "nominal")
    two, three = (
        {one.name: [getattr(one, what) for what in told] for one in read_model_description(str(path)).modelVariables}
        for path in (native_fmu(), fmu)
    )
    assert three.pop("time")[:3] == [TIME, "time reached", "independent"]
    assert two == three


def test_both_depend_on_the_same(fmu: Path) -> None:
    def structure(path: Path) -> list[list[tuple[str, list[str] | None]]]:
        found = read_model_description(str(path))
        return [
            [(one.variable.name, None if one.dependencies is None else [on.name for on in one.dependencies]) for one in unknowns]
            for unknowns in (found.outputs, found.initialUnknowns)
        ]

    assert structure(fmu) == structure(native_fmu())


def test_the_same_bits_as_in_fmi_2_and_the_reference_result(fmu: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(fmu) as archive:
        given, expected = (read_csv(archive.extract(name, tmp_path)) for name in (INPUT_FILE, OUTPUT_FILE))
    names = [name for name in expected.dtype.names if name != "time"]
    same = {"stop_time": 4.0, "step_size": 0.01, "output_interval": 0.01, "input": given, "output": names}
    two, three = (simulate_fmu(str(path), **same) for path in (native_fmu(), fmu))
    for name in names:
        assert np.array_equal(two[name], three[name]), name
        assert three[name][::5] == pytest.approx(expected[name], rel=1e-6, abs=1e-6), name  # nine digits are in the file


def test_thousands_of_calls(pair: Pair3) -> None:
    generator = random.Random(11)
    pair.start(SMALL)
    while pair.calls < 4000:
        random_call(pair, generator)
    assert 0 < pair.refusals < 0.3 * pair.calls


APART = """\
import sys
from fmpy import extract, read_model_description
from tests.fmi3_pair import Slave

fmu, state = sys.argv[1:]
description = read_model_description(fmu)
slave = Slave(guid=description.guid, unzipDirectory=extract(fmu), modelIdentifier="CompensationRope", instanceName="apart")
slave.instantiate()
slave.setFMUState(slave.deserializeFMUState(open(state, "rb").read()))
(time,) = slave.getFloat64([len(description.modelVariables) - 1])
slave.doStep(time, 0.01)
reals = [one.valueReference for one in description.modelVariables if one.type == "Float64"]
print(" ".join(value.hex() for value in slave.getFloat64(reals)))
"""


def test_a_state_goes_on_in_another_process(pair: Pair3, fmu: Path, tmp_path: Path) -> None:
    pair.start(SMALL)
    for k in range(20):
        pair.set_reals(["car_position", "counterweight_position"], [1e-4 * k * k, 1.0 - 1e-4 * k * k])
        pair.do_step(0.01)
    (tmp_path / "state").write_bytes(pair.instance.serializeFMUState(pair.instance.getFMUState()))
    pair.do_step(0.01)
    reals = [one.valueReference for one in pair.description.modelVariables if one.type == "Float64"]
    command = [sys.executable, "-c", APART, str(fmu), str(tmp_path / "state")]
    root = Path(__file__).parent.parent
    found = subprocess.run(command, capture_output=True, text=True, check=True, cwd=root).stdout
    assert found.split() == [value.hex() for value in pair.instance.getFloat64(reals)]


WRONG: dict[str, tuple[Callable[[Any], Any], str]] = {
    "other type": (lambda one: one.getFloat32([HEIGHT]), "no variables of type Float32"),
    "other integers": (lambda one: one.getInt64([HEIGHT]), "no variables of type Int64"),
    "clocks": (lambda one: one.getClock([HEIGHT]), "no variables of type Clock"),
    "real as boolean": (lambda one: one.getBoolean([HEIGHT]), "value reference 0: not of type boolean"),
    "nonsense": (lambda one: one.getFloat64([TIME, TIME + 1]), f"value reference {TIME + 1}: not of type real"),
    "time": (lambda one: one.setFloat64([TIME], [1.0]), f"value reference {TIME}: not of type real"),
    "two values for one": (lambda one: one.getFloat64([HEIGHT], 2), "one value reference and one value are needed"),
    "parameter later": (lambda one: one.setFloat64([HEIGHT], [50.0]), "fixed once the run has started"),
    "events": (lambda one: one.enterEventMode(), "no event mode"),
    "structure": (lambda one: one.enterConfigurationMode(), "no parameter changes the structure"),
    "states": (lambda one: one.fmi3GetContinuousStates(one.component, None, 0), "for co-simulation only"),
    "no places": (lambda one: one.fmi3DoStep(one.component, 0.0, 0.01, True, None, None, None, None), "places for what a step"),
    "initialization twice": (lambda one: one.enterInitializationMode(), "only before initialization"),
    "derivatives": (lambda one: one.getDirectionalDerivative([55], [47], [1.0]), "derivatives are not offered"),
}  # fmt: skip


@pytest.mark.parametrize("what", WRONG)
def test_a_wrong_call_is_told_and_can_be_taken_back(pair: Pair3, what: str) -> None:
    call, sentence = WRONG[what]
    pair.start(SMALL)
    pair.do_step(0.01)
    pair.save_state()
    with pytest.raises(FMICallException):
        call(pair.instance)
    assert sentence in pair.messages[0]
    pair.restore_state(0, serialized=False)
    pair.do_step(0.01)
    pair.get_all()


@pytest.mark.parametrize(
    ("changes", "settings", "sentence"),
    [
        ({"guid": "another"}, {}, "the instantiation token is not this FMU's"),
        ({"instanceName": ""}, {}, "an instance needs a name"),
        ({}, {"eventModeUsed": True}, "no event mode"),
        ({}, {"requiredIntermediateVariables": [55]}, "nothing between the ends of steps"),
        (None, {}, "for co-simulation only"),
    ],
)
def test_what_it_is_not_made_for(fmu: Path, changes: dict[str, str] | None, settings: dict[str, Any], sentence: str) -> None:
    description, heard = read_model_description(str(fmu)), list[str]()
    names = {"guid": description.guid, "modelIdentifier": "CompensationRope", "instanceName": "one"} | (changes or {})
    instance = (FMU3Model if changes is None else Slave)(unzipDirectory=extract(str(fmu)), **names)
    with pytest.raises(Exception, match="Failed to instantiate FMU"):
        instance.instantiate(logMessage=lambda _environment, _status, _category, text: heard.append(text.decode()), **settings)
    assert len(heard) == 1 and sentence in heard[0]
