"""Instances, saved states, units and model descriptions, without any FMU."""

import math
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import comprope
from comprope.errors import InputError, SimulationError
from comprope.fmi import error_reporting
from comprope.fmi.instance import Instance, InstanceState, pack, unpack
from comprope.fmi.model_description import complete_description
from comprope.fmi.model_interface import ModelInterface, Variable, parameters_of
from comprope.fmi.package import Origin, build
from comprope.fmi.pythonfmu_slave import pythonfmu_description
from comprope.fmi.units import SYMBOLS, display_factor, exponents
from comprope.fmi.validation import step_problem
from comprope.quantities import Component, quantity

comprope.__path__.append(str(Path(__file__).parent / "fmi_toys"))
from comprope.spring.cosimulation import interface  # noqa: E402

REFS = {one.name: place for place, one in enumerate(interface(0.0).variables)}
FINITE = st.floats(allow_nan=False, allow_infinity=False)


def begun(**inputs: float) -> Instance:
    instance = Instance(interface(0.25))
    for name, value in inputs.items():
        instance.set_values("real", [REFS[name]], [value])
    instance.exit_initialization()
    return instance


def place(instance: Instance) -> Any:
    return instance.get_values("real", [REFS["place[1]"]])[0]


def stepped(instance: Instance, first: int, last: int) -> Instance:
    for count in range(first, last):
        instance.do_step(count * 0.01, 0.01)
    return instance


class Damper(Component):
    """Two quantities."""

    damping: float = quantity("N.s/m", "force per velocity", 0.0, 50.0, default=7.0, nominal=5.0)
    gap: float = quantity("m", "play", 0.001, 0.5)


def test_parameters_of_a_component() -> None:
    damping, gap = parameters_of("damper", Damper, {"gap": 0.25})
    assert damping == Variable("damper.damping", "real", "parameter", "force per velocity", "N.s/m", 7.0, 0.0, 50.0, 5.0)
    assert (gap.name, gap.start) == ("damper.gap", 0.25)


def test_outputs_before_the_run_follow_the_values_set() -> None:
    instance = Instance(interface(0.25))
    assert place(instance) == 0.25
    instance.set_values("real", [REFS["spring.place"]], [0.5])
    assert place(instance) == 0.5
    instance.exit_initialization()
    assert place(instance) == 0.5


@pytest.mark.parametrize(
    ("kind", "name", "value", "sentence"),
    [
        ("real", "place[1]", 1.0, "output place[1] = 1.0: an output cannot be set"),
        ("real", "spring.mass", math.inf, "parameter spring.mass = inf: 0.1 to 10 kg is accepted"),
        ("integer", "spring.mass", 1, "value reference 0: not of type integer"),
    ],
)
def test_a_refused_value_changes_nothing(kind: Any, name: str, value: Any, sentence: str) -> None:
    instance = Instance(interface(0.25))
    with pytest.raises(InputError) as caught:
        instance.set_values(kind, [REFS[name]], [value])
    assert str(caught.value) == sentence
    assert instance.get_values("real", [REFS["spring.mass"]]) == [2.0]


def test_no_step_before_the_run_begins() -> None:
    with pytest.raises(InputError, match="only after initialization has ended"):
        Instance(interface(0.25)).do_step(0.0, 0.01)


def test_integers_have_a_range() -> None:
    instance = Instance(interface(0.25))
    instance.set_values("integer", [REFS["mode"]], [7])
    with pytest.raises(InputError, match="parameter mode = 7: 0 to 3 is accepted"):
        instance.exit_initialization()


def test_a_failed_run_has_no_outputs_but_its_settings() -> None:
    instance = begun(force=0.5)
    instance.failure = "broken"
    with pytest.raises(InputError, match="the error was: broken"):
        place(instance)
    assert instance.get_values("real", [REFS["force"]]) == [0.5]


@pytest.mark.parametrize(
    ("time", "dt", "reached", "stop", "sentence"),
    [
        (1.0, 0.01, 1.0, None, None),
        (1.0 + 1e-12, 0.01, 1.0, None, None),  # what adding up steps drifts by
        (1e5, 1e-5, 1e5 + 1e-11, None, None),
        (1.0, 0.01, 1.0, 1.01, None),
        (1.0, math.inf, 1.0, None, "a finite number above 0"),
        (math.nan, 0.01, 1.0, None, "the time reached is 1.0 s"),
        (0.99, 0.01, 1.0, None, "to go back, restore a saved state"),
        (1.0, 0.02, 1.0, 1.01, "the stop time was set to 1.01 s"),
    ],
)
def test_steps(time: float, dt: float, reached: float, stop: float | None, sentence: str | None) -> None:
    problem = step_problem(time, dt, reached, stop)
    assert problem is sentence is None or (sentence or "-") in (problem or "")


def test_restored_runs_go_on_bit_for_bit() -> None:
    instance = stepped(begun(force=1.0 / 3.0), 0, 20)
    saved = instance.save_state("toy")
    expected = place(stepped(instance, 20, 50))
    instance.restore_state(saved, "toy")
    assert place(stepped(instance, 20, 50)) == expected
    other = begun(force=9.0)
    other.restore_state(saved, "toy")
    assert place(stepped(other, 20, 50)) == expected
    assert other.save_state("toy") == instance.save_state("toy")


