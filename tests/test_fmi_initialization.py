"""Initialization and first steps of the FMUs: what depends on what, and which starts and motions are refused."""

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import pytest

from comprope.drive.cosimulation import interface as drive_interface
from comprope.errors import CompropeError, InputError
from comprope.fmi.instance import Instance
from comprope.fmi.model_interface import ModelInterface
from comprope.rope.model_file import load, with_changes
from comprope.rope.simulator.cosimulation import interface as rope_interface
from comprope_system import presets
from comprope_system.simulation.cosim import co_simulate
from comprope_system.simulation.cosim.in_process_participant import InProcessParticipant
from comprope_system.simulation.trips.elevator import BACKWARD, FORWARD

from .fmi_pair import Pair
from .native_fmu import compiler, native_fmu, tower

COARSE = {"rope.element_length": 0.2, "solver.step": 0.005, "shaft.height": 12.0}
STEPS = (1e-4, 1e-5, 1e-6, 1e-7, 1e-9, 1e-12, 4e-14)


def rope() -> ModelInterface:
    return rope_interface(with_changes(load(presets.model_path("tower50")), COARSE))


class Slave:
    """An instance whose variables have names."""

    def __init__(self, interface: ModelInterface, **values: Any) -> None:
        self.interface, self.instance = interface, Instance(interface)
        self.places = {one.name: (place, one) for place, one in enumerate(interface.variables)}
        self.set(**values)

    def set(self, **values: Any) -> "Slave":
        for name, value in values.items():
            place, variable = self.places[name]
            self.instance.set_values(variable.kind, [place], [value])
        return self

    def get(self, name: str) -> Any:
        place, variable = self.places[name]
        return self.instance.get_values(variable.kind, [place])[0]

    def outputs(self) -> dict[str, Any]:
        return {one.name: self.get(one.name) for one in self.interface.of_role("output")}


@pytest.mark.parametrize("interface", [rope, drive_interface], ids=["rope", "drive"])
def test_outputs_at_the_start_depend_on_inputs_as_declared(interface: Callable[[], ModelInterface]) -> None:
    """Every input is changed a little, and what changes with it must be declared, and no more for the drive."""
    model = interface()
    before = Slave(model, **({"sensors[1].height": 11.9} if interface is rope else {})).outputs()
    found: dict[str, set[str]] = {name: set() for name in before}
    for one in model.of_role("input"):
        start = {"sensors[1].height": 11.9} if interface is rope else {}
        change = 0.05 if (one.unit == "m" and "dest" not in one.name) or one.unit == "1" else -1.0
        value = float(one.start or 0.0) + change
        for name, after in Slave(model, **start, **{one.name: value}).outputs().items():
            if after != before[name]:
                found[name].add(one.name)
    for output in model.of_role("output"):
        assert found[output.name] <= set(output.initial_depends_on or ())
        if interface is drive_interface:
            assert found[output.name] == set(output.initial_depends_on or ())
    assert any(found.values())


# -- masters -----------------------------------------------------------------------------------------


def elevator(**trip: float) -> tuple[InProcessParticipant, InProcessParticipant]:
    changes = {"shaft.height": 12.0, "trip.destination": 9.0} | {f"trip.{name}": value for name, value in trip.items()}
    drive = InProcessParticipant("motion", drive_interface(), changes | {"destination": 9.0})
    return drive, InProcessParticipant("rope", rope(), {"inputs_at_end": True, "derivative_inputs": True})


def values(outputs: dict[str, Any], connections: Any) -> dict[str, Any]:
    return {one.input: outputs[one.output] for one in connections}


def master(propagates: bool, jacobi: bool, count: int = 300, h: float = 0.01) -> float:
    """The car's height [m] at the end of a trip under a master that propagates connections at initialization or does not."""
    drive, ropes = elevator()
    if jacobi:
        ropes.set({"inputs_at_end": False})
    for one in (drive, ropes):
        one.enter_initialization(0.0)
    if propagates:
        ropes.set(values(drive.outputs(), FORWARD))
        drive.set(values(ropes.outputs(), BACKWARD))
    for one in (drive, ropes):
        one.exit_initialization()
    for k in range(count):
        if jacobi:
            forward, backward = values(drive.outputs(), FORWARD), values(ropes.outputs(), BACKWARD)
            drive.set(backward)
            ropes.set(forward)
            drive.step(k * h, h)
        else:
            drive.set(values(ropes.outputs(), BACKWARD) if k or propagates else {})
            drive.step(k * h, h)
            ropes.set(values(drive.outputs(), FORWARD))
        ropes.step(k * h, h)
    return float(drive.outputs()["car_position"])


@pytest.mark.parametrize("jacobi", [False, True])
def test_a_master_that_propagates_nothing_at_initialization_gets_the_same_trip(jacobi: bool) -> None:
    # The rope at rest keeps its tensions to some digits only, and a master may take those of the first step.
    assert master(propagates=False, jacobi=jacobi) == pytest.approx(master(propagates=True, jacobi=jacobi), abs=1e-12)


