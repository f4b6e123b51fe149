"""Limits of what an FMU's instance accepts, each from both sides."""

import math
from pathlib import Path

import pytest

import comprope
from comprope.errors import InputError
from comprope.fmi.instance import Instance
from comprope.fmi.validation import step_problem

comprope.__path__.append(str(Path(__file__).parent / "fmi_toys"))
from comprope.spring.cosimulation import interface  # noqa: E402

REFS = {one.name: place for place, one in enumerate(interface(0.0).variables)}


def begun(**values: float) -> Instance:
    instance = Instance(interface(0.25))
    for name, value in values.items():
        instance.set_values("real", [REFS[f"spring.{name}"]], [value])
    instance.exit_initialization()
    return instance


def place(instance: Instance) -> object:
    return instance.get_values("real", [REFS["place[1]"]])[0]


@pytest.mark.parametrize("value", [0.1, 10.0])
def test_both_ends_of_a_range_are_accepted(value: float) -> None:
    assert begun(mass=value).get_values("real", [REFS["spring.mass"]]) == [value]


@pytest.mark.parametrize("value", [math.nextafter(0.1, 0.0), math.nextafter(10.0, 11.0)])
def test_nothing_beyond_a_range_is_accepted(value: float) -> None:
    with pytest.raises(InputError, match=r"0\.1 to 10 kg is accepted"):
        begun(mass=value)


@pytest.mark.parametrize("dt", [0.0, -0.01, math.nan, math.inf])
def test_a_step_takes_time(dt: float) -> None:
    assert "a finite number above 0 is accepted" in (step_problem(1.0, dt, 1.0, None) or "")


@pytest.mark.parametrize("drift", [1e-4, -1e-4])
def test_a_step_begins_where_the_last_one_ended(drift: float) -> None:
    """Adding up steps drifts by far less than a millionth of one."""
    assert step_problem(1.0 + 1e-7 * 0.01, 0.01, 1.0, None) is None
    assert "the time reached is 1.0 s" in (step_problem(1.0 + drift * 0.01, 0.01, 1.0, None) or "")


def test_a_step_ends_at_the_stop_time_or_before() -> None:
    assert step_problem(1.0, 0.01, 1.0, 1.01) is None
    assert "the stop time was set to 1.009 s" in (step_problem(1.0, 0.01, 1.0, 1.009) or "")


def test_the_start_and_stop_time_are_fixed_once_the_run_has_begun() -> None:
    instance = Instance(interface(0.25))
    instance.setup_experiment(2.0, 2.015)
    instance.exit_initialization()
    instance.do_step(2.0, 0.01)
    with pytest.raises(InputError, match="the stop time was set to"):
        instance.do_step(2.01, 0.01)
    with pytest.raises(InputError, match="only before the run begins"):
        instance.setup_experiment(3.0, None)


def test_a_parameter_is_fixed_and_an_input_is_free_once_the_run_has_begun() -> None:
    instance = begun()
    with pytest.raises(InputError, match=r"parameter spring\.mass = 3\.0: fixed once the run has started"):
        instance.set_values("real", [REFS["spring.mass"]], [3.0])
    instance.set_values("real", [REFS["force"]], [0.5])
    assert instance.get_values("real", [REFS["force"]]) == [0.5]


def test_a_state_of_other_parameters_goes_on_with_its_own() -> None:
    """The simulator at hand has another mass, so that the saved state needs one of its own."""
    heavy, light = begun(mass=8.0), begun(mass=0.5)
    for instance in (heavy, light):
        instance.do_step(0.0, 0.01)
    saved = heavy.save_state("toy")
    heavy.do_step(0.01, 0.01)
    light.restore_state(saved, "toy")
    light.do_step(0.01, 0.01)
    assert place(light) == place(heavy)
    assert light.get_values("real", [REFS["spring.mass"]]) == [8.0]


def test_a_restored_instance_has_the_failure_that_was_saved() -> None:
    instance = begun()
    sound = instance.save_state("toy")
    instance.failure = "broken"
    broken = instance.save_state("toy")
    instance.restore_state(sound, "toy")
    assert isinstance(place(instance), float)
    instance.restore_state(broken, "toy")
    with pytest.raises(InputError, match="the error was: broken"):
        place(instance)
