"""Short computations in one worker process that stays warm; if one brings it down, the next has a new one."""

import asyncio
from collections.abc import Callable
from concurrent.futures import Executor
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack
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
        if self._pool is None:
            self._pool = self._stack.enter_context(workers(1, fresh=True))
        assert self._pool is not None
        try:
            return await asyncio.wrap_future(self._pool.submit(function, *arguments))
        except BrokenProcessPool:
            self.close()
            raise SimulationError("the computation ended unexpectedly; nothing of it was written") from None

    def close(self) -> None:
        """End the worker process."""
        self._pool = None
        self._stack.close()
