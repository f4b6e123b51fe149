"""A model as a participant in the same process, without an FMU, with the same results."""

from collections import defaultdict
from collections.abc import Mapping
from typing import Any

from comprope.errors import InputError
from comprope.fmi.instance import Instance
from comprope.fmi.model_interface import Kind, ModelInterface, Simulator, Variable


class InProcessParticipant:
    """A participant that uses the simulator of a model as its FMU does."""

    def __init__(self, name: str, interface: ModelInterface, parameters: Mapping[str, Any]) -> None:
        """Raises `InputError` for unknown or invalid parameters."""
        self.name = name
        self._instance = Instance(interface)
        self._references = {one.name: (reference, one) for reference, one in enumerate(interface.variables)}
        self._outputs = [one.name for one in interface.of_role("output")]
        self.set(parameters)

    @property
    def simulator(self) -> Simulator:
        """The present simulator; a new one is created when parameters change before the first step."""
        return self._instance.simulator

    def enter_initialization(self, start: float) -> None:
        """See `Participant`."""
        self._instance.setup_experiment(start, None)

    def set(self, values: Mapping[str, Any]) -> None:
        """See `Participant`."""
        for kind, names in self._by_kind(list(values)).items():
            self._instance.set_values(kind, [self._references[name][0] for name in names], [values[name] for name in names])

    def outputs(self) -> dict[str, Any]:
        """See `Participant`."""
        values: dict[str, Any] = {}
        for kind, names in self._by_kind(self._outputs).items():
            values |= zip(names, self._instance.get_values(kind, [self._references[name][0] for name in names]), strict=True)
        return values

    def exit_initialization(self) -> None:
        """See `Participant`."""
        self._instance.exit_initialization()

    def step(self, time: float, dt: float) -> None:
        """See `Participant`."""
        self._instance.do_step(time, dt)

    def _by_kind(self, names: list[str]) -> dict[Kind, list[str]]:
        groups: dict[Kind, list[str]] = defaultdict(list)
        for name in names:
            groups[self._variable(name).kind].append(name)
        return groups

    def _variable(self, name: str) -> Variable:
        if name not in self._references:
            raise InputError(f"{self.name}: {name} is not one of its variables")
        return self._references[name][1]
