"""Effects of a user's own: the examples of docs/own_effect.md, from the file to the diagnosis, and what a bad file is told."""

import json
import multiprocessing
import os
import re
import shutil
import subprocess
import sys
import zipfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description

from comprope import consent
from comprope.drive.parameters import Profile
from comprope.drive.trajectory.s_curve import plan_s_curve
from comprope.errors import InputError, SimulationError
from comprope.rope.effects import REGISTRY, names_of, user_effects
from comprope.rope.effects.checks.kernel_checks import require_consistent
from comprope.rope.model_file import dump, load, with_changes
from comprope.rope.parameters.parameter_vector import DECLARED
from comprope.rope.simulator.cosimulation import interface
from comprope.rope.simulator.rope import CompensationRope, values_of
from comprope_system import cli
from comprope_system.identification.data.campaign import load_campaign
from comprope_system.identification.diagnosis.diagnose import diagnose
from comprope_system.identification.model_updating.add_effect import add_effect
from comprope_system.parallel.executors import threads
from comprope_system.presets.inputs import load_drive
from comprope_system.simulation.cosim import fmu_cache
from comprope_system.simulation.trips.elevator import driven_elevator
from comprope_system.simulation.trips.timing import Timing
from comprope_system.simulation.trips.trip_simulation import simulate

from . import virtual_elevator
from .own_effects import EXAMPLES, FILES, SPRING
from .rope_tower import TOWER, ride
from .test_rope_kernels import agrees, differences, free, random_state, tangent

DOCS = Path(__file__).parent.parent / "docs"
JOINTS = {"effects.rail_joints.kick": 0.02, "effects.rail_joints.spacing": 2.5}
BRUSH = {"effects.pit_brush.damping": 5.0}
BUILT_IN = tuple(REGISTRY)
BRUSH_SOURCE, JOINTS_SOURCE = ((EXAMPLES / f"{name}.py").read_text() for name in ("pit_brush", "rail_joints"))


TABLES = (REGISTRY, DECLARED, user_effects.FILES)
NOTHING = [dict(one) for one in TABLES]  # of a user's own


def remember(tables):
    for table, kept in zip(TABLES, tables, strict=True):
        table.clear()
        table.update(kept)


@pytest.fixture(scope="module")
def examples():
    """A model that names both examples, each at work."""
    with consent.giving():
        yield with_changes(TOWER, FILES | JOINTS | BRUSH)
    remember(NOTHING)


@pytest.fixture(autouse=True)
def forgotten(request):
    """What a test registers is forgotten after it; the examples are known where they are asked for."""
    before = [dict(one) for one in TABLES]
    if "examples" not in request.fixturenames:
        remember(NOTHING)
    yield
    remember(before)


def command(capsys, *arguments):
    with pytest.raises(SystemExit) as done:
        cli.main([str(one) for one in arguments])
    return done.value.code, *capsys.readouterr()


# -- the tutorial, and consent -----------------------------------------------------------------------


def test_the_tutorial_shows_the_file_as_it_is():
    text = (DOCS / "own_effect.md").read_text()
    name = re.search(r"\[(examples/\w+\.py)\]\(\1\):\n\n```python\n", text)
    shown = text[name.end() :].partition("\n```")[0]
    assert shown + "\n" == (DOCS / name[1]).read_text()


def test_the_example_runs_with_consent_and_not_without(capsys, monkeypatch, tmp_path):
    monkeypatch.setenv(consent.VARIABLE, "")
    model, quick = EXAMPLES / "rail_joints.toml", ["--set", "rope.element_length=0.2", "--time", "0.1", "--direct"]
    status, told, errors = command(capsys, "simulate", model, *quick)
    file = EXAMPLES / "rail_joints.py"
    ways = "comprope --allow-code ..., build_fmu.py --allow-code, or COMPROPE_ALLOW_CODE=1"
    refusal = f"would be executed as a program; inspect it, then allow it: {ways}"
    assert (status, told, errors) == (2, "", f"{model}: own_effects: {file} {refusal}\n")
    assert "rail_joints" not in REGISTRY
    status, _, errors = command(capsys, "--allow-code", "simulate", model, "--time", "0", "--set", "shaft.pit=-1")
    assert "shaft.pit = -1" in errors and "rail_joints" in REGISTRY  # it was run, and the rest is judged as always
    assert not consent.given()


