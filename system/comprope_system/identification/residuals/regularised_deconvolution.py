"""Regularised deconvolution: time history of an unknown force from a residual, and how much of the residual it explains.

The whitened residual is r = A c + P b + e: c are the coefficients of the force in all runs, A their responses, b the plant's
parameters, which are refitted beside it, and e white noise of variance s^2. The prior of a run's c is s^2 k (1 + L^4 D'D)^-1,
scaled to unit variance in its middle, where D takes second differences (Tikhonov 1963; Hansen 2010); the variance k and the
smoothness L maximise the evidence (MacKay 1992), from which s^2 drops out:

    log p = -N/2 log(r'r - r'X (X'X + 1)^-1 X'r) - 1/2 log |X'X + 1|.

The explained part is found by cross-validation. A fold leaves out some seconds of one channel, so the force must predict a
channel from the others and from before and after.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag, cho_factor, cho_solve
from scipy.optimize import minimize_scalar

from ..data.whitening import WhitenedChannel
from ..settings import DECONVOLUTION

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class NormalEquations:
    """Normal equations of some rows (X, r): X'X (k, k), X'r (k,) and r'r."""

    matrix: Floats
    vector: Floats
    square: float

    @classmethod
    def of(cls, x: Floats, r: Floats) -> "NormalEquations":
        """Normal equations of the rows x (n, k) and r (n,)."""
        return cls(x.T @ x, x.T @ r, float(r @ r))

    def transformed(self, by: Floats) -> "NormalEquations":
        """Normal equations of (X by, r), with `by` (k, m)."""
        return NormalEquations(by.T @ self.matrix @ by, by.T @ self.vector, self.square)

    def without(self, other: "NormalEquations") -> "NormalEquations":
        """Normal equations without the rows of another."""
        return NormalEquations(self.matrix - other.matrix, self.vector - other.vector, self.square - other.square)

    def most_probable(self) -> tuple[Floats, float]:
        """Coefficients (k,) with a prior of unit variance, and log |X'X + 1|."""
        factor = cho_factor(self.matrix + np.eye(len(self.vector)))
        return cho_solve(factor, self.vector), 2.0 * float(np.log(np.diag(factor[0])).sum())

    def chi_square(self, x: Floats) -> float:
        """Sum of squares |r - X x|^2 of coefficients x (k,)."""
        return self.square - 2.0 * float(x @ self.vector) + float(x @ self.matrix @ x)


@dataclass(frozen=True)
class Deconvolution:
    """Coefficients of the force in each run, and the chi-square by cross-validation."""

    coefficients: list[Floats]
    held_out_chi_square: float


def deconvolve(
    matrices: Sequence[Floats], plant: Floats, r: Floats, rows: NDArray[np.bool_], fold: NDArray[np.int64]
) -> Deconvolution:
    """Most probable force at one location.

    `matrices` are the responses of each run (data of the run, coefficients), `rows` (runs, N) the data that belong to a run,
    `plant` (N, k) the responses to plant parameters of unit prior, r (N,) the residual with these at zero, and `fold` (N,) the
    fold of the cross-validation in which a datum is left out.
    """
    counts = [one.shape[1] for one in matrices]
    x = np.zeros((len(r), sum(counts)))
    for own, matrix, end in zip(rows, matrices, np.cumsum(counts), strict=True):
        x[own, end - matrix.shape[1] : end] = matrix
    unit = max(float(np.sqrt((x**2).sum() / max(len(x.T), 1))), 1e-300)
    both = np.hstack([x / unit, plant])
    equations = NormalEquations.of(both, r)
    shapes = {smooth: block_diag(*(prior_root(count, smooth) for count in counts)) for smooth in DECONVOLUTION.smoothness}
    found = {smooth: _most_probable_size(equations, shape, plant.shape[1], len(r)) for smooth, shape in shapes.items()}
    smooth = min(found, key=lambda one: found[one][1])
    root = _joint_root(shapes[smooth], found[smooth][0], plant.shape[1])
    z, _ = equations.transformed(root).most_probable()
    left_out = [NormalEquations.of(both[fold == k], r[fold == k]) for k in np.unique(fold)]
    chi_square = sum(_held_out_chi_square(equations, one, root) for one in left_out)
    return Deconvolution(np.split((root @ z)[: sum(counts)] / unit, np.cumsum(counts)[:-1]), chi_square)


def prior_root(count: int, smooth: float) -> Floats:
    """Cholesky factor of the prior covariance of `count` coefficients, with unit variance in the middle."""
    second = np.diff(np.eye(count), 2, axis=0)
    covariance = np.linalg.inv(np.eye(count) + smooth**4 * second.T @ second)
    return np.asarray(np.linalg.cholesky(covariance / covariance[count // 2, count // 2]))


def cross_validation_folds(whitened_channels: Sequence[WhitenedChannel], times: Sequence[Floats]) -> NDArray[np.int64]:
    """Fold of each datum (N,); neighbours in time and other channels lie in other folds. `times` [s] are those of the bins."""
    columns = list(dict.fromkeys(one.column for one in whitened_channels))
    found = [
        (time // DECONVOLUTION.fold_duration).astype(np.int64) + 2 * columns.index(one.column)
        for one, time in zip(whitened_channels, times, strict=True)
    ]
    return np.concatenate(found) % DECONVOLUTION.folds


def _held_out_chi_square(equations: NormalEquations, held: NormalEquations, root: Floats) -> float:
    """Chi-square of some rows with coefficients from all others."""
    own = held.transformed(root)
    return own.chi_square(equations.without(held).transformed(root).most_probable()[0])


def _most_probable_size(equations: NormalEquations, shape: Floats, plant: int, count: int) -> tuple[float, float]:
    """log10 k of maximum evidence for one smoothness, and minus twice the logarithm of the evidence there."""

    def minus_twice_log_evidence(size: float) -> float:
        own = equations.transformed(_joint_root(shape, size, plant))
        x, determinant = own.most_probable()
        return count * float(np.log(max(own.square - float(x @ own.vector), 1e-300))) + determinant

    options = {"xatol": DECONVOLUTION.size_tolerance}
    found = minimize_scalar(minus_twice_log_evidence, bounds=DECONVOLUTION.log_size, method="bounded", options=options)
    return float(found.x), float(found.fun)


def _joint_root(shape: Floats, size: float, plant: int) -> Floats:
    """Factor of the joint prior covariance of force and plant: maps coefficients of unit variance to those of both."""
    return block_diag(10.0 ** (0.5 * size) * shape, np.eye(plant))
