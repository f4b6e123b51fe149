"""Status of a kernel that refuses or gives up: its kind, the message to it, and the values that the message takes.

The texts have C's and Python's common form of `%`, so that a program without Python fills in the same.
"""

from collections.abc import Iterable, Mapping

from ..errors import CompropeError

SUCCESS = 0
MESSAGE_VALUES = 8  # at most
# For each status: the error (the user's values, or the computation), the text, how many values it takes.
Messages = Mapping[int, tuple[type[CompropeError], str, int]]


def sentence(messages: Messages, status: float, values: Iterable[float]) -> str:
    """The message to a status other than SUCCESS, with these values."""
    _, text, count = messages[int(status)]
    return text % tuple(list(values)[:count])


def require_success(messages: Messages, status: float, values: Iterable[float]) -> None:
    """Raise the error that a kernel's status other than SUCCESS stands for, its message with these values."""
    if status != SUCCESS:
        raise messages[int(status)][0](sentence(messages, status, values))
