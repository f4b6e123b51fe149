"""Error reporting: every error becomes one sentence, for the importer's log or, where there is none, for standard error."""

import sys
import traceback
from pathlib import Path

from ..errors import CompropeError


def sentence(error: BaseException) -> str:
    """The error in one line: the text of a `CompropeError`; type and location of any other."""
    if isinstance(error, CompropeError):
        return "; ".join(str(error).splitlines())
    if isinstance(error, KeyboardInterrupt):
        return "interrupted"
    frames = traceback.extract_tb(error.__traceback__)
    place = f" in {frames[-1].name}, {Path(frames[-1].filename).name}:{frames[-1].lineno}" if frames else ""
    detail = " ".join(str(error).split())
    return f"internal error: {type(error).__name__}{place}" + (f": {detail}" if detail else "")


def report(text: str) -> None:
    """Write the sentence to standard error."""
    try:
        sys.stderr.write(text + "\n")
        sys.stderr.flush()
    except (OSError, ValueError, AttributeError):
        return  # without an open standard error the host has only its log
