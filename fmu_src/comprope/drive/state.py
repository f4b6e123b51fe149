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
class DriveState:
    """The complete state of a drive.

    `periods` sample periods have passed and `elapsed` [s] of the next one, during which the plant is that of
    `operating_point`. `integral` [m/s] is that of the speed controller; `called` [m] the last accepted destination, and
    `s_curve` the trip to it before smoothing and shaping; `rest_forces` [N] the forces of the compensation ropes on car and
    counterweight in the initial equilibrium; `vector` (11,) the hoist's states followed by its inputs.
    """

    periods: int
    operating_point: int
    elapsed: float
    integral: float
    called: float
    rest_forces: tuple[float, float]
    s_curve: SCurve
    vector: np.ndarray

    def to_bytes(self) -> bytes:
        """The state as bytes."""
        numbers = (self.elapsed, self.integral, self.called, *self.rest_forces, *astuple(self.s_curve), *self.vector)
        return _LAYOUT.pack(_MARK, self.periods, self.operating_point, *numbers)

    @classmethod
    def from_bytes(cls, state: bytes) -> "DriveState":
        """The state from bytes of `to_bytes`; raises `InputError` for any others."""
        if len(state) != _LAYOUT.size or not state.startswith(_MARK):
            raise InputError(f"state of {len(state)} bytes: only a state saved by this version of the drive is accepted")
        _, periods, point, elapsed, integral, called, car, counterweight, *rest = _LAYOUT.unpack(state)
        return cls(periods, point, elapsed, integral, called, (car, counterweight), SCurve(*rest[:7]), np.array(rest[7:]))
