"""The sheave's bounce and rotation on its rope: frequencies at which a force, or a torque, on it moves it fastest.

No single mode is either of them: the rope's bend at the sheave couples them with the rope's lateral modes, of which there is one
every half hertz, and the sheave's energy is spread over several. The peak of its mobility |v / F| under hysteretic damping,
stiffness K (1 + i LOSS), shows where it is.
"""

from dataclasses import dataclass
from math import pi

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.sparse import csc_array, diags_array
from scipy.sparse.linalg import splu

from comprope.rope.simulator.rope import CompensationRope

from .linearisation import Linear

LOSS = 0.1  # loss factor: makes one peak of the lateral modes' many, and moves it by 0.1 %
LOWEST = 0.05  # of the largest possible frequency: where the search begins
POINTS = 48  # of the search, 6 % apart


@dataclass(frozen=True)
class SheaveResonances:
    """Frequencies [Hz] of the sheave's bounce and of its rotation; None where there is none, as without friction."""

    bounce: float | None
    rotation: float | None


def sheave_resonances(rope: CompensationRope, small: Linear) -> SheaveResonances:
    """The resonances of a rope at rest, from its linearisation."""
    p, sheave, n = rope.model.rope, rope.model.sheave, rope.n
    ends = rope.state.q[[0, n - 1]]
    # No softer than the two sides as springs without mass.
    spring = float((p.axial_stiffness / (rope.state.q[n] - ends)).sum())
    bounce = _peak(small, n, (spring / sheave.mass_per_rope) ** 0.5)
    rotation = _peak(small, 2 * n + 1, sheave.radius * (spring / sheave.inertia_per_rope) ** 0.5)
    return SheaveResonances(bounce, rotation)


def _peak(small: Linear, unknown: int, largest: float) -> float | None:
    """Frequency [Hz] at which the mobility of an unknown is largest, below 1.1 of the largest possible one [rad/s]."""
    place = int(np.searchsorted(small.free, unknown))
    force = np.zeros(len(small.mass), complex)
    force[place] = 1.0

    def mobility(rate: float) -> float:
        dynamic = csc_array(small.stiffness * (1.0 + 1j * LOSS) - diags_array(rate * rate * small.mass))
        return abs(rate * splu(dynamic).solve(force)[place])

    rates = np.geomspace(LOWEST, 1.1, POINTS) * largest
    k = int(np.argmax([mobility(rate) for rate in rates]))
    if not 0 < k < POINTS - 1:
        return None
    found = minimize_scalar(lambda rate: -mobility(rate), bounds=(rates[k - 1], rates[k + 1]), options={"xatol": 1e-4 * rates[k]})
    return float(found.x) / (2.0 * pi)
