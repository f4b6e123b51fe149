"""Workarounds for faults of pythonfmu's binary that would crash the host process. Seen in version 0.7.0.

References: when a method raises, the binary releases its references to the slave, its class and its
log queue, but continues to use them and releases them again when the instance is freed. When it creates an
instance, it releases a reference to the namespace of the slave's module that it does not own.

Exit: a process that ends with the binary still loaded destroys the binary's interpreter guard twice,
the second time in freed memory.
"""

import atexit
import ctypes
import os
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from pythonfmu.osutil import get_lib_extension, get_platform


def keep_alive(*owned: Any) -> None:
    """Add one reference to each object, to replace the one that the binary releases."""
    for item in owned:
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(item))


@cache
def leave_cleanly(resources: str, identifier: str) -> None:
    """Make the binary of the FMU with this `resources` folder release its interpreter guard when Python ends.

    Only where Python is the host: elsewhere the guard ends Python itself. Windows does not need it.
    """
    if sys.orig_argv and sys.platform == "linux":
        library = Path(resources).parent / "binaries" / get_platform() / f"{identifier}.{get_lib_extension()}"
        atexit.register(_release_guard, str(library))


def _release_guard(library: str) -> None:
    with suppress(OSError, AttributeError):  # unloaded by now, or a later version without the function
        ctypes.CDLL(library, mode=os.RTLD_NOLOAD).finalizePythonInterpreter()
