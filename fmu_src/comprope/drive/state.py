"""All that changes during a run of the drive, and its bytes."""

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
    """The whole state of a drive.

    `periods` sample periods are over and `elapsed` [s] of the next one, during which the hoist is that of `cell`.
    `integral` [m/s] is the speed control's; `heard` [m] the destination last acted upon; `pulls` [N] those of the
    compensation ropes on car and counterweight at rest; `full` (11,) the hoist's states and then its held inputs.
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
        """The memory as bytes."""
        numbers = (self.elapsed, self.integral, self.heard, *self.pulls, *astuple(self.trip), *self.full)
        return _LAYOUT.pack(_MARK, self.periods, self.cell, *numbers)

    @classmethod
    def unpack(cls, state: bytes) -> "Memory":
        """The memory in bytes made by `pack`; raises `InputError` for any others."""
        if len(state) != _LAYOUT.size or not state.startswith(_MARK):
            raise InputError(f"state of {len(state)} bytes: only a state saved by this version of the drive is accepted")
        _, periods, cell, elapsed, integral, heard, car, counterweight, *rest = _LAYOUT.unpack(state)
        return cls(periods, cell, elapsed, integral, heard, (car, counterweight), SCurve(*rest[:7]), np.array(rest[7:]))
