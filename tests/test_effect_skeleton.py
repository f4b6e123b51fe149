"""The file that an unknown effect's diagnosis proposes is an effect that can be used as it is."""

from types import SimpleNamespace

import numpy as np
import pytest

from comprope.rope.effects import REGISTRY, user_effects
from comprope.rope.effects.checks.kernel_checks import require_consistent
from comprope_system.identification.residuals.effect_skeleton import effect_skeleton
from comprope_system.identification.residuals.force_locations import force_locations
from comprope_system.identification.residuals.input_estimation import ForceEstimate, InputEstimation, TimeHistory
from comprope_system.identification.residuals.residual_correlation import COORDINATES, ResidualCorrelation
from comprope_system.identification.residuals.skeleton_templates import ENDS, PROPORTIONAL, SINUSOIDS
from comprope_system.measurements import Trip
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited
from comprope_system.report.page import Listing, Section, render

from .virtual_elevator import MODEL, PHASES

TIME = np.arange(0.0, 9.0, 0.1)
TRIP = Trip((jerk_limited(2.0, 7.0, 1.0, PHASES),), 0.0, "profile")
CAMPAIGN = SimpleNamespace(model=MODEL, runs=[SimpleNamespace(file="up.csv", time=TIME, trip=TRIP)])
LOCATIONS = {one.quantity: one for one in force_locations(MODEL)}
FOLLOWED = [ResidualCorrelation(one, 0.9, "") for one in (COORDINATES["position"], *PROPORTIONAL)]
FOLLOWED.append(ResidualCorrelation("a frequency", 0.9, "Hz", 1.7))
FOLLOWED.append(ResidualCorrelation("the sheave's angle", 0.9, "periods a turn", 2.0))
QUANTITIES = ("sheave_force", "sheave_torque", "car_side", "counterweight_side", *ENDS)
EACH = [(QUANTITIES[k % len(QUANTITIES)], FOLLOWED[k % len(FOLLOWED)]) for k in range(4 * len(QUANTITIES))]


def proposed(quantity, *followed, share=0.8, value=None):
    history = TimeHistory(TIME, np.sin(2.0 * np.pi * TRIP.position(TIME) / 2.5) if value is None else value)
    return effect_skeleton(InputEstimation((ForceEstimate(LOCATIONS[quantity], share, {"up.csv": history}),), followed), CAMPAIGN)


@pytest.mark.parametrize(("quantity", "followed"), dict.fromkeys(EACH), ids=str)
def test_a_proposed_file_is_an_effect_whose_power_and_motions_are_right(quantity, followed):
    text = proposed(quantity, followed)
    if quantity in ENDS and followed.coordinate not in SINUSOIDS:
        assert text is None  # the derivatives of the car's speed are not known to a kernel
        return
    with user_effects.temporarily_registered("skeleton.py", text):
        effect = REGISTRY["missing_effect"]
        require_consistent(effect)
        assert effect.hooks.keys() == ({"ends"} if quantity in ENDS else {"forces"})


def test_it_begins_with_what_was_found():
    text = proposed("sheave_force", FOLLOWED[0])
    assert "default=2.5)" in text and "nominal=0.98," in text  # the spacing [m], and the amplitude of the sinusoid [N]
    assert "default=1.7)" in proposed("sheave_torque", FOLLOWED[-2])
    text = proposed("car_side", ResidualCorrelation(COORDINATES["velocity"], 0.9, ""))
    top = np.abs(TRIP.velocity(TIME)).max()  # m/s
    assert f"default={top:.3g})" in text and "p[SIZE] * -v[0] / p[REFERENCE]" in text


@pytest.mark.parametrize(
    ("followed", "share"), [((), 0.8), (FOLLOWED[:1], 0.01), ((ResidualCorrelation("a frequency", 0.3, "Hz", 1.0),), 0.8)]
)
def test_where_nothing_is_clear_nothing_is_proposed(followed, share):
    assert proposed("sheave_force", *followed, share=share) is None


def test_the_page_shows_the_file_as_it_is():
    text = 'size: float = quantity("N", "<b>", 0, 1)\n    k = a & b'
    page = render("sections.html", "title", sections=[Section("force", "Force", [Listing(text, "caption")])])
    assert "<pre>size: float = quantity(&#34;N&#34;, &#34;&lt;b&gt;&#34;, 0, 1)\n    k = a &amp; b</pre>" in page


def test_a_coordinate_that_no_file_can_state_is_passed_over():
    unclear = ResidualCorrelation(COORDINATES["acceleration"], 0.95, "")
    assert "the sheave's angle" in proposed("car_end_out", unclear, FOLLOWED[-1])
