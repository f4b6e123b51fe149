"""Error reporting of a slave: one sentence and the status "fatal", without ending the host process.

pythonfmu has two ways to report an error. A step that returns False becomes fmi2Discard, which asks
importers to try again: fmpy then repeats or skips the step without a message. An exception
becomes fmi2Fatal, with the exception's `repr` in the importer's log; fmpy and libcosim stop there,
and it is the only way for calls other than steps. Hence every error is raised. (fmi2Error would be
correct, but pythonfmu's binary cannot return it.)
"""

import sys
import traceback
from pathlib import Path

from ..errors import CompropeError


class SlaveError(Exception):
    """An error for the importer, which logs its `repr`."""

    def __repr__(self) -> str:
        return str(self)


def sentence(error: BaseException) -> str:
    """The error in one line: the text of a `CompropeError`; type and location of any other."""
    if isinstance(error, CompropeError):
        return "; ".join(str(error).splitlines())
    frames = traceback.extract_tb(error.__traceback__)
    place = f" in {frames[-1].name}, {Path(frames[-1].filename).name}:{frames[-1].lineno}" if frames else ""
    detail = " ".join(str(error).split())
    return f"internal error: {type(error).__name__}{place}" + (f": {detail}" if detail else "")


def report(text: str) -> None:
    """Write the sentence to standard error, since with logging off pythonfmu passes nothing to the importer."""
    try:
        sys.stderr.write(text + "\n")
        sys.stderr.flush()
    except (OSError, ValueError, AttributeError):
        return  # without an open standard error the host has only its log
