"""Lateral motion of the building by height and time, from a few coordinates and the shape of each.

u(z, t) = sum of shape_k(z) r_k(t), cubic splines over the height and in time. The frame is that of the
base, the height of the sheave's axle: what is given is u(z, t) - u(base, t), and the base's acceleration.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline

Floats = NDArray[np.float64]


class BuildingMotion:
    """Displacement relative to the base [m], and acceleration of the base [m/s2], towards the counterweight's side."""

    def __init__(self, heights: ArrayLike, shapes: ArrayLike, coordinates: CubicSpline, base: float) -> None:
        """`shapes` (k, heights) of the `coordinates` (k) [m], which are a spline in time [s]; `base` is a height [m]."""
        self._low, self._high = float(np.min(heights)), float(np.max(heights))
        self._shapes = CubicSpline(heights, np.asarray(shapes, float).T)
        self._slopes = self._shapes.derivative()
        self._base = self._shape(base)
        self._coordinates, self._accelerations = coordinates, coordinates.derivative(2)
        self.begin, self.end = float(coordinates.x[0]), float(coordinates.x[-1])

    def displacement(self, height: float, time: float) -> float:
        """Displacement relative to the base [m] at a height [m]; before the record it is that of its begin."""
        return float((self._shape(height) - self._base) @ self._coordinates(min(max(time, self.begin), self.end)))

    def displacements(self, heights: ArrayLike, times: ArrayLike) -> Floats:
        """The same for heights (n,) and times (m,): (m, n)."""
        shapes = np.array([self._shape(float(one)) - self._base for one in np.atleast_1d(np.asarray(heights, float))])
        return np.asarray(self._coordinates(np.clip(np.asarray(times, float), self.begin, self.end)) @ shapes.T)

    def base_acceleration(self, time: float) -> float:
        """Acceleration of the base [m/s2]; none before the record."""
        return float(self._base @ self._accelerations(min(time, self.end))) if time >= self.begin else 0.0

    def _shape(self, height: float) -> Floats:
        """Shapes (k,) at a height; beyond the given heights they go on straight, as an end that overruns a landing needs."""
        inside = min(max(height, self._low), self._high)
        return np.asarray(self._shapes(inside) + (height - inside) * self._slopes(inside))
