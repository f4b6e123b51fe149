"""The groups of arrays and sizes that kernels take: each declared once, with names and types.

In Python the arrays are numpy's; compiled kernels get their addresses. Kernels read a group's fields by name, or
unpack them to the letters of the paper: `q, v = state.q, state.v`. m = n + 1 columns make one section (see
`array_layout`).
"""

from typing import Any, NamedTuple

import numpy as np

from ...kernels.entry_source import Array


class RopeData(NamedTuple):
    """Sizes and parameters of one rope: they stay the same."""

    n: int  # nodes
    effects: int
    history_size: int  # numbers that effects remember
    p: Array  # parameter vector, see `parameter_vector`
    frictionless: Array  # the same without friction and without effects that have a history: for static equilibrium


class State(NamedTuple):
    """What a rope needs to go on from an accepted time step; it can be copied, saved and compared bit for bit."""

    q: Array  # (2 m) position: x (down), then y
    v: Array  # (2 m) velocity
    a: Array  # (2 m) acceleration
    f: Array  # (2 m) force
    history: Array  # (history_size + 1) history of effects
    powers: Array  # last powers of the energy balance [W] and forces that hold the ends [N]
    energy: Array  # energy balance [J]
    start: Array  # stored energy at the start [J], one number
    record: Array  # what the run has seen so far, see `run_record`
    counters: Array  # steps, Newton iterations, factorisations, halvings, worst unknown
    time: Array  # one number [s]

    def copy(self) -> "State":
        """An independent copy."""
        return State(*(array.copy() for array in self))

    def to_bytes(self) -> bytes:
        """All arrays, one after the other."""
        return b"".join(array.tobytes() for array in self)

    def from_bytes(self, data: bytes) -> None:
        """Overwrite this state by one that `to_bytes` gave; shapes must agree."""
        offset = 0
        for array in self:
            array[...] = np.frombuffer(data, np.float64, array.size, offset)
            offset += array.nbytes
        if offset != len(data):
            raise ValueError(f"the saved state has {len(data)} bytes; this rope's has {offset}")


class Motion(NamedTuple):
    """Positions, velocities and accelerations (2 m each); as a kernel's argument those of the step being tried."""

    q: Array
    v: Array
    a: Array


class Ends(NamedTuple):
    """What moves the rope's ends: inputs, their last samples, and the path through one communication step."""

    samples: Array  # memory of the inputs, see `input_interpolation`
    path: Array  # see `end_conditions`
    u: Array  # inputs, see `inputs`
    options: Array  # see `input_interpolation`
    base: Array  # acceleration of the building's base [m/s2] at the start and at the end of the path


class Workspace(NamedTuple):
    """What kernels compute on the way to a step; see `array_layout` for the sections of each array."""

    w: Array  # segments and nodes
    f: Array  # (2 m) forces of the last evaluation
    history: Array  # history of effects after that evaluation
    powers: Array  # as State.powers
    contact: Array  # contact
    power: Array  # power of each effect [W]
    A: Array  # block band of the tangent
    L: Array  # factor of A
    B: Array  # bordered band at the sheave
    Z: Array  # tangent of the contact
    r: Array  # (2 m) residual, then correction
    message: Array  # numbers for the message of a status, see `status`


class Outputs(NamedTuple):
    """What sensors and outputs show."""

    sensors: Array  # two numbers each: height [m], 1 on the counterweight's side or 0 on the car's
    reading: Array  # of one sensor: two numbers
    y: Array  # all outputs, see `outputs`


class DirectionsWorkspace(NamedTuple):
    """What kernels compute on the way to directional derivatives; names end in 1 for a state a small step along a direction."""

    p1: Array
    frictionless1: Array
    path1: Array
    w1: Array
    f1: Array  # (2 m) forces of effects in the present state
    moves: Array  # (2 m) moves to the state beside
    elongations: Array  # (2 m) L - l of each segment, then its rate
    centre: Array  # derivatives of the groove's centre, a lane for each direction of a block
    history_before: Array  # the rope's history before the step
    history_in: Array  # the history with which a direction is evaluated
    history_out: Array  # what that evaluation makes of it
    D: Array  # derivative of the forces, as Directions.dq
    lift: Array  # derivative of the vertical force on the sheave, a lane for each direction
    readings: Array  # of all sensors, with derivatives


class Directions(NamedTuple):
    """Directions in the space of parameters, and how the motion answers them; see `directions` for how they are stored."""

    number: int
    blocks: int
    parameters: int
    exact: int  # 1 to factor the tangent anew in the state reached, 0 to take what the step has left
    base: Array  # parameters from which each direction starts
    change: Array  # change of the parameters along each direction
    dp: Array  # the same, in lanes
    dpath: Array  # change of the ends' path
    max_step: Array  # largest step along a direction by which forces are differenced
    moves_ends: Array  # 1 where the ends move along a direction
    effects_mode: Array  # how effects take part, see `effects`
    new_history: Array  # 1 where an effect with history begins along a direction
    dq: Array  # derivatives of the motion, and of what the balance of the last step leaves for the next (dc)
    dv: Array
    da: Array
    dc: Array
    dh: Array  # derivatives of the history
    work: DirectionsWorkspace


class TimeStep(NamedTuple):
    """One time step: the time t at its end, its length h, and t as the fraction s of a path of length dt [s]."""

    t: float
    h: float
    dt: float
    s: float
    slack: bool  # whether it takes the rule for slack rope, see `newmark`


class Weights(NamedTuple):
    """A tangent is a mass matrix less ck df/dq + cc df/dv."""

    ck: float
    cc: float


# In the order in which entry points find them in their table of arrays; what makes the state of a simulation comes first.
TABLE: tuple[Any, ...] = (State, Ends, RopeData, Motion, Workspace, Outputs, Directions)
