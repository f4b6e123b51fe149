"""Noise of a measured channel from its records at rest: an autoregressive model, and the covariance of means of bins.

Instruments filter, so that the noise of successive samples is correlated. The model of order p is

    x_t = a_1 x_(t-1) + ... + a_p x_(t-p) + e_t,    e white with variance s_e^2,

where mean and slope of each record are unknown. Its order is that of least Bayesian information criterion among the fits by
Burg's method (1975) to all records together; for short records the coefficients are refined by restricted maximum likelihood,
because mean and slope take away much of what is slow. See Brockwell and Davis (1991), Time Series, chapters 5 and 8.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.signal import lfilter

from ..settings import NOISE

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class NoiseModel:
    """Stationary noise: `reflection` coefficients (p,) of the autoregression, and the standard deviation of its innovations [SI].

    `samples` is the number of samples that it was estimated from, `trends` that of the means and slopes estimated with it.
    """

    reflection: Floats
    innovation: float
    samples: int
    trends: int = 0

    @property
    def coefficients(self) -> Floats:
        """Coefficients a_1 .. a_p of the autoregression (p,)."""
        return coefficients_of(self.reflection)[-1] if len(self.reflection) else np.zeros(0)

    @property
    def deviation(self) -> float:
        """Standard deviation [SI] of one sample."""
        return float(self.innovation / np.sqrt(np.prod(1.0 - self.reflection**2)))

    @property
    def correlation(self) -> Floats:
        """Autocorrelation (lags,) at 0, 1, 2 ... samples, up to the last lag at which it is not negligible."""
        if not len(self.reflection):
            return np.ones(1)
        impulse = np.zeros(NOISE.max_lags)
        impulse[0] = 1.0
        response = lfilter([1.0], np.concatenate([[1.0], -self.coefficients]), impulse)
        spectrum = np.abs(np.fft.rfft(response, 2 * len(response))) ** 2
        covariance = np.fft.irfft(spectrum)[: len(response)]
        found = covariance / covariance[0]
        return found[: int(np.flatnonzero(np.abs(found) > NOISE.negligible_correlation)[-1]) + 1]

    @property
    def independent(self) -> float:
        """Number of independent samples that determine the variance as well as the correlated samples do."""
        return max(1.0, float(self.samples / (2.0 * np.sum(self.correlation**2) - 1.0)) - self.trends)


def estimate(records: Sequence[Floats]) -> NoiseModel:
    """Model of the noise in some records (n,) of uniform sampling, each with a mean and a slope of its own."""
    centred = [_without_trend(one) for one in records]
    reflection = _burg(centred, _highest_order(centred))
    if len(reflection) and max(len(one) for one in centred) <= NOISE.refined_length:
        reflection = _restricted_likelihood_fit(records, reflection)
    degrees, squares = _squares(records, reflection)
    count = sum(map(len, records))
    return NoiseModel(reflection, float(np.sqrt(squares / max(degrees, 1))), count, count - degrees)


def coefficients_of(reflection: Floats) -> list[Floats]:
    """Coefficients of the predictors of orders 1 .. p from the reflection coefficients (p,), by Levinson's recursion."""
    found: list[Floats] = []
    for k in reflection:
        before = found[-1] if found else np.zeros(0)
        found.append(np.concatenate([before - k * before[::-1], [k]]))
    return found


def _trend(count: int) -> Floats:
    """Mean and slope of a record of `count` samples as columns (count, 2); the mean alone for a short one."""
    columns = [np.ones(count), np.linspace(-1.0, 1.0, count)]
    return np.column_stack(columns[: 2 if count >= NOISE.least_trend else 1])


def _without_trend(record: Floats) -> Floats:
    trend = _trend(len(record))
    return record - trend @ np.linalg.lstsq(trend, record, rcond=None)[0]