# -- in a model --------------------------------------------------------------------------------------


def test_values_are_accepted_as_declared(examples):
    assert values_of(examples)["effects.rail_joints.kick"] == 0.02
    with pytest.raises(InputError) as caught:
        with_changes(examples, {"effects.rail_joints.kick": 1.0, "effects.pit_brush.dampin": 1.0})
    assert str(caught.value).splitlines() == [
        "change: effects.rail_joints.kick = 1.0: a number from 0 to 0.1 m is accepted "
        "(lateral displacement of the car at a joint)",
        'change: effects.pit_brush.dampin = 1.0: unknown key; did you mean "damping"?',
    ]


def test_a_model_written_elsewhere_names_the_same_file(examples, tmp_path):
    for folder in (tmp_path, tmp_path / "deeper" / "still"):
        folder.mkdir(exist_ok=True, parents=True)
        dump(examples, folder / "model.toml")
        assert load(folder / "model.toml") == examples


def test_the_rope_moves_otherwise_and_its_energy_balances(examples):
    still = {"effects.rail_joints.kick": 0.0, "effects.pit_brush.damping": 0.0}
    ropes = [CompensationRope(one) for one in (examples, with_changes(examples, still))]
    trip, apart = plan_s_curve(Profile(), 20.0, 26.0, 0.0), 0.0
    for rope in ropes:
        rope.solve_equilibrium(20.0, 30.0)
    for _ in range(100):
        for rope in ropes:
            ride(rope, trip, 0.02)
        apart = max(apart, float(np.abs(ropes[0].state.q - ropes[1].state.q)[ropes[0].n + 1 : -1].max()))
    energies = ropes[0].energies()
    assert energies["effects.pit_brush"] < -0.1 and energies["effects.rail_joints"] == 0.0
    # As for the effects of comprope: a trip that stores 230 J.
    assert abs(ropes[0].energy_residual) < 0.02
    assert 2e-3 < apart < 0.1
    assert ropes[1].energies()["effects.pit_brush"] == 0.0


def test_tangents_are_right_given_or_found_by_differences(examples):
    """The brush gives its own; the spring, stiff beside bending but not beside contact, gives none."""
    undamped = {"rope.axial_damping": 0.0, "rope.bending_damping": 0.0}
    do = random_state(FILES | JOINTS | BRUSH | {"effects.pit_spring.stiffness": 1e6} | undamped)
    inner = np.ix_(free(do.rope.n), free(do.rope.n))
    # As for comprope's effects; the spring adds 5e4 N/m to a node.
    assert agrees(tangent(do, 1.0, 0.0)[inner], differences(do, do.state.q, 1e-8)[inner], 2.0)
    assert agrees(tangent(do, 0.0, 1.0)[inner], differences(do, do.state.v, 1e-5)[inner], 1e-5)


def test_a_stiff_force_without_tangents_costs_no_more_iterations(examples):
    rope = CompensationRope(with_changes(examples, {"effects.pit_spring.stiffness": 1e5}))
    trip = plan_s_curve(Profile(), 20.0, 26.0, 0.0)
    rope.solve_equilibrium(20.0, 30.0)
    for _ in range(50):
        ride(rope, trip, 0.02)
    assert rope.count["halved"] == 0 and rope.count["newton"] < 3.0 * rope.count["steps"]


def test_an_effect_whose_force_is_lost_on_the_way_is_named(examples):
    rope = CompensationRope(with_changes(examples, {"effects.root.size": 1.0}))
    trip = plan_s_curve(Profile(), 20.0, 26.0, 0.0)
    rope.solve_equilibrium(20.0, 30.0)
    with pytest.raises(SimulationError) as caught:
        for _ in range(200):
            ride(rope, trip, 0.02)
    assert str(caught.value).endswith(f"; not finite are the forces of root ({SPRING})")


