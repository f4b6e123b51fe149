"""Outliers of a measured channel: samples far from their neighbours."""

import numpy as np
from numpy.typing import NDArray

from ..settings import NOISE, WHITENING

Floats = NDArray[np.float64]


def outliers(value: Floats, noise: float, window: int = WHITENING.outlier_window) -> NDArray[np.bool_]:
    """Samples (n,) far from the median of a `window` of neighbours, in units of their scatter or the noise (Hampel filter)."""
    if not len(value):
        return np.zeros(0, bool)
    half = window // 2
    padded = np.pad(value, half, mode="reflect" if len(value) > half else "edge")
    neighbours = np.lib.stride_tricks.sliding_window_view(padded, window)
    middle = np.median(neighbours, axis=1)
    spread = NOISE.mad_factor * np.median(np.abs(neighbours - middle[:, None]), axis=1)
    return np.asarray(np.abs(value - middle) > WHITENING.outlier_threshold * np.maximum(spread, noise))
