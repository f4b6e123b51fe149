"""The native FMU for FMI 3.0: valid, and the same rope as for FMI 2.0 to the last bit."""

import ctypes
import random
import re
import subprocess
import sys
import zipfile
from collections.abc import Callable, Iterable, Iterator
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
ARRAY = [one.name for one in tower().variables].index("lateral_displacement[1]")

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


TOLD = ("causality", "variability", "initial", "unit", "min", "max", "nominal")


def variables_by_name(path: Path) -> dict[str, Any]:
    return {one.name: one for one in read_model_description(str(path)).modelVariables}


def test_the_same_variables_as_in_fmi_2_but_for_arrays(fmu: Path) -> None:
    """An array has the reference of its first element, and what its elements have in common."""
    two, three = variables_by_name(native_fmu()), variables_by_name(fmu)
    time = three.pop("time")
    assert (time.valueReference, time.description, time.causality) == (TIME, "time reached", "independent")
    arrays = {name: one for name, one in three.items() if one.dimensions}
    assert set(arrays) == {"sensors.height", "sensors.on_counterweight_side", "lateral_displacement", "in_view"}
    assert {one.shape for one in arrays.values()} == {(4,)}
    elements = {name: [one for other, one in two.items() if re.sub(r"\[\d+\]", "", other) == name] for name in three}
    assert sum(map(len, elements.values())) == len(two)
    for name, one in three.items():
        assert all([getattr(part, what) for what in TOLD] == [getattr(one, what) for what in TOLD] for part in elements[name])
        starts = [part.start for part in elements[name] if part.start is not None]
        assert one.valueReference == elements[name][0].valueReference and (one.start or "").split() == starts
        assert name in arrays or one.description == elements[name][0].description


def test_arrays_are_read_and_set_whole(pair: Pair3) -> None:
    """Beside scalars, with the values of each array one after the other."""
    names = variables_by_name(native_fmu("native_fmi3"))
    heights, mass = names["sensors.height"].valueReference, names["sheave.mass"].valueReference
    read = ["sheave_force", "lateral_displacement", "energy_residual"]
    pair.instance.setFloat64([heights, mass], [0.25, 0.5, 0.75, -0.1, 90.0])
    pair.oracle.instance.set_values(
        "real", [pair.references[f"sensors[{k}].height"] for k in (1, 2, 3, 4)], [0.25, 0.5, 0.75, -0.1]
    )
    pair.oracle.instance.set_values("real", [pair.references["sheave.mass"]], [90.0])
    assert pair.instance.getFloat64([mass, heights], 5) == [90.0, 0.25, 0.5, 0.75, -0.1]
    pair.start_with(SMALL)
    pair.get_all()
    found = pair.instance.getFloat64([names[name].valueReference for name in read], 6)
    scalars = [found[0], *found[1:5], found[5]]
    wanted = ["sheave_force", *(f"lateral_displacement[{k}]" for k in (1, 2, 3, 4)), "energy_residual"]
    assert scalars == pair.oracle.instance.get_values("real", [pair.references[name] for name in wanted])


def test_fmpy_records_the_sensors_as_an_array(fmu: Path) -> None:
    names = [f"lateral_displacement[{k}]" for k in (1, 2, 3, 4)]
    settings = {"stop_time": 0.5, "step_size": 0.01, "output_interval": 0.1}
    three = simulate_fmu(
        str(fmu), output=["lateral_displacement", "in_view"], start_values={"sensors.height": [1.0, 2.0, 3.0, 4.0]}, **settings
    )
    starts = {f"sensors[{k}].height": float(k) for k in (1, 2, 3, 4)}
    two = simulate_fmu(str(native_fmu()), output=names, start_values=starts, **settings)
    assert three["in_view"].shape == (6, 4)
    assert np.array_equal(three["lateral_displacement"], np.column_stack([two[name] for name in names]))


