"""The drive's native FMU: valid, the numbers of the drive in Python, its refusals, its states."""

import random
import re
import shutil
import subprocess
import xml.etree.ElementTree as ET
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.util import read_csv
from fmpy.validation import validate_fmu

from comprope.errors import CompropeError
from comprope.fmi.model_description import complete_description
from comprope.fmi.pythonfmu_slave import pythonfmu_description
from comprope.fmi.reference_result import OUTPUT_FILE
from comprope.native import linker
from comprope.native.targets import TARGETS

from .fmi3_pair import Pair3
from .fmi_pair import ODD, Pair
from .native_fmu import compiler, drive, native_fmu

pytestmark = compiler
NOMINAL = [one.nominal or 1.0 for one in drive().variables]
AGREEMENT = 1e-9  # of nominal: native kernels with their own design, in Python with python-control's
LOPSIDED = (0.9, 1.0, 0.5, 0.6, 0.3, 0.2, 0.1, 0.0, -0.1, 0.2, -0.3, -0.2, -0.1, -0.2, -0.4, -0.5, -0.7, -0.8, -0.5)
ROPES = {"car_end_tension": 1250.0, "counterweight_end_tension": 660.0}


class DrivePair(Pair):
    """An instance of the native drive and the drive in Python, which must agree to nine digits."""

    def agree(self, references: list[int], found: list[Any], expected: list[Any]) -> bool:
        return all(abs(a - b) <= AGREEMENT * NOMINAL[k] for k, a, b in zip(references, found, expected, strict=True))

    def _refused(self, call: Any, why: CompropeError) -> None:
        super()._refused(call, why)
        self.why = str(why)

    def require_same_words(self) -> None:
        """What was refused last was refused with the sentence of the drive in Python."""
        assert self.messages[0].partition(" s: ")[2] == self.why


@pytest.fixture(scope="module")
def fmu() -> Path:
    return native_fmu("native", "ElevatorDrive")


@pytest.fixture
def pair(fmu: Path) -> Iterator[DrivePair]:
    made = DrivePair(fmu, drive())
    yield made
    made.free()


@pytest.mark.parametrize("ending", ["native", "native_fmi3"])
def test_valid_and_without_python(ending: str) -> None:
    fmu = native_fmu(ending, "ElevatorDrive")
    assert validate_fmu(str(fmu)) == []
    with zipfile.ZipFile(fmu) as archive:
        assert not any(name.endswith(".py") for name in archive.namelist())
        assert "pip install" not in archive.read("documentation/index.html").decode()


def test_same_description_as_the_fmu_in_python(fmu: Path) -> None:
    other = ET.fromstring(complete_description(pythonfmu_description(drive()), drive(), "1.2.3", ""))
    with zipfile.ZipFile(fmu) as archive:
        own = ET.fromstring(archive.read("modelDescription.xml"))
    for tag in ("ModelVariables", "ModelStructure", "UnitDefinitions", "DefaultExperiment"):
        assert [(one.tag, one.attrib) for one in own.find(tag).iter()] == [
            (one.tag, one.attrib) for one in other.find(tag).iter()
        ]


@pytest.mark.skipif(not shutil.which("nm"), reason="nm is not installed")
def test_needs_nothing_but_the_c_library(fmu: Path, tmp_path: Path) -> None:
    target = TARGETS[linker.host_target()]
    with zipfile.ZipFile(fmu) as archive:
        binary = archive.extract(f"binaries/{target.folder}/ElevatorDrive.{target.extension}", tmp_path)
    listed = subprocess.run(["nm", "-D", binary], capture_output=True, text=True, check=True).stdout
    needed = {line.split()[-1].partition("@")[0] for line in listed.splitlines() if line.split()[-2] == "U"}
    memory = {"calloc", "free", "memcpy", "memset", "memcmp", "bcmp", "memmove", "strcmp", "strncpy"}
    text = {"snprintf", "vsnprintf", "__snprintf_chk", "__vsnprintf_chk", "__stack_chk_fail"}
    assert needed <= memory | text | {"exp", "exp2", "log", "log2", "log1p", "pow", "ceil", "fmax", "fmin", "sqrt", "sin", "cos"}


# -- the same numbers ----------------------------------------------------------------------------

