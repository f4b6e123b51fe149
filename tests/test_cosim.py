"""The master's order of steps, on toys with known solutions; then drive and rope themselves."""

import math

import numpy as np
import pytest

from comprope.errors import InputError, SimulationError
from comprope.fmi.model_interface import ModelInterface, Variable
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited
from comprope_system.measurements.motion.trip import Trip
from comprope_system.simulation.cosim import Connection, co_simulate
from comprope_system.simulation.cosim.in_process_participant import InProcessParticipant
from comprope_system.simulation.cosim.prescribed_motion import PrescribedMotion


class Clock:
    """Its output is the time reached."""

    def __init__(self, parameters, inputs, start):
        self.time = start

    def step(self, time, dt, inputs):
        self.time = time + dt

    def outputs(self):
        return {"value": self.time}


class Echo:
    """Its output is the input that it was given for its last step."""

    def __init__(self, parameters, inputs, start):
        self.value = inputs["input"]

    def step(self, time, dt, inputs):
        self.value = inputs["input"]

    def outputs(self):
        return {"value": self.value}


class Decay:
    """value' = -rate * input, integrated exactly for an input that is held."""

    def __init__(self, parameters, inputs, start):
        self.value, self.rate = 1.0, parameters["rate"]

    def step(self, time, dt, inputs):
        if not math.isfinite(inputs["input"]):
            raise SimulationError(f"lost at t = {time} s")
        self.value -= self.rate * inputs["input"] * dt

    def outputs(self):
        return {"value": self.value}


def toy(name, create, **parameters):
    variables = [Variable(key, "real", "parameter", "", start=value) for key, value in parameters.items()]
    variables += [Variable("input", "real", "input", "", start=0.0), Variable("value", "real", "output", "")]
    return InProcessParticipant(name, ModelInterface(name, "", tuple(variables), create), {})


def link(source, target):
    return Connection(source, "value", target, "input")


def final(participants, connections, duration, step, **options):
    *_, last = co_simulate(participants, connections, duration, step, **options)
    return last


def test_a_later_participant_sees_the_step_of_an_earlier_one():
    for sample in co_simulate([toy("clock", Clock), toy("echo", Echo)], [link("clock", "echo")], 1.0, 0.1):
        assert sample.outputs["echo"]["value"] == sample.outputs["clock"]["value"] == pytest.approx(sample.time)


def test_in_the_wrong_order_it_lags_by_one_step():
    samples = list(co_simulate([toy("echo", Echo), toy("clock", Clock)], [link("clock", "echo")], 1.0, 0.1))
    lags = [one.outputs["clock"]["value"] - one.outputs["echo"]["value"] for one in samples[1:]]
    assert lags == pytest.approx([0.1] * 10)


def test_initial_values_agree_in_both_directions():
    first = next(co_simulate([toy("a", Echo), toy("clock", Clock)], [link("clock", "a")], 1.0, 0.1, start=3.0))
    assert first.outputs == {"a": {"value": 3.0}, "clock": {"value": 3.0}}


def test_two_way_coupling_converges_with_first_order():
    """x' = -y with y = x echoed backward: x = exp(-t), and the held y costs an error of first order."""
    errors = []
    for step in (0.02, 0.01):
        last = final([toy("x", Decay, rate=1.0), toy("y", Echo)], [link("x", "y"), link("y", "x")], 1.0, step)
        errors.append(abs(last.outputs["x"]["value"] - math.exp(-1.0)))
    assert math.log2(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.1)


def test_one_way_coupling_holds_what_goes_backward():
    participants = [toy("x", Decay, rate=1.0), toy("y", Echo)]
    last = final(participants, [link("x", "y"), link("y", "x")], 0.5, 0.1, coupling="one-way")
    # y stays at x's start, 1, for x; so x falls along a straight line, while y follows it.
    assert last.outputs["x"]["value"] == pytest.approx(0.5)
    assert last.outputs["y"]["value"] == last.outputs["x"]["value"]


def test_the_last_step_ends_at_or_after_the_end():
    assert final([toy("clock", Clock)], [], 1.0, 0.1).count == 10
    assert final([toy("clock", Clock)], [], 1.0, 0.3).time == pytest.approx(1.2)


def test_time_is_start_plus_count_times_step():
    last = final([toy("clock", Clock)], [], 1000.0, 0.1)
    assert last.time == 10000 * 0.1


def test_unknown_names_and_lost_steps_are_told():
    with pytest.raises(InputError, match="echo: nothing is not one of its variables"):
        final([toy("clock", Clock), toy("echo", Echo)], [Connection("clock", "value", "echo", "nothing")], 1.0, 0.1)

    class Lost(Clock):
        def step(self, time, dt, inputs):
            raise SimulationError(f"lost at t = {time} s")

    with pytest.raises(SimulationError, match=r"lost at t = 0\.0 s"):
        final([toy("lost", Lost)], [], 1.0, 0.1)


def test_a_prescribed_car_moves_as_its_trip():
    piece = jerk_limited(0.0, 10.0, 1.0, np.array([1.0, 0.5, 1.0, 2.0, 1.0, 0.5, 1.0]))
    car = Trip((piece,), 0.0, "profile")
    motion = PrescribedMotion("motion", {"car": car, "counterweight": car.mirrored(50.0)})
    for sample in co_simulate([motion], [], 9.0, 0.5):
        values = sample.outputs["motion"]
        assert values["car_position"] == car.position(sample.time)
        assert values["counterweight_velocity"] == -car.velocity(sample.time)
    assert values["car_position"] == pytest.approx(10.0)
    assert values["counterweight_position"] == pytest.approx(40.0)
