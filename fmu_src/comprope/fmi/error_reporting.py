"""How an error leaves a slave: one sentence, the status "fatal", and a host that lives on.

pythonfmu knows two ways to report an error. A step that returns False becomes fmi2Discard, which
tells importers to try again: fmpy then repeats or leaves out the step without a word. An exception
becomes fmi2Fatal, with the exception's `repr` in the importer's log; fmpy and libcosim stop there,
and it is the only way for calls other than steps. So every error is raised. (fmi2Error would be
right, but pythonfmu's binary offers no way to return it.)
"""

import sys
import traceback
from pathlib import Path

from ..errors import CompropeError


class SlaveError(Exception):
    """An error on its way to the importer, which logs its `repr`."""

    def __repr__(self) -> str:
        return str(self)


def sentence(error: BaseException) -> str:
    """The error in one line: the text of our own errors; kind and place of any other."""
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
        return  # a host without a standard error, or with a closed one, has only its log
