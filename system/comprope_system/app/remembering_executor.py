"""An executor that keeps what its tasks returned, so that a computation that was interrupted goes on where it was."""

import hashlib
import pickle
import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

from ..parallel.sweep import hash_of_files, source_files

T = TypeVar("T")


class RememberingExecutor(Executor):
    """Submits to another executor what is not yet in `folder`, which must be private: what is read there is unpickled.

    A task is known by its function, its arguments and the source of this program. `counted(done, submitted)` is called when a
    task has been submitted or is done; remembered ones count.
    """

    def __init__(self, inner: Executor, folder: Path, counted: Callable[[int, int], None]) -> None:
        self.inner, self.folder, self.counted = inner, folder, counted
        self.done = self.submitted = 0
        self.lock = threading.Lock()
        self.version = hash_of_files(source_files())
        folder.mkdir(parents=True, exist_ok=True)

    def submit(self, fn: Callable[..., T], /, *args: Any, **kwargs: Any) -> Future[T]:
        """The future of a task, done at once if it is remembered."""
        task = pickle.dumps((self.version, fn.__module__, fn.__qualname__, args, kwargs))
        path = self.folder / hashlib.sha256(task).hexdigest()
        self._count(submitted=1)
        with suppress(OSError, EOFError, pickle.UnpicklingError):
            found: Future[T] = Future()
            found.set_result(pickle.loads(path.read_bytes()))
            self._count(done=1)
            return found
        found = self.inner.submit(fn, *args, **kwargs)
        found.add_done_callback(lambda one: self._finished(one, path))
        return found

    def _finished(self, one: Future[Any], path: Path) -> None:
        self._count(done=1)
        if not one.cancelled() and one.exception() is None:
            temporary = path.with_suffix(".part")
            with suppress(OSError):  # a full disk: the task will be done again
                temporary.write_bytes(pickle.dumps(one.result()))
                temporary.replace(path)

    def _count(self, submitted: int = 0, done: int = 0) -> None:
        with self.lock:
            self.submitted += submitted
            self.done += done
            self.counted(self.done, self.submitted)