def test_other_models_do_not_notice(examples):
    assert {"rail_joints", "pit_brush"} <= set(REGISTRY)
    assert names_of(TOWER) == BUILT_IN and names_of(examples) == (*BUILT_IN, "rail_joints", "pit_brush", "pit_spring", "root")
    assert not any("rail_joints" in one.name for one in interface(TOWER).variables)
    assert list(CompensationRope(TOWER).energies())[-1] == f"effects.{BUILT_IN[-1]}"
    with pytest.raises(InputError, match=r"effects.rail_joints: unknown key; accepted are air_drag"):
        with_changes(TOWER, JOINTS)


def test_a_model_goes_to_another_process_with_its_effects(examples, tmp_path, monkeypatch):
    """Whose consent was given here; the file itself need not be there."""
    copies = [shutil.copy(file, tmp_path) for file in FILES["own_effects"]]
    model = with_changes(TOWER, {"own_effects": list(map(str, copies))} | JOINTS)
    for copy in copies:
        Path(copy).unlink()
    monkeypatch.setenv(consent.VARIABLE, "")
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        assert pool.submit(values_of, model).result() == values_of(model)


# -- in an FMU ---------------------------------------------------------------------------------------

WITHOUT_COMPROPE = """\
import sys
sys.modules["comprope"] = None  # as if it were not installed
from fmpy import simulate_fmu
table = simulate_fmu(sys.argv[1], stop_time=0.05, output_interval=0.01, start_values={"effects.rail_joints.kick": 0.006})
print("lateral_displacement[1]" in table.dtype.names)
"""


def test_the_fmu_gives_the_same_numbers_and_has_the_effect_inside(examples):
    coarse = {"rope.element_length": 0.2, "solver.step": 0.005, "shaft.height": 12.0}
    sensor = {"sensors": [{"name": "low", "side": "car", "height": 0.5}]}
    model = with_changes(examples, coarse | sensor)
    trip = {"shaft": {"height": 12.0}, "trip": {"start_position": 1.0, "destination": 2.0, "start_time": 0.0}}
    tables = []
    for direct in (True, False):
        with driven_elevator(model, load_drive(None, trip), direct) as elevator:
            tables.append(simulate(elevator, ["low"], Timing(2.0, 0.02, "one-way")).table)
    assert tables[0].equals(tables[1])
    fmu = fmu_cache.rope_fmu(1, model.own_effects)
    with zipfile.ZipFile(fmu) as archive:
        assert any(name.endswith("own_effects/1_rail_joints.py") for name in archive.namelist())
        assert "comprope" not in re.search(r"pip install [^<]*", archive.read("documentation/index.html").decode())[0]
    environment = {key: value for key, value in os.environ.items() if key != consent.VARIABLE}
    result = subprocess.run(
        [sys.executable, "-c", WITHOUT_COMPROPE, str(fmu)], env=environment, capture_output=True, text=True, check=False
    )
    assert result.stdout == "True\n", result.stderr


def test_the_command_that_builds_fmus_asks_for_consent_too(examples, tmp_path):
    out, model = tmp_path / "out", tmp_path / "model.toml"
    dump(with_changes(examples, {"effects.rail_joints.kick": 0.005}), model)
    out.mkdir()

    def built(*options):
        command = [sys.executable, DOCS.parent / "build_fmu.py", "--model", model, "--out", out, *options]
        environment = {key: value for key, value in os.environ.items() if key != consent.VARIABLE}
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)

    refused = built()
    assert refused.returncode == 2 and len(refused.stderr.splitlines()) == len(FILES["own_effects"]) and not list(out.iterdir())
    assert "rail_joints.py would be executed as a program" in refused.stderr
    assert built("--allow-code").returncode == 0
    variables = {one.name: one for one in read_model_description(str(out / "CompensationRope.fmu")).modelVariables}
    assert float(variables["effects.rail_joints.kick"].start) == 0.005 and variables["effects.rail_joints.kick"].unit == "m"


# -- in a diagnosis ----------------------------------------------------------------------------------


