"""A `Pair` whose FMU speaks FMI 3.0: its calls under the names they have in FMI 2.0, and what is done otherwise."""

from collections.abc import Callable, Mapping, Sequence
from itertools import islice
from typing import Any

from fmpy.fmi3 import FMU3Slave

from comprope.fmi.arrays import groups_of

from .fmi_pair import Pair


class Slave(FMU3Slave):  # type: ignore[misc]
    """An FMI 3.0 instance that can be called like one of FMI 2.0.

    `arrays` gives, for the value reference in FMI 2.0 of an element of an array, the array's reference, its size and the
    element's index; an element is read and set with its array.
    """

    getInteger = FMU3Slave.getInt32  # noqa: N815
    _window: tuple[float, float | None] = (0.0, None)

    def __init__(self, arrays: Mapping[int, tuple[int, int, int]] | None = None, **given: Any) -> None:
        super().__init__(**given)
        self._arrays = arrays or {}

    def getReal(self, references: Sequence[int]) -> list[float]:  # noqa: N802
        """Real values."""
        return self._elements(self.getFloat64, references)

    def getBoolean(self, references: Sequence[int], nValues: int | None = None) -> list[bool]:  # noqa: N802
        """Boolean values."""
        if nValues is not None:
            return list(super().getBoolean(references, nValues))
        return self._elements(super().getBoolean, references)

    def setReal(self, references: Sequence[int], values: Sequence[float]) -> None:  # noqa: N802
        """Set real values."""
        wanted: dict[int, list[float]] = {}
        for reference, value in zip(references, values, strict=True):
            array, size, index = self._arrays.get(reference, (reference, 1, 0))
            if array not in wanted:
                wanted[array] = list(self.getFloat64([array], size)) if size > 1 else [value]
            wanted[array][index] = value
        self.setFloat64(list(wanted), [value for one in wanted.values() for value in one])

    def _elements(self, get: Callable[..., Any], references: Sequence[int]) -> list[Any]:
        wanted = {array: size for array, size, _ in (self._arrays.get(one, (one, 1, 0)) for one in references)}
        found = iter(get(list(wanted), sum(wanted.values())))
        arrays = {array: list(islice(found, size)) for array, size in wanted.items()}
        return [arrays[array][index] for array, _, index in (self._arrays.get(one, (one, 1, 0)) for one in references)]

    def setupExperiment(self, startTime: float, stopTime: float | None = None) -> None:  # noqa: N802
        """Remember the times, which FMI 3.0 has in the call that begins initialization."""
        self._window = (startTime, stopTime)

    def enterInitializationMode(self) -> None:  # noqa: N802
        """Begin initialization with the times remembered."""
        start, stop = self._window
        super().enterInitializationMode(startTime=start, stopTime=stop)


class Pair3(Pair):
    """An FMI 3.0 instance beside the model. Start and stop time are told with the call that begins initialization."""

    def _instantiate(self) -> None:
        self.window: tuple[float, float | None] = (0.0, None)
        groups = [one for one in groups_of(self.oracle.interface) if one.is_array]
        elements = {
            one.place + k * one.stride: (one.place, len(one.elements), k) for one in groups for k in range(len(one.elements))
        }
        self.instance = Slave(
            elements,
            guid=self.description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="pair",
        )
        self.instance.instantiate(loggingOn=True, logMessage=self._log3)

    def _log3(self, _environment: Any, status: int, _category: bytes, message: bytes) -> None:
        self.messages.append(f"{status} {message.decode()}")

    def setup_experiment(self, start: float, stop: float | None) -> None:
        self.window = (start, stop)
        self.instance.setupExperiment(start, stop)

    def enter_initialization(self) -> None:
        start, stop = self.window

        def expected() -> None:
            self.oracle.require(0)
            self.oracle.instance.setup_experiment(start, stop)
            self.oracle.phase = 1

        self.both(self.instance.enterInitializationMode, expected)

    def get_all(self) -> None:
        super().get_all()
        assert self.instance.getFloat64([len(self.references)], 1) == [self.oracle.instance.time]
