"""What a fit does not settle is said: bounds, undetermined and correlated parameters."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np

from comprope_system.identification.estimation.identifiability import identifiability
from comprope_system.identification.estimation.parameter_estimates import Estimate
from comprope_system.identification.prediction.effect_hypotheses import Hypothesis
from comprope_system.identification.prediction.plant_parameters import PLANT_PARAMETERS, Direction
from comprope_system.identification_results.reporting.texts.estimate_sentences import estimate_sentences

TORQUE, FORCE = "effects.bearing_friction.coulomb_torque", "effects.guide_friction.coulomb_force"
PLANT = len(PLANT_PARAMETERS)


def fit(
    torque: float = 22.0, force: float = 5.0, correlation: float = 0.0, error: float = 1.0
) -> tuple[Any, dict[str, Estimate]]:
    """A fit of two effects, of which the first is correlated with the plant's first parameter; and its estimates."""
    directions = (Direction("torque", {TORQUE: 1.0}, 10.0, 0.0, 30.0), Direction("force", {FORCE: 1.0}, 10.0, 0.0))
    covariance = np.diag([0.04] * PLANT + [error**2, error**2])
    covariance[0, PLANT] = covariance[PLANT, 0] = correlation * 0.2 * error
    coefficients = np.array([0.0] * PLANT + [torque, force])
    fitted = SimpleNamespace(hypothesis=Hypothesis("two", directions), coefficients=coefficients, covariance=covariance)
    values = {TORQUE: torque, FORCE: force}
    return cast(Any, fitted), {key: Estimate(one, error, one - 2.0 * error, one + 2.0 * error) for key, one in values.items()}


def test_nothing_is_said_of_parameters_that_the_data_settle() -> None:
    assert estimate_sentences(*fit(correlation=0.9)) == []


def test_a_parameter_at_its_bound_is_named() -> None:
    assert identifiability(*fit(torque=30.0)).at_bound == (TORQUE,)
    assert identifiability(*fit(torque=29.99)).at_bound == ()
    assert estimate_sentences(*fit(torque=30.0)) == [
        "The Coulomb torque of bearing friction is at the limit of what is accepted, where the interval says little."
    ]


def test_a_size_below_its_standard_error_is_undetermined() -> None:
    found = identifiability(*fit(error=6.0))
    assert (found.at_bound, found.undetermined) == ((), (FORCE,))
    assert "do not determine the Coulomb force of guide friction" in estimate_sentences(*fit(error=6.0))[0]


def test_estimates_that_only_hold_together_are_named() -> None:
    found = identifiability(*fit(correlation=-0.97))
    assert [(a, b, round(r, 9)) for a, b, r in found.correlated] == [(TORQUE, "rope.bending_stiffness", -0.97)]
    (sentence,) = estimate_sentences(*fit(correlation=-0.97))
    told = "the Coulomb torque of bearing friction is strongly correlated with the bending stiffness of the rope (-0.97):"
    assert told in sentence
    assert identifiability(*fit(torque=30.0, correlation=-0.97)).correlated == ()  # a bound says it already
