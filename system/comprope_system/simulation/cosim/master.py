"""Co-simulation master: steps its participants sequentially and transfers values between them.

In each communication step from t to t + dt the participants step in their order (Gauss-Seidel).
An input connected to an earlier participant has that participant's output at t + dt; an input
connected to a later one has its output at t. With the order (drive, rope), the
drive steps with the tensions of the rope at t, then the rope with the motion of the drive up to t + dt. The
coupling error is of first order in dt, and only in the values fed back from rope to drive.

Before the first step, in initialization mode, all connections are evaluated twice in the same order: positions
of the ends from drive to rope, then static tensions from rope to drive.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import ceil
from typing import Any, Literal, Protocol

Values = Mapping[str, Any]
Known = dict[str, dict[str, Any]]
Coupling = Literal["two-way", "one-way"]


class Participant(Protocol):
    """Interface of a participant: an FMU, a model in the same process, or a prescribed motion."""

    @property
    def name(self) -> str:
        """The name used by connections."""

    def enter_initialization(self, start: float) -> None:
        """Enter initialization at the time `start` [s]; raises `InputError` for impossible parameters."""

    def set(self, values: Values) -> None:
        """Set inputs by name."""

    def outputs(self) -> dict[str, Any]:
        """All outputs by name at the current time."""

    def exit_initialization(self) -> None:
        """Leave initialization."""

    def step(self, time: float, dt: float) -> None:
        """Advance from `time` to `time + dt` [s]; raises `SimulationError` if that fails."""


@dataclass(frozen=True)
class Connection:
    """Connection of `output` of the participant `source` to `input` of the participant `target`."""

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
    """Co-simulate the participants in their order, yielding a sample at the start and after each step.

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
    """Consistent initial outputs."""
    known: Known = {}
    for participant in participants:
        participant.enter_initialization(start)
    for _ in range(2):
        for participant in participants:
            participant.set(_inputs(participant.name, connections, known))
            known[participant.name] = participant.outputs()
    for participant in participants:
        participant.exit_initialization()
    return known


def _inputs(target: str, connections: Sequence[Connection], known: Mapping[str, Values]) -> dict[str, Any]:
    """The inputs of `target` that are known so far."""
    return {one.input: known[one.source][one.output] for one in connections if one.target == target and one.source in known}