def test_our_own_master_is_one_of_these() -> None:
    *_, last = co_simulate(elevator(), FORWARD + BACKWARD, 3.0, 0.01)
    assert last.outputs["motion"]["car_position"] == master(propagates=True, jacobi=False)


# -- refusals ----------------------------------------------------------------------------------------


def motion(t: float) -> dict[str, float]:
    """Jerk-limited start of the car at the bottom landing."""
    x, v, a = 0.8 * t**3 / 6.0, 0.4 * t**2, 0.8 * t
    car = {"car_position": x, "car_velocity": v, "car_acceleration": a}
    return car | {"counterweight_position": 12.0 - x, "counterweight_velocity": -v, "counterweight_acceleration": -a}


STARTS = (
    ({"car_position": 0.0, "counterweight_position": 0.0}, "the axle would hang at -7.5 m, and is built at -1.5 m; at most 1 m"),
    ({"car_position": 6.0, "counterweight_position": 12.0}, "the axle would hang at 1.5 m, and is built at -1.5 m; at most 1 m"),
)
MOTIONS = (
    (dict.fromkeys(("car_position",), 10.0), "car_position = 10 m at t = 0.02 s: 10 m from its last value, 0.01 s earlier"),
    (
        {"counterweight_position": 11.4},
        "counterweight_position = 11.4 m at t = 0.02 s: 0.6 m from its last value, 0.01 s earlier",
    ),
    ({"car_lateral_displacement": 1.0}, "car_lateral_displacement = 1 m at t = 0.02 s: 1 m from its last value"),
    ({"car_velocity": -60.0}, "car_velocity = -60 m/s with 0 m/s2 at t = 0.02 s: a velocity of at most 50 m/s"),
    (
        {"counterweight_acceleration": 1e5},
        "counterweight_velocity = 0 m/s with 100000 m/s2 at t = 0.02 s: a velocity of at most 50",
    ),
)


@pytest.mark.parametrize(("start", "sentence"), STARTS)
def test_a_start_that_does_not_fit_the_shaft_is_refused(start: dict[str, float], sentence: str) -> None:
    with pytest.raises(InputError) as caught:
        Slave(rope(), **start).instance.exit_initialization()
    assert sentence in str(caught.value)


def test_a_start_within_a_metre_is_accepted() -> None:
    assert Slave(rope(), counterweight_position=13.9).get("sheave_displacement") == pytest.approx(0.95, abs=0.01)


def test_positions_that_come_with_the_first_step_only_are_refused() -> None:
    """The rope would be thrown by metres; what is missing is said."""
    slave = Slave(rope())
    slave.instance.exit_initialization()
    slave.set(car_position=6.0, counterweight_position=6.0)
    with pytest.raises(InputError, match="values at initialization must be those of the first step"):
        slave.instance.do_step(0.0, 0.01)


@pytest.mark.parametrize(("jump", "sentence"), MOTIONS)
def test_a_motion_too_fast_for_an_elevator_is_refused(jump: dict[str, float], sentence: str) -> None:
    slave = Slave(rope(), derivative_inputs=True)
    slave.instance.exit_initialization()
    slave.instance.do_step(0.0, 0.01)
    slave.instance.do_step(0.01, 0.01)
    with pytest.raises(InputError) as caught:
        slave.set(**jump).instance.do_step(0.02, 0.01)
    assert sentence in str(caught.value)


def test_the_fastest_motion_is_accepted_from_both_sides() -> None:
    for moved, accepted in ((0.54, True), (0.56, False)):  # 50 m/s for 10 ms, and 5 cm
        # A rope that goes slack may be lost in such a motion, with another error; a rod is not.
        slave = Slave(rope(), **{"rope.compression_ratio": 1.0})
        slave.instance.exit_initialization()
        slave.instance.do_step(0.0, 0.01)
        slave.set(car_position=moved, counterweight_position=12.0 - moved)
        try:
            slave.instance.do_step(0.01, 0.01)
        except CompropeError as error:
            assert not accepted and "car_position = 0.56 m" in str(error)
        else:
            assert accepted


@compiler
@pytest.mark.parametrize("refused", [*STARTS, *MOTIONS], ids=lambda one: next(iter(one)) if isinstance(one, dict) else "")
def test_the_native_fmu_refuses_the_same_and_the_host_lives_on(refused: tuple[dict[str, float], str]) -> None:
    values, _ = refused
    pair = Pair(native_fmu(), tower())
    pair.set_boolean("derivative_inputs", True)
    try:
        if refused in STARTS:
            pair.set_reals(list(values), [50.0 / 12.0 * value for value in values.values()])
        pair.enter_initialization()
        pair.exit_initialization()
        if refused in MOTIONS:
            pair.do_step(0.01)
            pair.set_reals(list(values), [value * (5.0 if value == 11.4 else 1.0) for value in values.values()])
            pair.do_step(0.01)
        assert pair.refusals == 1 and pair.messages and (pair.oracle.instance.failure or "?") in pair.messages[0]
        pair.reset()
        pair.enter_initialization()
        pair.exit_initialization()
        assert pair.refusals == 1
    finally:
        pair.free()


