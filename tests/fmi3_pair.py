"""A `Pair` whose FMU speaks FMI 3.0: its calls under the names they have in FMI 2.0, and what is done otherwise."""

from typing import Any

from fmpy.fmi3 import FMU3Slave

from .fmi_pair import Pair


class Slave(FMU3Slave):  # type: ignore[misc]
    """An FMI 3.0 instance that can be called like one of FMI 2.0."""

    getReal, setReal = FMU3Slave.getFloat64, FMU3Slave.setFloat64  # noqa: N815
    getInteger = FMU3Slave.getInt32  # noqa: N815
    _window: tuple[float, float | None] = (0.0, None)

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
        self.instance = Slave(
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
        assert self.instance.getFloat64([len(self.references)]) == [self.oracle.instance.time]
