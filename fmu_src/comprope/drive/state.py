"""State of the drive and its serialisation."""

import struct
from dataclasses import astuple, dataclass

import numpy as np

from ..errors import InputError
from .hoist_dynamics import INPUTS, STATES
from .trajectory.s_curve import SCurve

_LAYOUT = struct.Struct(f"<8s2q5d7d{len(STATES) + len(INPUTS)}d")
_MARK = b"drive 1\0"


@dataclass
class Memory:
    """The complete state of a drive.

    `periods` sample periods have passed and `elapsed` [s] of the next one, during which the linearisation `cell` of the hoist
    is used. `integral` [m/s] is that of the speed controller; `heard` [m] the last accepted destination; `pulls` [N] the pulls
    of the compensation ropes on car and counterweight in the initial equilibrium; `full` (11,) the hoist's states followed by
    its inputs.
    """

    periods: int
    cell: int
    elapsed: float
    integral: float
    heard: float
    pulls: tuple[float, float]
    trip: SCurve
    full: np.ndarray

    def pack(self) -> bytes:
        """The state as bytes."""
        numbers = (self.elapsed, self.integral, self.heard, *self.pulls, *astuple(self.trip), *self.full)
        return _LAYOUT.pack(_MARK, self.periods, self.cell, *numbers)

    @classmethod
    def unpack(cls, state: bytes) -> "Memory":
        """The state from bytes of `pack`; raises `InputError` for any others."""
        if len(state) != _LAYOUT.size or not state.startswith(_MARK):
            raise InputError(f"state of {len(state)} bytes: only a state saved by this version of the drive is accepted")
        _, periods, cell, elapsed, integral, heard, car, counterweight, *rest = _LAYOUT.unpack(state)
        return cls(periods, cell, elapsed, integral, heard, (car, counterweight), SCurve(*rest[:7]), np.array(rest[7:]))