# -- short steps -------------------------------------------------------------------------------------


def moved(derivatives: bool, at_end: bool) -> Slave:
    """A rope that has moved for a second in steps of 20 ms."""
    slave = Slave(rope(), derivative_inputs=derivatives, inputs_at_end=at_end)
    slave.set(**motion(0.0)).instance.exit_initialization()
    for k in range(50):
        slave.set(**motion(0.02 * (k + at_end))).instance.do_step(slave.instance.time, 0.02)
    return slave


@pytest.mark.parametrize("derivatives", [False, True])
@pytest.mark.parametrize("at_end", [False, True])
def test_outputs_are_continuous_in_the_length_of_a_step(derivatives: bool, at_end: bool) -> None:
    slave = moved(derivatives, at_end)
    names = ("car_end_tension", "counterweight_end_tension", "sheave_force")
    saved, before = slave.instance.save_state("one"), {name: slave.get(name) for name in names}
    for dt in STEPS:
        slave.instance.restore_state(saved, "one")
        time = slave.instance.time
        slave.set(**motion(time + dt * at_end)).instance.do_step(time, dt)
        for name in names:
            # Inputs and extrapolated motion differ by a tenth of a micrometre after a step of 20 ms: up to 120 N in 0.1 ms.
            assert slave.get(name) == pytest.approx(before[name], abs=1e-9 + 1.5e6 * dt * (dt >= 1e-6)), (dt, name)


@pytest.mark.parametrize("derivatives", [False, True])
def test_a_position_off_by_a_micrometre_does_not_shake_a_short_step(derivatives: bool) -> None:
    """As an encoder gives it: spread over the shortest time in which an end may be led anywhere, whatever the step."""
    found = []
    for dt in (1e-4, 1e-5, 2e-6):
        slave = moved(derivatives, at_end=True)
        before, time = slave.get("car_end_tension"), slave.instance.time
        target = motion(time + dt)
        slave.set(**target | {"car_position": target["car_position"] + 1e-6}).instance.do_step(time, dt)
        found.append(abs(slave.get("car_end_tension") - before))
    assert found == sorted(found, reverse=True) and found[0] < 20.0  # N; 40 N is what a micrometre stretches the first element


@pytest.mark.parametrize("tiny", [4e-14, 1e-9, 4e-7])
def test_short_steps_between_others_lose_no_time(tiny: float) -> None:
    """The rope is where it would be without them, but for the error of its time steps."""
    slave, other = moved(True, True), moved(True, True)
    for _ in range(20):
        for dt in (tiny, tiny, tiny, 0.02 - 3.0 * tiny):
            time = slave.instance.time
            slave.set(**motion(time + dt)).instance.do_step(time, dt)
        time = other.instance.time
        other.set(**motion(time + 0.02)).instance.do_step(time, 0.02)
    assert math.isclose(slave.instance.time, other.instance.time, abs_tol=1e-9)
    for name in ("sheave_displacement", "sheave_angle", "car_end_tension", "lateral_displacement[1]"):
        assert slave.get(name) == pytest.approx(other.get(name), rel=1e-3, abs=1e-6), name
    assert abs(slave.instance.simulator.rope.state.time[0] - slave.instance.time) < 1e-6  # type: ignore[attr-defined]


def test_many_short_steps_take_the_rope_as_far_as_a_long_one() -> None:
    """None of them is long enough to be integrated by itself."""
    slave, other = moved(True, True), moved(True, True)
    for _ in range(2000):
        time = slave.instance.time
        slave.set(**motion(time + 9e-7)).instance.do_step(time, 9e-7)
    other.set(**motion(1.0018)).instance.do_step(1.0, 0.0018)
    assert slave.get("sheave_angle") == pytest.approx(other.get("sheave_angle"), rel=1e-4)
    assert slave.get("sheave_angular_velocity") == pytest.approx(other.get("sheave_angular_velocity"), rel=1e-3)


@compiler
def test_the_native_fmu_takes_short_steps_as_the_one_in_python() -> None:
    pair = Pair(native_fmu(), tower())
    pair.start({})
    step = partial(pair.set_reals, ["car_position", "counterweight_position"])
    for k, dt in enumerate((0.01, 1e-12, 0.01, 3e-7, 3e-7, 3e-7, 3e-7, 5e-5, 2e-5, 1e-9, 0.01)):
        step([1e-4 * k, 50.0 - 1e-4 * k])
        pair.do_step(dt)
        pair.get_all()
    assert pair.refusals == 0
    pair.free()
