"""Simulated time and communication step of a trip."""

from dataclasses import dataclass
from math import ceil, inf

from comprope.errors import InputError

from ..cosim.master import Coupling


@dataclass(frozen=True)
class Timing:
    """Simulated time and communication step [s], the coupling of drive and rope, first time and a run-up before it [s]."""

    duration: float
    step: float = 0.01
    coupling: Coupling = "two-way"
    begin: float = 0.0
    run_up: float = 0.0

    @property
    def steps_before(self) -> int:
        """Communication steps of the run-up, which are not recorded."""
        return ceil(self.run_up / self.step * (1.0 - 1e-9))

    def __post_init__(self) -> None:
        """Raises `InputError` for impossible times."""
        if not 0.0 < self.duration < inf:
            raise InputError(f"duration = {self.duration:g} s: a number above 0 is accepted")
        if not 0.0 < self.step <= self.duration:
            raise InputError(f"communication step = {self.step:g} s: above 0 to the duration, {self.duration:g} s, is accepted")
