"""Input estimation: the course of an unknown force from what a model leaves, and how much of that it explains.

The whitened residual is r = A c + P b + e: c are the coefficients of the force in all runs, A their responses, b the plant's
parameters, which are refitted beside it, and e white noise of variance s^2. The prior of a run's c is s^2 k (1 + L^4 D'D)^-1,
scaled to unit variance in its middle, where D takes second differences: regularised deconvolution (Tikhonov 1963; Hansen 2010),
with size k and smoothness L chosen by evidence (MacKay 1992), from which s^2 drops out:

    log p = -N/2 log(r'r - r'X (X'X + 1)^-1 X'r) - 1/2 log |X'X + 1|.

What is explained is judged by cross-validation: cells of one channel and one second are left out in turn, so a force must say
what a channel shows from what the others show, and from before and after.
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
    """Sums of squares and products of some rows: X'X (k, k), X'r (k,) and r'r."""

    matrix: Floats
    vector: Floats
    square: float

    @classmethod
    def of(cls, x: Floats, r: Floats) -> "NormalEquations":
        """Of rows x (n, k) and r (n,)."""
        return cls(x.T @ x, x.T @ r, float(r @ r))

    def scaled(self, by: Floats) -> "NormalEquations":
        """With columns X @ by."""
        return NormalEquations(by.T @ self.matrix @ by, by.T @ self.vector, self.square)

    def without(self, other: "NormalEquations") -> "NormalEquations":
        """Without the rows of another."""
        return NormalEquations(self.matrix - other.matrix, self.vector - other.vector, self.square - other.square)

    def most_likely(self) -> tuple[Floats, float]:
        """Coefficients under a prior of unit variance, and twice the negative log evidence but for constants, less N log."""
        factor = cho_factor(self.matrix + np.eye(len(self.vector)))
        return cho_solve(factor, self.vector), 2.0 * float(np.log(np.diag(factor[0])).sum())

    def missed(self, x: Floats) -> float:
        """Squares that coefficients leave of these rows."""
        return self.square - 2.0 * float(x @ self.vector) + float(x @ self.matrix @ x)


@dataclass(frozen=True)
class Deconvolution:
    """Coefficients of each run's force, and the misfit that they leave where they were not fitted."""

    histories: list[Floats]
    missed: float


def deconvolve(
    matrices: Sequence[Floats], plant: Floats, r: Floats, rows: NDArray[np.bool_], fold: NDArray[np.int64]
) -> Deconvolution:
    """The most likely force at one place.

    `matrices` are the responses of each run (data of the run, coefficients), `rows` (runs, N) which data are a run's; `plant`
    (N, k) the responses to plant parameters of unit prior; r (N,) the residual where those are zero; `fold` (N,) says when a
    datum is left out.
    """
    counts = [one.shape[1] for one in matrices]
    x = np.zeros((len(r), sum(counts)))
    for own, matrix, end in zip(rows, matrices, np.cumsum(counts), strict=True):
        x[own, end - matrix.shape[1] : end] = matrix
    unit = max(float(np.sqrt((x**2).sum() / max(len(x.T), 1))), 1e-300)
    both = np.hstack([x / unit, plant])
    whole = NormalEquations.of(both, r)
    shapes = {smooth: block_diag(*(prior_root(count, smooth) for count in counts)) for smooth in DECONVOLUTION.smoothness}
    found = {smooth: _size(whole, shape, plant.shape[1], len(r)) for smooth, shape in shapes.items()}
    smooth = min(found, key=lambda one: found[one][1])
    root = _root(shapes[smooth], found[smooth][0], plant.shape[1])
    z, _ = whole.scaled(root).most_likely()
    missed = sum(_held_back(whole, NormalEquations.of(both[fold == k], r[fold == k]), root) for k in np.unique(fold))
    return Deconvolution(np.split((root @ z)[: sum(counts)] / unit, np.cumsum(counts)[:-1]), missed)


def _held_back(whole: NormalEquations, held: NormalEquations, root: Floats) -> float:
    """Misfit of rows by what all others say."""
    own = held.scaled(root)
    return own.missed(whole.without(held).scaled(root).most_likely()[0])


def _size(whole: NormalEquations, shape: Floats, plant: int, count: int) -> tuple[float, float]:
    """The likeliest log10 k for one smoothness, and twice the negative log evidence there."""

    def unlikely(size: float) -> float:
        own = whole.scaled(_root(shape, size, plant))
        x, determinant = own.most_likely()
        return count * float(np.log(max(own.square - float(x @ own.vector), 1e-300))) + determinant

    found = minimize_scalar(
        unlikely, bounds=DECONVOLUTION.log_size, method="bounded", options={"xatol": DECONVOLUTION.size_tolerance}
    )
    return float(found.x), float(found.fun)


def _root(shape: Floats, size: float, plant: int) -> Floats:
    """What turns coefficients of unit variance into the force's and the plant's."""
    return block_diag(10.0 ** (0.5 * size) * shape, np.eye(plant))


def prior_root(count: int, smooth: float) -> Floats:
    """A square root of the prior covariance of `count` coefficients, of unit variance in the middle."""
    second = np.diff(np.eye(count), 2, axis=0)
    covariance = np.linalg.inv(np.eye(count) + smooth**4 * second.T @ second)
    return np.asarray(np.linalg.cholesky(covariance / covariance[count // 2, count // 2]))


def cross_validation_folds(whitened_channels: Sequence[WhitenedChannel], times: Sequence[Floats]) -> NDArray[np.int64]:
    """The fold of each datum (N,): neighbours in time and other channels lie in others. `times` are those of the parts' bins."""
    columns = list(dict.fromkeys(one.column for one in whitened_channels))
    found = [
        (time // DECONVOLUTION.fold_duration).astype(np.int64) + 2 * columns.index(one.column)
        for one, time in zip(whitened_channels, times, strict=True)
    ]
    return np.concatenate(found) % DECONVOLUTION.folds
