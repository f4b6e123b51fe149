"""How several ropes share one sheave: by hand, against the full model, with friction and slack; and in the design."""

import numpy as np
import pytest
from typer.testing import CliRunner

from comprope.errors import InputError
from comprope.rope.model_file import with_changes
from comprope.rope.simulator.rope import CompensationRope
from comprope_system.cli import app
from comprope_system.presets.inputs import read_model
from comprope_system.sheave_design.rope_sharing import RopeSet, _Balance, share_sheave

EXCESS = (0.0, 2e-3, -1e-3, 0.0)
MODEL = read_model("tower50")
G, EA, PIT = 9.81, MODEL.rope.axial_stiffness, MODEL.shaft.pit


def test_equal_ropes_share_equally_and_never_slide() -> None:
    found = share_sheave(MODEL, RopeSet((0.0,) * 4))
    assert np.abs(found.shares - 0.25).max() < 1e-9
    assert found.slip.max() < 1e-9


def test_hanging_ropes_differ_by_the_stretch_of_their_excess_length() -> None:
    balance, excess = _Balance(MODEL, RopeSet(EXCESS)), np.array(EXCESS)
    balance.hang(25.0)
    expected = 0.5 * MODEL.sheave.mass_per_rope * G - EA * (excess - excess.mean()) / (50.0 + 2.0 * balance.depth)
    assert balance.pulls[0] == pytest.approx(expected, rel=1e-9)
    assert balance.pulls[1] == pytest.approx(expected, rel=1e-9)


def test_softer_ropes_carry_in_proportion_to_their_stiffness_what_stretches_them() -> None:
    """But for their own weight, whose stretch all have alike in length only where EA is alike."""
    light = with_changes(MODEL, {"rope.mass_per_length": 0.05})
    found = share_sheave(light, RopeSet((0.0, 0.0), (1.0, 0.5)))
    assert found.shares[50] == pytest.approx([2.0 / 3.0, 1.0 / 3.0], rel=0.02)


@pytest.mark.parametrize("car", [10.0, 25.0])
def test_the_full_model_puts_each_rope_s_sheave_at_the_same_depth(car: float) -> None:
    """A rope of another length is one of another pit; its share of the mass as sheave.mass. The groove yields too."""
    balance, depths = _Balance(MODEL, RopeSet(EXCESS)), []
    balance.hang(car)
    for excess, pull in zip(EXCESS, balance.pulls.sum(axis=0), strict=True):
        changes = {"shaft.pit": PIT + 0.5 * excess, "sheave.mass": pull / G, "rope.bending_stiffness": 0.0}
        rope = CompensationRope(with_changes(MODEL, changes))
        rope.solve_equilibrium(car, 50.0 - car)
        depths.append(float(rope.state.q[rope.n]))
    assert max(depths) - min(depths) < 2.5e-4
    assert np.mean(depths) == pytest.approx(balance.depth, abs=4e-4)


def test_friction_holds_differences_until_ropes_slide() -> None:
    """Near the landings sides are short and stiff: a longer rope loses its pull there, and slides; without friction none does."""
    rough = share_sheave(MODEL, RopeSet(EXCESS))
    smooth = share_sheave(with_changes(MODEL, {"contact.friction_coefficient": 0.0}), RopeSet(EXCESS))
    assert np.abs(smooth.pulls[:, 0] - smooth.pulls[:, 1]).max() < 1e-3
    ratio = rough.pulls.max(axis=1) / np.maximum(rough.pulls.min(axis=1), 1e-9)
    assert ratio.max() == pytest.approx(np.exp(0.3 * np.pi), rel=1e-6)
    assert rough.pulls.max() > 2.5 * smooth.pulls.mean()
    assert rough.slip.max() > 1e-3
    for found in (rough, smooth):
        assert found.pulls.sum(axis=(1, 2)) == pytest.approx(4.0 * MODEL.sheave.mass_per_rope * G, rel=1e-5)


def test_a_rope_too_long_is_slack_and_the_others_carry_it() -> None:
    found = share_sheave(MODEL, RopeSet((0.0, 0.02, 0.0, 0.0)))
    assert found.shares[:, 1].max() == 0.0
    assert found.shares[:, 0] == pytest.approx(1.0 / 3.0, rel=1e-6)


@pytest.mark.parametrize(
    ("ropes", "sentence"),
    [
        (((0.0,), ()), "rope_lengths: 1 ropes; 2 to 50 are accepted"),
        (((0.0, 2.0), ()), "rope_lengths: 2 m; -1 to 1 m is accepted"),
        (((0.0, 0.0), (1.0,)), "rope_stiffness: 1 values for 2 ropes; one for each is accepted"),
        (((0.0, 0.0), (1.0, 9.0)), "rope_stiffness: 9; 0.2 to 5 is accepted"),
    ],
)
def test_ropes_that_cannot_be_are_refused(ropes: tuple[tuple[float, ...], tuple[float, ...]], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        RopeSet(*ropes)


def test_a_design_refuses_what_is_no_list_of_lengths() -> None:
    outcome = CliRunner().invoke(app, ["design", "tower50", "--rope-lengths", "0,x"])
    assert outcome.exit_code != 0
    assert "rope-lengths = 0,x: numbers separated by commas are accepted" in str(outcome.exception)
