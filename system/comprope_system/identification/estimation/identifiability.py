"""What a fit does not settle: parameters at a bound, parameters that the data do not determine, and correlated ones."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from ..prediction.effect_hypotheses import Hypothesis
from ..prediction.plant_parameters import PLANT_PARAMETERS, Direction
from ..settings import ESTIMATES
from .gauss_newton import FitResult
from .parameter_estimates import Estimate


@dataclass(frozen=True)
class Identifiability:
    """Keys of parameters of the fitted effects that a fit does not settle.

    `at_bound`: at the least or the largest value that is accepted; `undetermined`: their standard error exceeds their value;
    `correlated`: pairs with the correlation of their estimates, above `ESTIMATES.strong_correlation`.
    """

    at_bound: tuple[str, ...]
    undetermined: tuple[str, ...]
    correlated: tuple[tuple[str, str, float], ...]


def identifiability(fitted: FitResult, estimates: Mapping[str, Estimate]) -> Identifiability:
    """What `fitted` does not settle of the effects' parameters, given as `estimates` by their model keys."""
    own = _own_directions(fitted.hypothesis)
    directions = dict(enumerate([*PLANT_PARAMETERS, *own]))
    bound = [_key(one) for k, one in directions.items() if k >= len(PLANT_PARAMETERS) and _at_bound(one, fitted.coefficients[k])]
    loose = [key for key, one in estimates.items() if key not in bound and _undetermined(key, one)]
    pairs = _correlated(fitted, directions)
    return Identifiability(tuple(bound), tuple(loose), tuple(one for one in pairs if not {*one[:2]} & {*bound, *loose}))


def _own_directions(hypothesis: Hypothesis | None) -> list[Direction]:
    """Directions of the effects, in the order of their coefficients."""
    return [one for part in (hypothesis.parts or (hypothesis,)) for one in part.directions] if hypothesis else []


def _key(one: Direction) -> str:
    """The model key that a direction changes most."""
    return max(one.changes, key=lambda key: abs(one.changes[key]), default=one.name)


def _at_bound(one: Direction, coefficient: float) -> bool:
    reach = 1e-9 * max(1.0, abs(coefficient))
    return any(isfinite(bound) and abs(coefficient - bound) <= reach for bound in (one.lower, one.upper))


def _undetermined(key: str, one: Estimate) -> bool:
    """Whether a size may as well be nothing; a phase has no size."""
    return not key.endswith("phase") and one.standard_error > abs(one.value)


def _correlated(fitted: FitResult, directions: Mapping[int, Direction]) -> list[tuple[str, str, float]]:
    """Pairs of an effect's parameter and another one whose estimates are strongly correlated."""
    correlation, found = _correlation(fitted.covariance), []
    for k in range(len(PLANT_PARAMETERS), len(directions)):
        for other in range(k):
            first, second = _key(directions[k]), _key(directions[other])
            if first != second and abs(correlation[k, other]) > ESTIMATES.strong_correlation:
                found.append((first, second, float(correlation[k, other])))
    return found


def _correlation(covariance: NDArray[np.float64]) -> NDArray[np.float64]:
    """Correlations (n, n) of a covariance (n, n); 0 where a variance is 0."""
    deviation = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    scale = np.divide(1.0, deviation, out=np.zeros_like(deviation), where=deviation > 0.0)
    return np.asarray(covariance * np.outer(scale, scale))
