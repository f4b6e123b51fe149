"""Make up for what pythonfmu's binary does wrong, so that no host process dies of it. Seen in version 0.7.0.

References: when a method raises, the binary gives up its references to the slave, its class and its
log queue, but goes on using them and gives them up again when the instance is freed. When it makes an
instance, it gives up a reference to the names of the slave's module that it does not own.

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
    """Add one reference to each object, in place of the one the binary gives up."""
    for item in owned:
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(item))


@cache
def leave_cleanly(resources: str, identifier: str) -> None:
    """Let the binary of the FMU with this `resources` folder drop its interpreter guard when Python ends.

    Only where Python is the host: elsewhere the guard ends Python itself. Windows needs no help.
    """
    if sys.orig_argv and sys.platform == "linux":
        library = Path(resources).parent / "binaries" / get_platform() / f"{identifier}.{get_lib_extension()}"
        atexit.register(_drop_guard, str(library))


def _drop_guard(library: str) -> None:
    with suppress(OSError, AttributeError):  # unloaded by now, or a later version without the function
        ctypes.CDLL(library, mode=os.RTLD_NOLOAD).finalizePythonInterpreter()