def test_both_depend_on_the_same(fmu: Path) -> None:
    def whole(names: Iterable[str]) -> list[str]:
        return list(dict.fromkeys(re.sub(r"\[\d+\]", "", name) for name in names))

    def structure(path: Path) -> list[dict[str, list[str]]]:
        found = read_model_description(str(path))
        return [
            {whole([one.variable.name])[0]: whole(on.name for on in one.dependencies) for one in unknowns}
            for unknowns in (found.outputs, found.initialUnknowns)
        ]

    assert structure(fmu) == structure(native_fmu())


def test_the_same_bits_as_in_fmi_2_and_the_reference_result(fmu: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(fmu) as archive:
        given, expected = (read_csv(archive.extract(name, tmp_path)) for name in (INPUT_FILE, OUTPUT_FILE))
    names = [name for name in expected.dtype.names if name != "time"]
    arrays = list(dict.fromkeys(re.sub(r"\[\d+\]", "", name) for name in names))
    same = {"stop_time": 4.0, "step_size": 0.01, "output_interval": 0.01, "input": given}
    two = simulate_fmu(str(native_fmu()), **same, output=names)
    three = simulate_fmu(str(fmu), **same, output=arrays)
    columns = np.column_stack([three[name] for name in arrays])
    order = sorted(names, key=lambda name: arrays.index(re.sub(r"\[\d+\]", "", name)))
    for k, name in enumerate(order):
        assert np.array_equal(two[name], columns[:, k]), name
        assert columns[::5, k] == pytest.approx(expected[name], rel=1e-6, abs=1e-6), name  # nine digits are in the file


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
(time,) = slave.getFloat64([next(one.valueReference for one in description.modelVariables if one.name == "time")])
slave.doStep(time, 0.01)
reals = [one.valueReference for one in description.modelVariables if one.type == "Float64"]
count = sum(one.shape[0] if one.dimensions else 1 for one in description.modelVariables if one.type == "Float64")
print(" ".join(value.hex() for value in slave.getFloat64(reals, count)))
"""


def test_a_state_goes_on_in_another_process(pair: Pair3, fmu: Path, tmp_path: Path) -> None:
    pair.start(SMALL)
    for k in range(20):
        pair.set_reals(["car_position", "counterweight_position"], [1e-4 * k * k, 1.0 - 1e-4 * k * k])
        pair.do_step(0.01)
    (tmp_path / "state").write_bytes(pair.instance.serializeFMUState(pair.instance.getFMUState()))
    pair.do_step(0.01)
    chosen = [one for one in pair.description.modelVariables if one.type == "Float64"]
    reals, count = [one.valueReference for one in chosen], sum(one.shape[0] if one.dimensions else 1 for one in chosen)
    command = [sys.executable, "-c", APART, str(fmu), str(tmp_path / "state")]
    root = Path(__file__).parent.parent
    found = subprocess.run(command, capture_output=True, text=True, check=True, cwd=root).stdout
    assert found.split() == [value.hex() for value in pair.instance.getFloat64(reals, count)]


WRONG: dict[str, tuple[Callable[[Any], Any], str]] = {
    "other type": (lambda one: one.getFloat32([HEIGHT]), "no variables of type Float32"),
    "other integers": (lambda one: one.getInt64([HEIGHT]), "no variables of type Int64"),
    "clocks": (lambda one: one.getClock([HEIGHT]), "no variables of type Clock"),
    "real as boolean": (lambda one: one.getBoolean([HEIGHT]), "value reference 0: not of type boolean"),
    "nonsense": (lambda one: one.getFloat64([TIME, TIME + 1]), f"value reference {TIME + 1}: not of type real"),
    "time": (lambda one: one.setFloat64([TIME], [1.0]), f"value reference {TIME}: not of type real"),
    "two values for one": (lambda one: one.getFloat64([HEIGHT], 2), "2 values are given; these variables have 1"),
    "one value of an array": (lambda one: one.getFloat64([ARRAY]), "1 values are given; these variables have 4"),
    "element of an array": (lambda one: one.getFloat64([ARRAY + 2]), f"value reference {ARRAY + 2}: not of type real"),
    "set an output": (lambda one: one.setFloat64([ARRAY], [0.0] * 4), "lateral_displacement[4] = 0: an output cannot be set"),
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
