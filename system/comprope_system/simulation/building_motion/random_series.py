"""Random series with a given spectrum, as sums of cosines: amplitudes from the spectrum, phases at random.

x(t) = sum of sqrt(2 S(f) df) cos(2 pi f t + phase) over the lines f = k / duration; M. Shinozuka, G. Deodatis, *Applied Mechanics
Reviews* 44, 1991. S is the one-sided spectral density, so that its integral over f is the variance.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Spectrum = Callable[[Floats], Floats]


@dataclass(frozen=True)
class Lines:
    """Complex amplitudes (k,) of lines at frequencies (k,) [Hz]; `count` samples at intervals of `step` [s]."""

    frequencies: Floats
    amplitudes: NDArray[np.complex128]
    count: int
    step: float

    @property
    def times(self) -> Floats:
        """Times of the samples [s]."""
        return np.asarray(self.step * np.arange(self.count))

    def filtered(self, response: Callable[[Floats], NDArray[np.complex128]]) -> "Lines":
        """The lines behind a linear system with this frequency response."""
        return Lines(self.frequencies, self.amplitudes * response(self.frequencies), self.count, self.step)

    def series(self, derivative: int = 0) -> Floats:
        """The samples (count,) of the series or of a derivative of it."""
        rated = self.amplitudes * (2j * np.pi * self.frequencies) ** derivative
        spectrum = np.concatenate([[0.0], 0.5 * self.count * rated])
        if self.count % 2 == 0:
            spectrum[-1] = 2.0 * spectrum[-1].real
        return np.asarray(np.fft.irfft(spectrum, self.count))


def random_lines(spectrum: Spectrum, duration: float, step: float, random: np.random.Generator) -> Lines:
    """Lines of a random series with a one-sided spectral density over a duration [s]."""
    count = round(duration / step) + 1
    frequencies: Floats = np.asarray(np.fft.rfftfreq(count, step)[1:], float)
    amplitudes = np.sqrt(2.0 * spectrum(frequencies) / (count * step))
    return Lines(frequencies, amplitudes * np.exp(2j * np.pi * random.random(len(frequencies))), count, step)
