"""Parameter estimates of a fit in SI units with standard errors and confidence intervals, and the fitted model."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, hypot, isfinite

import numpy as np
from numpy.typing import NDArray

from comprope.quantities import Quantity, quantities
from comprope.rope.effects import REGISTRY, RopeModel
from comprope.rope.model_file import with_changes

from ..data.campaign import Campaign
from ..prediction.effect_hypotheses import Hypothesis
from ..prediction.plant_parameters import CLOCK, PLANT_PARAMETERS, plant_values
from ..settings import ESTIMATES, SCORE
from .gauss_newton import FitResult
from .weighted_least_squares import scale_of


@dataclass(frozen=True)
class Estimate:
    """Estimate [SI] of a model parameter: value, standard error, 95 % interval, and the value in the model file."""

    value: float
    standard_error: float
    low: float
    high: float
    before: float | None = None

    def formatted(self) -> str:
        """Value and standard error as text, to the digits that the standard error supports."""
        if not isfinite(self.standard_error) or self.standard_error <= 0.0:
            return f"{self.value:.4g}"
        if abs(self.value) < 1e-3 * self.standard_error:
            return f"0 ± {self.standard_error:.2g}"
        digits = max(0, int(np.ceil(np.log10(max(abs(self.value), self.standard_error) / self.standard_error))) + 1)
        return f"{self.value:.{min(max(digits, 2), 6)}g} ± {self.standard_error:.2g}"

    def to_json(self) -> dict[str, float | None]:
        """Value, standard error and 95 % interval; `deviation` is the former name of `standard_error`."""
        return {
            "value": self.value,
            "deviation": self.standard_error,
            "standard_error": self.standard_error,
            "low": self.low,
            "high": self.high,
            "before": self.before,
        }


def standard_error_scale(fitted: FitResult, count: int) -> float:
    """Factor of standard errors over those of white noise: sqrt(reduced chi-square * count / effective samples), each at least 1.

    A discrepancy is the same in thousands of samples, so a campaign counts as `SCORE.effective_samples`, as in the score.
    """
    return float(np.sqrt(scale_of(fitted.chi_square, count) * max(1.0, count / SCORE.effective_samples)))


def effect_estimates(fitted: FitResult, scale: float = 1.0) -> dict[str, Estimate]:
    """Estimates of all parameters of the fitted effects by model key; `scale` multiplies standard errors."""
    found: dict[str, Estimate] = {}
    at = len(PLANT_PARAMETERS)
    for part, own in fitted.hypothesis.split_coefficients(fitted.effect_coefficients) if fitted.hypothesis else []:
        covariance = scale**2 * fitted.covariance[at : at + len(own), at : at + len(own)]
        at += len(own)
        values = part.parameters(own)
        found |= {key: _estimate(key, value, _standard_error(part, own, covariance, key)) for key, value in values.items()}
    return found


def _standard_error(part: Hypothesis, own: Sequence[float], covariance: NDArray[np.float64], key: str) -> float:
    """Standard error of a parameter by linear error propagation from the coefficients' covariance."""
    by = np.array([one.changes.get(key, 0.0) for one in part.directions])
    if part.polar and key in part.polar:
        (c, s), length = own[:2], max(hypot(*own[:2]), 1e-300)
        size = part.directions[0].changes[part.polar[0]]
        by[:2] = (size * c / length, size * s / length) if key == part.polar[0] else (-s / length**2, c / length**2)
    return float(np.sqrt(max(by @ covariance @ by, 0.0)))


def _estimate(key: str, value: float, standard_error: float) -> Estimate:
    declared = _declared(key)
    low, high = (declared.minimum, declared.maximum) if declared else (-float("inf"), float("inf"))
    reach = ESTIMATES.confidence_quantile * standard_error
    return Estimate(value, standard_error, max(value - reach, low), min(value + reach, high))


def unit_of(effect: str, name: str) -> str:
    """The unit of an effect's parameter, with a space before it; nothing for a pure number."""
    declared = _declared(f"effects.{effect}.{name}")
    unit = declared.unit if declared else {"sensor_delay": "s", "sensor_drift": "1/s", "sensor_height": "m"}.get(effect, "1")
    return "" if unit == "1" else f" {unit.replace('.', '·')}"


def _declared(key: str) -> Quantity | None:
    _, name, short = key.split(".", 2)
    return next((one for one in quantities(REGISTRY[name]) if one.name == short), None) if name in REGISTRY else None


def plant_estimates(campaign: Campaign, fitted: FitResult, scale: float = 1.0) -> dict[str, Estimate]:
    """Estimates of the plant parameters by model key; runs may replace some of them. `scale` multiplies standard errors."""
    base, found = plant_values(campaign.model), {}
    for k, one in enumerate(PLANT_PARAMETERS):
        c, standard_error = float(fitted.coefficients[k]), scale * float(fitted.covariance[k, k]) ** 0.5
        place = (lambda x, at=base[one.name]: at * exp(x)) if one.relative else (lambda x, at=base[one.name]: at + x)
        least = 0.0 if one.changes else -float("inf")
        value, low, high = (
            max(place(c + x), least)
            for x in (0.0, -ESTIMATES.confidence_quantile * standard_error, ESTIMATES.confidence_quantile * standard_error)
        )
        found[one.name] = Estimate(value, standard_error * (value if one.relative else 1.0), low, high, base[one.name])
    return found


def keys_set_by_runs(campaign: Campaign) -> set[str]:
    """Model keys that some run sets, so that the model file's value has no effect there."""
    return {key for run in campaign.runs for key in run.changes}


def fitted_model(campaign: Campaign, fitted: FitResult) -> RopeModel:
    """Model with the fitted plant and effects; parameters that runs set keep the file's values, and the clock is no parameter."""
    replaced = keys_set_by_runs(campaign) | {CLOCK}
    plant = {key: one.value for key, one in plant_estimates(campaign, fitted).items() if key not in replaced}
    return with_changes(campaign.model, plant | dict(fitted.point.effects), "fit")
