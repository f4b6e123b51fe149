"""Co-simulation of drive and rope, as FMUs or in the same process, in the same order."""

from .master import Connection, Participant, Sample, co_simulate

__all__ = ["Connection", "Participant", "Sample", "co_simulate"]
