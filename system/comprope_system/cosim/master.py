"""The master: steps its participants one after the other and carries values between them.

In each communication step from t to t + dt the participants step in their order (Gauss-Seidel).
An input connected to a participant earlier in the order holds that one's output at t + dt, already
known; an input connected to a later one holds its output at t. With (drive, rope) as the order, the
drive steps under the rope's tensions at t, then the rope follows the drive's motion to t + dt. The
error this makes is of first order in dt, and only in what is fed backward, from rope to drive.

Before the first step, in initialization mode, all connections are followed twice in the same order: drive
gives rope its ends, rope gives drive its tensions at rest, and drive sees them.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import ceil
from typing import Any, Literal, Protocol

Values = Mapping[str, Any]
Known = dict[str, dict[str, Any]]
Coupling = Literal["two-way", "one-way"]


class Participant(Protocol):
    """What the master steps: an FMU, a model in this process, or a prescribed motion."""

    @property
    def name(self) -> str:
        """The name that connections use."""

    def prepare(self, start: float) -> None:
        """Enter initialization at the time `start` [s]; raises `InputError` for impossible parameters."""

    def set(self, values: Values) -> None:
        """Set inputs by name."""

    def outputs(self) -> dict[str, Any]:
        """All outputs by name, at the time reached."""

    def begin(self) -> None:
        """Leave initialization."""

    def step(self, time: float, dt: float) -> None:
        """Advance from `time` to `time + dt` [s]; raises `SimulationError` if that fails."""


@dataclass(frozen=True)
class Connection:
    """`output` of the participant `source` goes into `input` of the participant `target`."""

    source: str
    output: str
    target: str
    input: str


@dataclass(frozen=True)
class Sample:
    """The outputs of every participant at a time [s], after `count` of `total` steps."""

    time: float
    outputs: Known
    count: int
    total: int


def co_simulate(
    participants: Sequence[Participant],
    connections: Sequence[Connection],
    duration: float,
    step: float,
    start: float = 0.0,
    coupling: Coupling = "two-way",
) -> Iterator[Sample]:
    """Run the participants in their order, yielding a sample at the start and after each step.

    `duration` and communication step are in s; the last step ends at or after start + duration.
    With "one-way" coupling, backward connections keep the values they had at the start.
    """
    total = ceil(duration / step * (1.0 - 1e-9))
    known = _initialised(participants, connections, start)
    yield Sample(start, dict(known), 0, total)
    order = [one.name for one in participants]
    live = [one for one in connections if coupling == "two-way" or order.index(one.source) < order.index(one.target)]
    for count in range(total):
        time = start + count * step
        for participant in participants:
            participant.set(_inputs(participant.name, live, known))
            participant.step(time, step)
            known[participant.name] = participant.outputs()
        yield Sample(start + (count + 1) * step, dict(known), count + 1, total)


def _initialised(participants: Sequence[Participant], connections: Sequence[Connection], start: float) -> Known:
    """Outputs at the start that agree with each other."""
    known: Known = {}
    for participant in participants:
        participant.prepare(start)
    for _ in range(2):
        for participant in participants:
            participant.set(_inputs(participant.name, connections, known))
            known[participant.name] = participant.outputs()
    for participant in participants:
        participant.begin()
    return known


def _inputs(target: str, connections: Sequence[Connection], known: Mapping[str, Values]) -> dict[str, Any]:
    """What is known by now of the inputs of `target`."""
    return {one.input: known[one.source][one.output] for one in connections if one.target == target and one.source in known}
