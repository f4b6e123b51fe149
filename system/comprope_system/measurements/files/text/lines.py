"""Lines and cells of a text, split when they are looked at: a long record has millions of them."""

from collections.abc import Callable, Sequence
from typing import overload

import numpy as np
from numpy.typing import NDArray

NEWLINE = ord("\n")


class TextLines(Sequence[str]):
    """The lines of a text, whatever ends them, without empty ones at its end."""

    def __init__(self, text: str) -> None:
        plain = text.replace("\r\n", "\n").replace("\r", "\n").rstrip("\n")
        self.data = np.frombuffer(plain.encode("utf-8", "surrogatepass"), np.uint8)
        ends = np.flatnonzero(self.data == NEWLINE)
        self.starts = np.concatenate(([0], ends + 1))
        self.ends = np.append(ends, len(self.data))
        while len(self.starts) and not self[-1].strip():
            self.starts, self.ends = self.starts[:-1], self.ends[:-1]

    def __len__(self) -> int:
        return len(self.starts)

    @overload
    def __getitem__(self, at: int) -> str: ...
    @overload
    def __getitem__(self, at: slice) -> list[str]: ...
    def __getitem__(self, at: int | slice) -> str | list[str]:
        if isinstance(at, slice):
            return [self[k] for k in range(*at.indices(len(self)))]
        if not -len(self) <= at < len(self):
            raise IndexError(at)
        return self.data[self.starts[at] : self.ends[at]].tobytes().decode("utf-8", "surrogatepass")

    def block(self, first: int, last: int) -> bytes:
        """The lines from `first` to `last` as UTF-8."""
        return self.data[self.starts[first] : self.ends[last]].tobytes()

    def counts(self, character: str, first: int, last: int) -> NDArray[np.int64]:
        """How often an ASCII character stands in each of the lines from `first` to `last`."""
        at = np.flatnonzero(self.data == ord(character))
        found: NDArray[np.int64] = np.searchsorted(at, self.ends[first : last + 1]) - np.searchsorted(
            at, self.starts[first : last + 1]
        )
        return found


class Rows(Sequence[list[str]]):
    """The cells of lines; a blank line has none."""

    def __init__(self, lines: Sequence[str], split: Callable[[str], list[str]]) -> None:
        self.lines, self.split = lines, split

    def __len__(self) -> int:
        return len(self.lines)

    @overload
    def __getitem__(self, at: int) -> list[str]: ...
    @overload
    def __getitem__(self, at: slice) -> list[list[str]]: ...
    def __getitem__(self, at: int | slice) -> list[str] | list[list[str]]:
        if isinstance(at, slice):
            return [self[k] for k in range(*at.indices(len(self)))]
        line = self.lines[at]
        return self.split(line) if line.strip() else []
