"""Signals that trip a drive: inputs that are zero up to a time and one from then on."""

from collections.abc import Mapping, Sequence
from typing import Any


class TripSignals:
    """Participant without inputs whose outputs go from 0 to 1 with the communication step that begins at a time [s] or later."""

    def __init__(self, name: str, outputs: Sequence[str], time: float) -> None:
        self.name = name
        self._names, self._when, self._value = tuple(outputs), time, 0.0

    def enter_initialization(self, start: float) -> None:
        """See `Participant`."""

    def set(self, values: Mapping[str, Any]) -> None:
        """See `Participant`."""

    def outputs(self) -> dict[str, Any]:
        """See `Participant`."""
        return dict.fromkeys(self._names, self._value)

    def exit_initialization(self) -> None:
        """See `Participant`."""

    def step(self, time: float, dt: float) -> None:
        """See `Participant`; what steps after it gets the value at the beginning of the step."""
        self._value = 1.0 if time >= self._when - 1e-6 * dt else 0.0
