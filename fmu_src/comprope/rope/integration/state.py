"""The state of a rope, as a few arrays that can be copied, saved and compared bit for bit."""

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from ..mechanics.energy import EFFECTS, END_FORCES, SPENT
from .newmark import COUNTS

Array = NDArray[np.float64]


@dataclass
class State:
    """What a rope of n nodes needs to go on; m = n + 1 columns, the last one the sheave's.

    q, v, a, f  (2 m)  position, velocity, acceleration, force: x (down), then y
    history     (states * m)  history of effects
    powers      last powers of the ledger [W] and forces of the ends' holders [N]
    energy      the ledger [J]
    start       stored energy at the start [J], one number
    count       steps, Newton iterations, factorisations, halvings, worst unknown
    time        one number [s]
    """

    q: Array
    v: Array
    a: Array
    f: Array
    history: Array
    powers: Array
    energy: Array
    start: Array
    count: Array
    time: Array

    def copy(self) -> "State":
        """An independent copy."""
        return State(*(getattr(self, one.name).copy() for one in fields(self)))

    def to_bytes(self) -> bytes:
        """All arrays, one after the other."""
        return b"".join(getattr(self, one.name).tobytes() for one in fields(self))

    def from_bytes(self, data: bytes) -> None:
        """Overwrite this state by one that `to_bytes` gave; shapes must agree."""
        at = 0
        for one in fields(self):
            array = getattr(self, one.name)
            array[...] = np.frombuffer(data, np.float64, array.size, at)
            at += array.nbytes
        if at != len(data):
            raise ValueError(f"the saved state has {len(data)} bytes; this rope's has {at}")


def empty(n: int, states: int, effects: int) -> State:
    """A state of zeros for n nodes, with `states` sections of history and `effects` effects."""
    m = n + 1
    sizes = (2 * m, 2 * m, 2 * m, 2 * m, states * m + 1, END_FORCES + len(SPENT) + effects, EFFECTS + effects, 1, COUNTS, 1)
    return State(*(np.zeros(size) for size in sizes))
