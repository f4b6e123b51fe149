"""Short computations in one worker process that stays warm; if one brings it down, the next has a new one."""

import asyncio
from collections.abc import Callable
from concurrent.futures import Executor
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack
from importlib import import_module
from typing import Any

from comprope.errors import SimulationError

from ..parallel.executors import workers


class Desk:
    """Runs functions that this process could not survive or would be slowed by, one after the other."""

    def __init__(self) -> None:
        self._stack = ExitStack()
        self._pool: Executor | None = None

    async def run(self, function: Callable[..., dict[str, Any]], *arguments: Any) -> dict[str, Any]:
        """What the function returns; its errors, and `SimulationError` if its process ended."""
        try:
            return await asyncio.wrap_future(self._worker().submit(function, *arguments))
        except BrokenProcessPool:
            self.close()
            raise SimulationError("the computation ended unexpectedly; nothing of it was written") from None

    def warm(self) -> None:
        """Begin to load what computations need, so that the first one does not wait for it."""
        self._worker().submit(load)

    def _worker(self) -> Executor:
        """The worker process, started if there is none."""
        if self._pool is None:
            self._pool = self._stack.enter_context(workers(1, fresh=True))
        assert self._pool is not None
        return self._pool

    def close(self) -> None:
        """End the worker process."""
        self._pool = None
        self._stack.close()


def load() -> None:
    """Import what computations need."""
    for name in ("computations", "descriptions"):
        import_module(f"{__package__}.{name}")