@pytest.mark.slow
def test_what_only_the_user_knows_is_found_and_added(examples, tmp_path, monkeypatch):
    """Rail joints excite the elevator; its model names the file, but has no such table. One run to fit, one held out."""
    monkeypatch.setattr(virtual_elevator, "RUNS", virtual_elevator.RUNS[::2])
    folder = virtual_elevator.campaign(tmp_path / "shaken", FILES | JOINTS)
    dump(with_changes(virtual_elevator.MODEL, FILES), folder / "elevator.toml")
    with threads() as executor:
        campaign = load_campaign(folder)
        found = diagnose(campaign, executor)
        added = add_effect(campaign, "rail_joints", executor)
    assert (found.verdict, found.kind) == ("rail_joints", "known_effect")
    assert {"rail_joints", "pit_brush", "air_drag"} <= {one.hypothesis.effect for one in found.ranking}
    values = added.parameters()
    assert values["kick"] == pytest.approx(0.02, rel=0.05) and values["spacing"] == pytest.approx(2.5, rel=0.01)
    noise = added.after.noise_nrmse("validate")
    # On the run held out, too, four fifths of what noise does not explain is gone; one run tells the plant only so well.
    assert added.after.validate_nrmse - noise < 0.2 * (added.before.validate_nrmse - noise)
    (tmp_path / "out").mkdir()
    dump(added.model, tmp_path / "out" / "new.toml")
    assert load(tmp_path / "out" / "new.toml") == added.model
    json.dumps(added.to_json(), allow_nan=False)


# -- files that are not right ------------------------------------------------------------------------


def own_names(file: Path) -> tuple[str, ...]:
    user_effects.load_file(file, allow_code=True)
    return user_effects.FILES[str(file)].effects


def refusal(file: Path, source: str) -> str:
    """What a file is told when it is run and tried."""
    file.write_text(source)
    with pytest.raises(InputError) as caught:
        for name in own_names(file):
            require_consistent(REGISTRY[name])
    assert len(str(caught.value).splitlines()) == 1
    return str(caught.value).removeprefix(str(file))


