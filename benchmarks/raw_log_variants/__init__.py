"""Variants of one run as other loggers would have written it, generated from its plain CSV file."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pandas as pd

from .automation import automation, campbell, databases
from .benches import benches
from .binaries import binaries
from .dialects import columns, encodings, labview, lines_around, separators
from .further_binaries import further_binaries
from .further_texts import number_notations, shapes
from .further_times import other_clocks, written_clocks
from .further_values import blind_and_broken, stated_wrongly
from .instruments import grouped_digits, programs_of_instruments, recorders, scopes, unusual_headers, unusual_rows
from .loggers import controllers, data_loggers, oscilloscopes, programs
from .named_columns import decorated_names, workbooks, written_times
from .times import numeric_times, time_faults, time_stamps
from .unusual_trips import unusual_trips
from .values import faults, missing, units
from .variant import Variant

Group = Callable[[pd.DataFrame], Iterator[Variant]]
READING: tuple[Group, ...] = (
    separators, lines_around, columns, labview, encodings, numeric_times, time_stamps, time_faults, units, missing, binaries,
)  # fmt: skip
FURTHER: tuple[Group, ...] = (number_notations, shapes, written_clocks, other_clocks, further_binaries)
LOGGERS: tuple[Group, ...] = (
    data_loggers, oscilloscopes, controllers, programs, decorated_names, written_times, workbooks, automation, campbell,
    databases, scopes, recorders, programs_of_instruments, unusual_rows, unusual_headers, grouped_digits, benches,
)  # fmt: skip
__all__ = ["FURTHER", "LOGGERS", "READING", "Variant", "blind_and_broken", "stated_wrongly", "unusual_trips", "variants"]


def variants(plain: Path) -> Iterator[Variant]:
    """All variants of a plain.csv."""
    table = pd.read_csv(plain)
    for group in (*READING, *FURTHER, faults, stated_wrongly, blind_and_broken, *LOGGERS, unusual_trips):
        yield from group(table)