CASES: dict[str, dict[str, float]] = {
    "as declared": {},
    "free form, smoothed and shaped": {f"curve.a{k}": value for k, value in enumerate(LOPSIDED, 1)}
    | {"profile.smoothing": 0.7, "shaper.impulses": 3.0, "shaper.tolerance": 0.05, "shaper.damping": 0.02}
    | {"trip.destination": 6.0},
    "other plant": {
        "shaft.height": 30.0, "trip.start_position": 28.0, "trip.destination": 12.0, "destination": 12.0,
        "plant.car_mass": 2600.0, "plant.rope_stiffness": 1e7, "servo.sample_period": 0.004,
        "servo.position_bandwidth": 2.0, "rope.count": 6.0,
    },
    "motor at its limit": {
        "servo.torque_limit": 1900.0, "plant.car_mass": 2600.0, "servo.position_bandwidth": 2.0, "trip.destination": 8.0,
    },
    "without mass and damping": {"plant.rope_mass_per_length": 0.0, "plant.rope_damping": 0.0, "trip.destination": 3.0},
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_same_numbers_as_in_python(pair: DrivePair, name: str) -> None:
    """Through a trip and a call after it, in steps that end between the controller's samples too."""
    pair.start(CASES[name] | ROPES)
    pair.get_all()
    for count in range(900):
        pair.do_step((0.01, 0.0233, 0.0041, 0.03)[count % 4])
        if count == 300:
            pair.set_reals(["destination"], [1.0])
        if count % 10 == 0:
            pair.set_reals(list(ROPES), [1250.0 + 0.3 * count, 660.0 - 0.1 * count])
            pair.get_all()
    pair.get_all()
    assert pair.refusals == 0


TRIPS = {
    "brake": ({"brake.torque": 900.0}, {"brake": 1.0}),
    "slipping brake": ({"brake.torque": 1e5, "brake.rise_time": 0.0}, {"brake": 0.8}),
    "safety gear": ({"safety_gear.upward_share": 0.3}, {"safety_gear": 1.0}),
    "buffer": ({"trip.overrun": 5.0, "buffer.deceleration": 9.81, "buffer.stiffness": 1e4}, {}),
}


@pytest.mark.parametrize("name", TRIPS)
def test_the_same_trips_as_in_python(pair: DrivePair, name: str) -> None:
    """Slack ropes, slip, what brake and gear hold, and the release of both."""
    changes, levels = TRIPS[name]
    down = {"trip.start_position": 10.0, "trip.destination": 0.0, "destination": 0.0, "plant.rope_damping": 2e5}
    pair.start(down | changes | ROPES)
    for count in range(700):
        pair.do_step((0.01, 0.0233, 0.0041, 0.012)[count % 4])
        if count == 300:
            pair.set_reals(list(levels), list(levels.values()))
        if count == 640:
            pair.set_reals(["brake", "safety_gear"], [0.0, 0.0])
        if count % 20 == 0:
            pair.get_all()
    pair.get_all()
    assert pair.refusals == 0
    assert pair.oracle.instance.simulator.outputs()["tripped"]


def test_a_state_from_before_a_trip_has_not_tripped(pair: DrivePair) -> None:
    """And one from after it has: restored either way, the run goes on as in Python."""
    pair.start({"trip.destination": 0.0, "trip.start_position": 10.0, "destination": 0.0} | ROPES)
    pair.do_step(3.0)
    pair.save_state()
    pair.set_reals(["safety_gear"], [1.0])
    pair.do_step(0.3)
    pair.save_state()
    for serialized in (False, True):
        for place, tripped in ((0, False), (1, True)):
            pair.restore_state(place, serialized)
            pair.do_step(0.2)
            pair.get_all()
            assert pair.oracle.instance.simulator.outputs()["tripped"] == tripped
    assert pair.refusals == 0


def test_tensions_that_come_with_the_first_step_belong_to_the_equilibrium(pair: DrivePair) -> None:
    pair.start({})
    pair.set_reals(list(ROPES), list(ROPES.values()))
    for _ in range(50):
        pair.do_step(0.02)
    pair.get_all()
    at = pair.references["car_position"]
    assert pair.instance.getReal([at])[0] == 0.0


@pytest.mark.parametrize("last", [1e-5, 1e-7, 1e-9, 1e-12, 4e-14])
def test_outputs_are_continuous_in_the_length_of_the_last_step(pair: DrivePair, last: float) -> None:
    """Except for the torque, which is that of the controller's last sample."""
    pair.start(dict(ROPES))
    for _ in range(150):
        pair.do_step(0.01)
    continuous = [one for one in drive().of_role("output") if one.kind == "real" and one.name != "motor_torque"]
    outputs = [pair.references[one.name] for one in continuous]
    before = pair.instance.getReal(outputs)
    pair.do_step(last)
    pair.get_all()
    for one, value, other in zip(continuous, pair.instance.getReal(outputs), before, strict=True):
        rate = 10.0 if one.unit != "N" else 1e6  # m/s, m/s2, m/s3, and N/s
        assert value == pytest.approx(other, abs=rate * last + 1e-12), one.name
    assert pair.refusals == 0


def test_the_same_bits_in_fmi_3_and_the_reference_result(fmu: Path, tmp_path: Path) -> None:
    with zipfile.ZipFile(fmu) as archive:
        expected = read_csv(archive.extract(OUTPUT_FILE, tmp_path))
    names = [name for name in expected.dtype.names if name != "time"]
    same: dict[str, Any] = {"stop_time": 4.0, "step_size": 0.001, "output_interval": 0.05, "output": names}
    two, three = (simulate_fmu(str(native_fmu(ending, "ElevatorDrive")), **same) for ending in ("native", "native_fmi3"))
    for name in names:
        assert np.array_equal(two[name], three[name]), name
        assert two[name] == pytest.approx(expected[name], rel=1e-6, abs=1e-6), name


# -- errors --------------------------------------------------------------------------------------

REFUSED: list[tuple[dict[str, float], str]] = [
    ({"profile.speed": -1.0, "plant.car_mass": 1.0}, "parameter profile.speed = -1 m/s: 0.01 to 25 m/s is accepted"),
    ({"trip.destination": 60.0}, "trip.destination = 60 m: accepted is 0 to shaft.height = 50 m"),
    ({"trip.start_position": 51.0, "trip.destination": 60.0}, "trip.start_position = 51 m and trip.destination = 60 m: accepted"),
    ({"profile.smoothing": 0.001, "shaper.impulses": 2.5}, "profile: smoothing = 0.001 s: accepted is 0 (none) or 0.01 to 20 s"),
    ({"curve.a1": 0.5}, "curve: the sum of a1 to a19 is 0.5: accepted is 0, so that the car stops"),
    ({"curve.a1": -0.5, "curve.a2": 0.5}, "curve: a1, a1 + a2 and so on: no sum below 0 is accepted"),
    ({"servo.torque_limit": 100.0}, "servo.torque_limit = 100 N.m: more than the 441.45 N.m that hold the car initially"),
    ({"servo.speed_bandwidth": 190.0}, "unstable with the car at 0 m and 25 m and 50 m; gains are accepted that"),
    ({"servo.speed_bandwidth": 190.0, "servo.torque_limit": 100.0}, "hold the car initially is accepted; servo.position_band"),
    ({"shaft.height": 30.0, "trip.destination": 9.0, "destination": 40.0}, "destination = 40 m: 0 to shaft.height = 30 m"),
]


@pytest.mark.parametrize(("values", "sentence"), REFUSED)
def test_what_cannot_be_is_refused_at_the_start_in_the_same_words(
    pair: DrivePair, values: dict[str, float], sentence: str
) -> None:
    pair.set_reals(list(values), list(values.values()))
    pair.enter_initialization()
    pair.exit_initialization()
    assert pair.refusals == 1 and sentence in pair.messages[0]
    pair.require_same_words()


def test_a_first_trip_before_the_start_is_refused(pair: DrivePair) -> None:
    pair.setup_experiment(5.0, None)
    pair.enter_initialization()
    pair.exit_initialization()
    assert "trip.start_time = 1 s: the start of the simulation, 5 s, or later is accepted" in pair.messages[0]
    pair.require_same_words()


def test_what_cannot_be_is_refused_on_the_way_and_taken_back(pair: DrivePair) -> None:
    pair.start({"shaft.height": 40.0, "trip.destination": 20.0, "destination": 20.0})
    pair.do_step(0.5)
    pair.save_state()
    pair.set_reals(["destination"], [45.0])
    pair.do_step(0.5)
    assert "destination = 45 m: 0 to shaft.height = 40 m is accepted" in pair.messages[0]
    pair.require_same_words()
    pair.restore_state(0, serialized=True)
    pair.do_step(1001.0)
    assert "communication step = 1001 s: at most 1000 s is accepted" in pair.messages[0]
    pair.restore_state(0, serialized=False)
    pair.do_step(3.0)
    pair.get_all()
    assert pair.refusals == 2


def test_a_motor_too_weak_on_the_way_is_an_error(pair: DrivePair) -> None:
    pair.start({"servo.torque_limit": 500.0})
    while not pair.refusals and pair.oracle.instance.time < 60.0:
        pair.do_step(0.25)
    pair.require_same_words()
    assert re.search(r"car at .* m at t = .* s has left the shaft of 0 to 50 m: servo.torque_limit = 500", pair.messages[0])


# -- states --------------------------------------------------------------------------------------


def test_a_serialized_state_with_one_flipped_bit_is_refused(pair: DrivePair) -> None:
    pair.start({})
    pair.do_step(1.5)
    pair.require_flipped_bits_refused()


def test_a_state_goes_on_bit_for_bit_in_an_instance_with_other_parameters(fmu: Path) -> None:
    def outputs(one: Any) -> list[float]:
        return list(one.getReal(list(range(len(drive().variables) - 18, len(drive().variables) - 4))))

    one, two = DrivePair(fmu, drive()), DrivePair(fmu, drive())
    one.start({"plant.car_mass": 1500.0, "trip.destination": 4.0})
    two.start({"shaft.height": 12.0, "trip.destination": 4.0, "destination": 5.0})
    for count in range(400):
        one.do_step((0.01, 0.0033)[count % 2])
    time = one.oracle.instance.time
    two.instance.setFMUState(two.instance.deserializeFMUState(one.instance.serializeFMUState(one.instance.getFMUState())))
    for slave in (one.instance, two.instance):
        slave.doStep(time, 1.2345)
    assert outputs(one.instance) == outputs(two.instance)
    for each in (one, two):
        each.free()


# -- any call ------------------------------------------------------------------------------------

SMALL = {"shaft.height": 3.0, "trip.destination": 2.0, "destination": 2.0}


def random_call(pair: Pair, generator: random.Random) -> None:
    """One call of any kind; most make sense, so that runs get somewhere."""
    if (pair.oracle.instance.failure or pair.oracle.phase != 2) and generator.random() < 0.3:
        pair.start(SMALL)
    steps = (0.01, 0.0333, 0.5, 1e-7, 0.0, -0.01, float("nan"), 1e300)
    kinds = [
        (30, lambda: pair.do_step(generator.choice(steps[:3]))),
        (10, lambda: pair.set_reals(["destination"], [generator.choice((0.0, 1.0, 3.0, 4.0))])),
        (10, lambda: pair.set_reals(list(ROPES), [generator.uniform(0.0, 2000.0) for _ in ROPES])),
        (1, lambda: pair.set_reals(["brake", "safety_gear"], [generator.choice((0.0, 1.0, 2.0)) for _ in range(2)])),
        (12, pair.get_all),
        (3, lambda: pair.start(SMALL)),
        (4, pair.save_state),
        (5, lambda: pair.restore_state(generator.randrange(9), generator.random() < 0.5)),
        (3, lambda: pair.free_state(generator.randrange(9))),
        (2, lambda: pair.do_step(generator.choice(steps), generator.choice((0.0, 0.0, 1.0, -0.01)))),
        (5, lambda: _set_any(pair, generator)),
        (1, lambda: pair.get_any_reference(generator.choice((0, 5, 60, 70, 2**32 - 1)))),
        (1, pair.enter_initialization), (1, pair.exit_initialization), (1, pair.terminate), (1, pair.reset),
        (1, pair.instantiate_again),
        (1, lambda: pair.setup_experiment(generator.choice((0.0, 5.0)), generator.choice((None, 5.1)))),
    ]  # fmt: skip
    generator.choices([call for _, call in kinds], [weight for weight, _ in kinds])[0]()


def _set_any(pair: Pair, generator: random.Random) -> None:
    one = generator.choice([one for one in pair.oracle.interface.variables if one.kind == "real"])
    value = generator.choice((*ODD, one.minimum, one.maximum, one.start))
    pair.set_reals([one.name], [float(value or 0.0)])


class DrivePair3(Pair3, DrivePair):
    """The same for FMI 3.0."""


@pytest.mark.parametrize(("kind", "ending"), [(DrivePair, "native"), (DrivePair3, "native_fmi3")])
def test_thousands_of_calls(kind: type[DrivePair], ending: str) -> None:
    pair, generator = kind(native_fmu(ending, "ElevatorDrive"), drive()), random.Random(11)
    pair.start(SMALL)
    while pair.calls < 1500:
        random_call(pair, generator)
    assert 0 < pair.refusals < 0.4 * pair.calls
    pair.free()


def test_it_is_loaded_by_its_name(fmu: Path) -> None:
    description = read_model_description(str(fmu))
    assert description.coSimulation.modelIdentifier == "ElevatorDrive"
    assert any(Path(extract(str(fmu))).glob("binaries/*/ElevatorDrive.*"))
