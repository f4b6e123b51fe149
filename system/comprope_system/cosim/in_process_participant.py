"""A model stepped in this process, without an FMU around it, by the same rules and with the same numbers."""

from collections import defaultdict
from collections.abc import Mapping
from typing import Any

from comprope.errors import InputError
from comprope.fmi.instance import Run
from comprope.fmi.model_interface import Engine, Kind, ModelInterface, Variable


class DirectParticipant:
    """A participant that runs a model's engine as its FMU's face does."""

    def __init__(self, name: str, interface: ModelInterface, parameters: Mapping[str, Any]) -> None:
        """Raises `InputError` for parameters that the model does not have or cannot take."""
        self.name = name
        self._run = Run(interface)
        self._references = {one.name: (reference, one) for reference, one in enumerate(interface.variables)}
        self._outputs = [one.name for one in interface.of_role("output")]
        self.set(parameters)

    @property
    def engine(self) -> Engine:
        """What runs the model now; another one once parameters have changed before the first step."""
        return self._run.engine

    def prepare(self, start: float) -> None:
        """See `Participant`."""
        self._run.plan(start, None)

    def set(self, values: Mapping[str, Any]) -> None:
        """See `Participant`."""
        for kind, names in self._by_kind(list(values)).items():
            self._run.write(kind, [self._references[name][0] for name in names], [values[name] for name in names])

    def outputs(self) -> dict[str, Any]:
        """See `Participant`."""
        values: dict[str, Any] = {}
        for kind, names in self._by_kind(self._outputs).items():
            values |= zip(names, self._run.read(kind, [self._references[name][0] for name in names]), strict=True)
        return values

    def begin(self) -> None:
        """See `Participant`."""
        self._run.begin()

    def step(self, time: float, dt: float) -> None:
        """See `Participant`."""
        self._run.step(time, dt)

    def _by_kind(self, names: list[str]) -> dict[Kind, list[str]]:
        groups: dict[Kind, list[str]] = defaultdict(list)
        for name in names:
            groups[self._variable(name).kind].append(name)
        return groups

    def _variable(self, name: str) -> Variable:
        if name not in self._references:
            raise InputError(f"{self.name}: {name} is not one of its variables")
        return self._references[name][1]
