"""Entry points for Python and C: the drive's kernels, compiled once for a machine."""

import inspect
import threading
from functools import cache

from ...kernels import jit
from ...kernels import status as kernel_status
from ...kernels.disk_cache import kernel_folder
from ...kernels.entry import Entry
from ...kernels.entry_source import EntrySource
from ...kernels.joined import entries_of, entries_text, joined_module
from ...kernels.kernel_linking import linked, merged
from .. import status
from ..parameters import parameter_checks
from . import (
    arguments,
    checks,
    clock,
    design,
    hoist,
    matrices,
    outputs,
    parameter_vector,
    stepping,
    tripped_hoist,
    velocity_balance,
)
from .reference import free_curve, s_curve, shaped_trip

MODULES = (
    arguments, parameter_checks, s_curve, free_curve, shaped_trip, matrices, hoist, design, checks, clock,
    velocity_balance, tripped_hoist, stepping, outputs,
)  # fmt: skip
_CONSTANTS = (parameter_vector, status, kernel_status, jit)  # what kernels take from them stands in their own modules
ENTRIES = {
    "count_points": design.count_points,
    "design_drive": design.design_drive,
    "check": checks.check,
    "start_at_rest": stepping.start_at_rest,
    "advance_drive": stepping.advance_drive,
    "evaluate_drive": outputs.evaluate_drive,
}
SOURCES = {name: EntrySource(name, kernel, arguments.TABLES) for name, kernel in ENTRIES.items()}
_LOCK = threading.RLock()


def compiled() -> dict[str, Entry]:
    """The entry points (see ENTRIES)."""
    with _LOCK:
        return _joined()


@cache
def _joined() -> dict[str, Entry]:
    sources = [inspect.getsource(one) for one in (*MODULES, *_CONSTANTS)]
    folder = kernel_folder([entries_text(SOURCES), *sources, repr(parameter_vector.NAMES)])
    joined = joined_module(folder)
    joined.__dict__.update(linked(merged(MODULES, {}), joined.__name__))
    return entries_of(joined, folder, SOURCES)
