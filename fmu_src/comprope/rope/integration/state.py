"""The state of a rope at its start: arrays of zeros."""

import numpy as np

from ..mechanics.energy import EFFECTS, END_FORCES, SPENT
from ..mechanics.run_record import RECORD
from ..runtime.kernel_arguments import State
from .newmark import COUNTERS


def empty_state(n: int, states: int, effects: int) -> State:
    """A state of zeros for n nodes, with `states` sections of history and `effects` effects."""
    m = n + 1
    powers, energy = END_FORCES + len(SPENT) + effects, EFFECTS + effects
    sizes = (2 * m, 2 * m, 2 * m, 2 * m, states * m + 1, powers, energy, 1, RECORD, COUNTERS, 1)
    return State(*(np.zeros(size) for size in sizes))
