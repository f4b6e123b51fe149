"""Random calls, sensible and not, on the native FMU and on the one in Python: both must agree with the model itself."""

import os
import random
import shutil
from pathlib import Path

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, precondition, rule, run_state_machine_as_test

from comprope.fmi.package import build
from comprope.rope.model_file import bundle, load
from comprope.rope.simulator.cosimulation import ENTRY
from comprope_system import presets

from .fmi_pair import ODD, SMALL, STEPS, Pair, random_call
from .native_fmu import ORIGIN, compiler, native_fmu, tower

NUMBERS = st.floats(-2.0, 60.0) | st.sampled_from(ODD)
NAMES = st.sampled_from([one.name for one in tower().variables if one.kind == "real"])
MESH = ("shaft.height", "shaft.pit", "rope.element_length", "solver.step")  # to be left alone, so that calls stay quick


class Calls(RuleBasedStateMachine):
    """Any call at any time, on an instance that begins where the FMI begins."""

    def __init__(self) -> None:
        super().__init__()
        self.pair = Pair(native_fmu(), tower())

    def teardown(self) -> None:
        self.pair.free()

    @initialize()
    def small(self) -> None:
        self.pair.set_reals(list(SMALL), list(SMALL.values()))

    @rule(start=st.sampled_from((0.0, 5.0)), stop=st.sampled_from((None, 5.1)))
    def plan(self, start: float, stop: float | None) -> None:
        self.pair.setup_experiment(start, stop)

    @rule()
    def enter(self) -> None:
        self.pair.enter_initialization()

    @rule()
    def begin(self) -> None:
        self.pair.exit_initialization()

    @rule(dt=st.sampled_from(STEPS), late=st.sampled_from((0.0, 0.0, 0.0, 1.0)))
    def step(self, dt: float, late: float) -> None:
        self.pair.do_step(dt, late)

    @precondition(lambda self: self.pair.oracle.phase == 2)
    @rule(car=st.floats(-0.01, 0.01), steps=st.integers(1, 5))
    def move(self, car: float, steps: int) -> None:
        self.pair.set_reals(["car_position", "counterweight_position"], [car, 1.0 - car])
        for _ in range(steps):
            self.pair.do_step(0.01)

    @rule(name=NAMES.filter(lambda name: name not in MESH), value=NUMBERS)
    def put(self, name: str, value: float) -> None:
        self.pair.set_reals([name], [value])

    @rule(name=st.sampled_from(("derivative_inputs", "inputs_at_end")), value=st.booleans())
    def switch(self, name: str, value: bool) -> None:
        self.pair.set_boolean(name, value)

    @rule()
    def read(self) -> None:
        self.pair.get_all()

    @rule(reference=st.integers(0, 2**32 - 1))
    def read_nonsense(self, reference: int) -> None:
        self.pair.get_any_reference(reference)

    @rule()
    def save(self) -> None:
        self.pair.save_state()

    @rule(place=st.integers(0, 9), serialized=st.booleans())
    def restore(self, place: int, serialized: bool) -> None:
        self.pair.restore_state(place, serialized)

    @rule()
    def terminate(self) -> None:
        self.pair.terminate()

    @rule()
    def start(self) -> None:
        self.pair.start(SMALL)


@compiler
def test_any_sequence_of_calls() -> None:
    run_state_machine_as_test(Calls, settings=settings(max_examples=30, stateful_step_count=40, deadline=None))


def python_fmu(out: Path) -> Path:
    """The same rope as an FMU in Python."""
    return build(tower(), ["kernels", "rope"], ENTRY, out, ORIGIN, bundle(load(presets.model_path("tower50"))))


# So many calls take 20 s and 80 s; by default only a share of them is made.
CALLS = int(os.environ.get("COMPROPE_CALLS", "5000"))


@compiler
def test_thousands_of_calls_on_the_native_fmu() -> None:
    make_calls(Pair(native_fmu(), tower()), CALLS)


def test_thousands_of_calls_on_the_fmu_in_python(tmp_path: Path) -> None:
    make_calls(Pair(python_fmu(tmp_path), tower()), CALLS // 4)
    shutil.rmtree(tmp_path)


def make_calls(pair: Pair, count: int) -> None:
    generator = random.Random(7)
    pair.start(SMALL)
    while pair.calls < count:
        random_call(pair, generator)
    assert 0 < pair.refusals < 0.3 * pair.calls
    pair.free()