def _highest_order(records: Sequence[Floats]) -> int:
    """Highest order tried: few enough coefficients for the number of samples, and for the shortest record."""
    total, longest = sum(map(len, records)), max(map(len, records))
    return max(0, min(NOISE.max_order, total // NOISE.samples_per_coefficient, longest // 3))


def _burg(records: Sequence[Floats], highest: int) -> Floats:
    """Reflection coefficients of the order with the least Bayesian information criterion; none where the records are constant."""
    total = sum(map(len, records))
    forward, backward = [one.copy() for one in records], [one.copy() for one in records]
    variance = sum(float(one @ one) for one in records) / total
    found: list[float] = []
    best, criterion = 0, total * np.log(variance) if variance > 0.0 else -np.inf
    for order in range(1, highest + 1):
        pairs = [(f[1:], b[:-1]) for f, b in zip(forward, backward, strict=True) if len(f) > 1]
        power = sum(float(f @ f + b @ b) for f, b in pairs)
        if power <= 0.0 or variance <= 0.0:
            break
        k = 2.0 * sum(float(f @ b) for f, b in pairs) / power
        k = float(np.clip(k, -NOISE.max_reflection, NOISE.max_reflection))
        forward, backward = [f - k * b for f, b in pairs], [b - k * f for f, b in pairs]
        variance *= 1.0 - k**2
        found.append(k)
        if (tried := total * np.log(variance) + order * np.log(total)) < criterion:
            best, criterion = order, tried
    return np.array(found[:best])


def innovations(values: Floats, reflection: Floats) -> tuple[Floats, Floats]:
    """One-step prediction errors (n, ...) of `values` (n, ...), and their variances (n,) over that of the innovations.

    The first samples are predicted from as many as there are before them, which makes the errors of a stationary process
    independent from the first on.
    """
    predictors, count = coefficients_of(reflection), len(values)
    order = min(len(predictors), count)
    error = values.copy()
    if predictors:
        error = lfilter(np.concatenate([[1.0], -predictors[-1]]), [1.0], values, axis=0)
    for t in range(order):
        error[t] = values[t] - (predictors[t - 1] @ values[t - 1 :: -1][:t] if t else 0.0)
    variance = np.ones(count)
    remaining = np.cumprod(1.0 - reflection[::-1] ** 2)[::-1] if len(reflection) else np.ones(0)
    variance[:order] = 1.0 / remaining[:order]
    return error, variance


def _squares(records: Sequence[Floats], reflection: Floats) -> tuple[int, float]:
    """Degrees of freedom, and sum of squares of the weighted innovations after the best mean and slope of each record."""
    degrees, squares = 0, 0.0
    for record in records:
        rows, target, _ = _weighted(record, reflection)
        left = target - rows @ np.linalg.lstsq(rows, target, rcond=None)[0]
        degrees, squares = degrees + len(record) - rows.shape[1], squares + float(left @ left)
    return degrees, squares


def _weighted(record: Floats, reflection: Floats) -> tuple[Floats, Floats, float]:
    """Trend (n, k) and record (n,) as independent rows of unit variance, and the logarithm of the determinant."""
    both, variance = innovations(np.column_stack([_trend(len(record)), record]), reflection)
    both = both / np.sqrt(variance)[:, None]
    return both[:, :-1], both[:, -1], float(np.sum(np.log(variance)))


def _restricted_likelihood_fit(records: Sequence[Floats], start: Floats) -> Floats:
    """Reflection coefficients (p,) of greatest restricted likelihood: mean and slope of each record are integrated out."""

    def cost(unbounded: Floats) -> float:
        reflection, total, log_determinant = NOISE.max_reflection * np.tanh(unbounded), 0, 0.0
        degrees, squares = _squares(records, reflection)
        for record in records:
            rows, _, log_variances = _weighted(record, reflection)
            log_determinant += log_variances + float(np.linalg.slogdet(rows.T @ rows)[1])
            total += len(record)
        return float(degrees * np.log(squares / degrees) + log_determinant)

    within = np.clip(start / NOISE.max_reflection, -0.999, 0.999)
    return NOISE.max_reflection * np.tanh(minimize(cost, np.arctanh(within), method="L-BFGS-B").x)


def resolution_of(values: Floats) -> float:
    """Step between the values that a coarsely quantised signal (n,) takes; 0 where few of them recur."""
    levels = np.unique(values[np.isfinite(values)])
    known = int(np.isfinite(values).sum())
    return float(np.median(np.diff(levels))) if 1 < len(levels) < known / NOISE.recurrence else 0.0


def bin_covariance(bin_of: NDArray[np.int64], scale: Floats, correlation: Floats) -> Floats:
    """Covariance (bins, bins) of the means of bins under noise of given autocorrelation (lags,).

    `bin_of` (n,) is the bin of each sample of a uniform record, -1 for none, ascending; `scale` (n,) is the standard deviation
    of each sample.
    """
    used = bin_of >= 0
    count = np.bincount(bin_of[used])
    bins, lags = len(count), min(len(correlation), len(bin_of))
    first = np.flatnonzero(used)
    reach = int(max((bin_of[used][np.searchsorted(first, first + lags - 1, side="right") - 1] - bin_of[used]).max(), 0)) + 1
    band = np.zeros(bins * reach)  # covariances of bin j with bins j, j + 1, ...
    for lag in range(lags):
        a, b = bin_of[: len(bin_of) - lag], bin_of[lag:]
        pair = (a >= 0) & (b >= 0)
        product = scale[: len(scale) - lag] * scale[lag:]
        weight = np.where((a == b) & (lag > 0), 2.0, 1.0)
        band += np.bincount(
            (a[pair] * reach + b[pair] - a[pair]), (correlation[lag] * product * weight)[pair], minlength=len(band)
        )
    found = np.zeros((bins, bins))
    for offset, values in enumerate(band.reshape(bins, reach).T):
        rows = np.arange(bins - offset)
        found[rows, rows + offset] = found[rows + offset, rows] = values[: bins - offset]
    return found / np.outer(count, count)