def test_a_run_saved_before_it_began_can_begin_again() -> None:
    instance = Instance(interface(0.25))
    saved = instance.save_state("toy")
    instance.exit_initialization()
    instance.restore_state(saved, "toy")
    instance.set_values("real", [REFS["spring.mass"]], [3.0])
    instance.exit_initialization()
    assert instance.get_values("real", [REFS["spring.mass"]]) == [3.0]


@given(st.dictionaries(st.text(), FINITE | st.booleans() | st.integers() | st.text()), FINITE, st.none() | FINITE, st.binary())
def test_states_keep_every_bit(values: dict[str, Any], time: float, stop: float | None, simulator: bytes) -> None:
    state = InstanceState("toy", values, {}, values, 0.0, stop, time, 2, None)
    back, simulator_back = unpack(pack(state, simulator), "toy")
    assert repr(back) == repr(state)  # tells -0.0 from 0.0 and True from 1
    assert simulator_back == simulator


@given(st.binary(), st.integers(0, 400))
def test_other_bytes_are_refused(noise: bytes, cut: int) -> None:
    whole = Instance(interface(0.25)).save_state("toy")
    for data in (noise, whole[: cut % len(whole)], whole + b"x"):
        with pytest.raises(InputError, match="saved state"):
            unpack(data, "toy")


def test_outputs_that_are_not_finite_are_an_error() -> None:
    instance = begun(force=668.0)
    with pytest.raises(SimulationError, match=r"the model gave place\[1\] = nan"):
        instance.do_step(0.0, 0.01)


@pytest.mark.parametrize(
    ("unit", "powers"),
    [
        ("1", {}),
        ("N.m2", {"kg": 1, "m": 3, "s": -2}),
        ("N.s/m2", {"kg": 1, "m": -1, "s": -1}),
        ("kg.m2", {"kg": 1, "m": 2}),
        ("1/m", {"m": -1}),
        ("N.m.s", {"kg": 1, "m": 2, "s": -1}),
        ("rad/s", {"rad": 1, "s": -1}),
        ("m/s3", {"m": 1, "s": -3}),
        ("N/m2", SYMBOLS["Pa"]),
        ("N.m/s", SYMBOLS["W"]),
    ],
)
def test_units(unit: str, powers: dict[str, int]) -> None:
    assert exponents(unit) == powers


@pytest.mark.parametrize("unit", ["", "ft", "m/", "m1", "kg/m/s", "2", "N,m"])
def test_unknown_units_are_refused(unit: str) -> None:
    with pytest.raises(InputError, match="is not known"):
        exponents(unit)


def test_display_units_belong_to_their_unit() -> None:
    assert display_factor("mm", "m") == 1000.0
    with pytest.raises(InputError, match="display unit mm: not one of N"):
        display_factor("mm", "N")


def test_every_start_value_comes_back_from_the_description() -> None:
    model = interface(1.0 / 3.0)
    root = ET.fromstring(complete_description(pythonfmu_description(model), model, "1", "{guid}"))
    starts = [element[0].get("start") for element in root.iter("ScalarVariable")]
    assert float(starts[REFS["spring.place"]] or "nan") == 1.0 / 3.0
    assert starts[-1] is None


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"name": "force", "start": 0.0}, "force: declared more than once"),
        ({"start": None}, "spring.mass: parameters and inputs, and only they, have a start value"),
        ({"start": 11.0}, "parameter spring.mass = 11 kg: 0.1 to 10 kg is accepted"),
        ({"depends_on": ("place[1]",)}, "spring.mass: depends on place[1], which is no input"),
    ],
)
def test_interfaces_that_do_not_hold_together_are_refused(tmp_path: Path, change: dict[str, Any], sentence: str) -> None:
    model = interface(0.25)
    changed = replace(model, variables=(replace(model.variables[0], **change), *model.variables[1:]))
    with pytest.raises(InputError) as caught:
        build(changed, [], "", tmp_path, Origin("1", "MIT"))
    assert sentence in str(caught.value)
    assert not list(tmp_path.iterdir())


def test_a_model_that_does_not_load_leaves_no_file(tmp_path: Path) -> None:
    with pytest.raises(comprope.errors.CompropeError, match=r"Empty cannot be loaded: .*no_such_module"):
        build(
            ModelInterface("Empty", "Nothing", (), interface(0.0).create),
            [],
            "import no_such_module",
            tmp_path,
            Origin("1", "MIT"),
        )
    assert not list(tmp_path.iterdir())


@given(st.data())
def test_a_state_with_one_flipped_bit_is_refused(data: st.DataObject) -> None:
    state = bytearray(stepped(begun(), 0, 5).save_state("toy"))
    bit = data.draw(st.integers(0, 8 * len(state) - 1))
    state[bit // 8] ^= 1 << bit % 8
    with pytest.raises(InputError, match=r"not a whole state of this FMU|made by"):
        begun().restore_state(bytes(state), "toy")


def test_an_internal_error_is_one_line_with_its_place() -> None:
    try:
        raise KeyError("two\nlines")
    except KeyError as error:
        text = error_reporting.sentence(error)
    place = "test_an_internal_error_is_one_line_with_its_place, test_fmi_without_fmu.py"
    assert text.startswith(f"internal error: KeyError in {place}:")
    assert "\n" not in text


def test_a_host_without_standard_error_is_spared(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stderr", None)
    error_reporting.report("unheard")