WRONG = {
    "syntax": ("p, q, v, w, f):", "p, q, v, w, f)", ", line 21: not Python: expected ':'"),
    "absent import": ('"""A', 'import nosuchthing\n"""A', ", line 1: No module named 'nosuchthing'"),
    "imports inside": ("comprope.effect", "comprope.rope", ", line 3: imports comprope.rope; of comprope, only"),
    "unknown name": ("Effect, acts", "Effect, act", ", line 3: cannot import name 'act' from 'comprope.effect'"),
    "error": ('"""A', '1 / 0\n"""A', ", line 1: ZeroDivisionError: division by zero"),
    "leaves": ('"""A', 'raise SystemExit("gone")\n"""A', ", line 1: SystemExit: gone"),
    "nothing in it": (BRUSH_SOURCE, "", ": no effect that acts; register(EFFECT) and acts(EFFECT, ...) are needed"),
    "name taken": ('"pit_brush"', '"air_drag"', ', line 14: PitBrush.name = "air_drag": comprope itself has an effect of'),
    "instrument": ('"pit_brush"', '"sensor_gain"', ', line 14: PitBrush.name = "sensor_gain": comprope itself has'),
    "no name": ('"pit_brush"', '"Pit brush"', ', line 14: PitBrush.name = "Pit brush": small letters, digits and'),
    "unit": ('"N.s/m2"', '"lbs"', ", line 6: PitBrush.damping: unit lbs: 'lbs' is not known; known are 1, kg, m"),
    "default": ("default=0.5", "default=500.0", ", line 6: PitBrush.top: its neutral value 500 is outside of -20 to 100"),
    "quantity": ("brush.top", "brush.tp", ', line 16: effects.pit_brush.tp: no such quantity; did you mean "effects.pit_'),
    "hook": ("forces=brush", "force=brush", ", line 40: pit_brush: no such hook: force; there are moments, forces, tangents"),
    "arguments": ("p, q, v, w, f):", "p, q, v, f):", ", line 21: brush(n, t, p, q, v, f): for forces the arguments (n, t, p,"),
    "ck and cc apart": (
        "w, A, weights):", "w, A, ck, cc):",
        ", line 32: brush_tangent(n, t, p, q, v, w, A, ck, cc): for tangents the arguments (n, t, p, q, v, w, A, weights) are "
        "accepted, where ck, cc = weights",
    ),
    "no kernel": ("@kernel\ndef brush(", "def brush(", ", line 20: brush: not a kernel; write @kernel above it"),
    "elsewhere": ("forces=brush", "forces=abs", ": forces=abs: a function of this file is accepted"),
}  # fmt: skip
UNSOUND = {
    "undefined": ("return power", "return pwer", ", line 20: brush: cannot be compiled: NameError: name 'pwer' is not defined"),
    "slice": ("return power", "return sum(v[1:3])", ", line 20: brush: cannot be compiled (line 28): getitem(float64*, slice"),
    "no power": ("    return power\n", "", ", line 20: brush: returns nothing; the power [W] is accepted"),
    "not finite": ("+ 1, p[DAMPING]", "+ 1, p[DAMPING] / (p[TOP] - p[TOP])", ", line 20: brush: gives numbers that are not"),
    "not neutral": ("+ 1, p[DAMPING]", "+ 1, (1.0 + p[DAMPING])", ", line 20: brush: changes something where every quantity"),
    "power": ("power -= c", "power += c", ", line 20: brush: returns a power of "),
    "tangent": ("+= cc *", "-= cc *", ", line 31: brush_tangent: by velocity it adds -"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_a_file_that_is_not_right_is_told_where_and_leaves_nothing(tmp_path, case):
    old, new, sentence = WRONG[case]
    before = dict(REGISTRY), dict(DECLARED)
    assert refusal(tmp_path / "pit.py", BRUSH_SOURCE.replace(old, new, 1)).startswith(sentence)
    assert before == (dict(REGISTRY), dict(DECLARED))


@pytest.mark.parametrize("case", UNSOUND)
def test_an_effect_that_contradicts_itself_is_told_where(tmp_path, case):
    old, new, sentence = UNSOUND[case]
    assert refusal(tmp_path / "pit.py", BRUSH_SOURCE.replace(old, new, 1)).startswith(sentence)


def test_ends_that_move_otherwise_than_they_say_are_refused(tmp_path):
    wrong = JOINTS_SOURCE.replace("by_angle * rate\n", "by_angle\n")
    assert "the velocity that it gives an end is not the derivative of the position" in refusal(tmp_path / "rail.py", wrong)
    wrong = JOINTS_SOURCE.replace("twice * rate * rate", "twice * rate")
    assert "the acceleration that it gives an end is not" in refusal(tmp_path / "rails.py", wrong.replace("rail_joints", "rails"))


@pytest.mark.parametrize("effect", BUILT_IN)
def test_what_is_asked_of_own_effects_holds_for_those_of_comprope(effect):
    require_consistent(REGISTRY[effect])


def test_a_copy_is_the_same_effect_and_a_changed_file_is_another(tmp_path):
    first, copy = tmp_path / "one.py", tmp_path / "copy.py"
    first.write_text(BRUSH_SOURCE)
    copy.write_text(BRUSH_SOURCE)
    names = own_names(first)
    count = len(REGISTRY)
    assert own_names(copy) == own_names(first) == names and len(REGISTRY) == count
    copy.write_text(BRUSH_SOURCE + "# changed\n")
    with pytest.raises(InputError, match=r"copy.py: has changed since it was run; start the program again"):
        own_names(copy)
    (tmp_path / "other.py").write_text(BRUSH_SOURCE + "# changed\n")
    with pytest.raises(InputError, match=r'line 14: PitBrush.name = "pit_brush": .*one.py has an effect of this name'):
        own_names(tmp_path / "other.py")


def test_every_file_of_a_model_is_told_at_once(tmp_path):
    (tmp_path / "broken.py").write_text("def")
    text = 'own_effects = ["absent.py", "broken.py"]\n'
    (tmp_path / "model.toml").write_text(text)
    with pytest.raises(InputError) as caught:
        load(tmp_path / "model.toml", allow_code=True)
    first, second = str(caught.value).splitlines()
    assert first == f"{tmp_path / 'model.toml'}: own_effects: {tmp_path / 'absent.py'}: cannot be read: No such file or directory"
    assert "broken.py, line 1: not Python" in second
