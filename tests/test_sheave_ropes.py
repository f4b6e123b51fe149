"""`sheave.ropes`: several ropes carry equal shares of a sheave, so that one of them moves as on a sheave of its share."""

import numpy as np
import pytest

from comprope.drive.parameters import Profile
from comprope.drive.trajectory.s_curve import plan_s_curve
from comprope.fmi.instance import Instance
from comprope.rope.model_file import dump, load, with_changes
from comprope.rope.parameters.parameter_vector import ELEMENT, slot
from comprope.rope.simulator.cosimulation import interface
from comprope.rope.simulator.parameter_directions import parameter_change
from comprope_system.vibration.modal.modes import modes
from comprope_system.vibration.reduced_model.string_dynamics import string_parameters

from .rope_tower import STUB, TOWER, ride, rope

FOUR = {"sheave.mass": 480.0, "sheave.inertia": 38.4, "sheave.ropes": 4.0}  # shares of a fourth: the tower's 120 kg, 9.6 kg m2


def test_four_ropes_on_a_sheave_four_times_as_heavy_move_to_the_same_bits() -> None:
    trip, found = plan_s_curve(Profile(), 20.0, 21.0, 0.1), []
    for moving in (rope(), rope(FOUR)):
        moving.solve_equilibrium(20.0, 30.0)
        for _ in range(40):
            ride(moving, trip, 0.016)
        found.append(np.concatenate([moving.state.q, moving.state.energy, list(moving.outputs().values())]))
    assert np.array_equal(*found)
    assert rope({"sheave.ropes": 4.0}).element != rope().element  # ropes alone make the share lighter


def test_a_file_may_give_the_whole_sheave_and_keeps_it(tmp_path) -> None:
    dump(with_changes(TOWER, FOUR), tmp_path / "four.toml")
    assert "ropes = 4.0" in (tmp_path / "four.toml").read_text()
    again = load(tmp_path / "four.toml")
    assert (again.sheave.mass, again.sheave.mass_per_rope, again.sheave.inertia_per_rope) == (480.0, 120.0, 9.6)
    text = (tmp_path / "four.toml").read_text().replace("ropes = 4.0\n", "")
    (tmp_path / "one.toml").write_text(text)
    assert load(tmp_path / "one.toml").sheave.mass_per_rope == 480.0


def test_modes_and_the_reduced_model_take_the_share() -> None:
    plain, four = (with_changes(STUB, changes) for changes in ({}, FOUR))
    assert string_parameters(four) == string_parameters(plain)
    found = [modes(model, 0.4, 3) for model in (plain, four)]
    assert [one.period for one in found[0].modes] == [one.period for one in found[1].modes]


def test_the_number_of_ropes_is_a_parameter_of_the_fmu() -> None:
    model = interface(STUB)
    places = {one.name: place for place, one in enumerate(model.variables)}
    found = []
    for ropes in (1.0, 4.0):
        instance = Instance(model)
        instance.set_values("real", [places["sheave.ropes"]], [ropes])
        instance.exit_initialization()
        (force,) = instance.get_values("real", [places["sheave_force"]])
        found.append(force)
    assert found == pytest.approx([STUB.sheave.mass * 9.81, STUB.sheave.mass * 9.81 / 4.0], rel=1e-5)  # of one rope


def test_derivatives_are_by_the_whole_mass() -> None:
    plain, four = rope(), rope(FOUR)
    by_share, by_whole = (parameter_change(one, {"sheave.mass": 1.0, "sheave.inertia": 1.0}) for one in (plain, four))
    assert [by_whole[slot(f"derived.{name}_per_rope")] for name in ("mass", "inertia")] == [0.25, 0.25]
    assert by_whole[ELEMENT] == pytest.approx(0.25 * by_share[ELEMENT], rel=1e-6)
    lighter = parameter_change(four, {"sheave.ropes": 1.0})
    assert [lighter[slot(f"derived.{name}_per_rope")] for name in ("mass", "inertia")] == [-30.0, -2.4]
