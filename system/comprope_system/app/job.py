"""A long computation in a process of its own: what it is at, how far it is, cancelled at any time, over when the server is."""

import multiprocessing
import shutil
import signal
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path
from types import FrameType
from typing import Any

from comprope.errors import CompropeError

from ..parallel.executors import end_with_parent, workers
from .computations import COMPUTATIONS
from .remembering_executor import RememberingExecutor

RUNNING, DONE, FAILED, CANCELLED = "running", "done", "failed", "cancelled"
GRACE = 10.0  # s that a process is given to end its workers
# Replays that a computation usually takes, for each fit run: from campaigns of docs/app.md. For the estimate of the time left.
USUAL_TASKS = {"diagnose": 75, "add": 60, "improve": 150}


class Job:
    """One computation of `COMPUTATIONS` with its arguments; `changed()` is called from a thread whenever there is news."""

    def __init__(
        self, name: str, arguments: Mapping[str, Any], campaign: Path, results: Path, fit_runs: int, changed: Callable[[], None]
    ) -> None:
        self.name, self.arguments, self.changed = name, dict(arguments), changed
        self.state, self.message, self.stages = RUNNING, "", list[str]()
        self.counted, self.usual = (0, 0), USUAL_TASKS[name] * max(fit_runs, 1)
        self.started, self.ended = time.time(), 0.0
        spawn = multiprocessing.get_context("spawn")
        self._news, sender = spawn.Pipe(duplex=False)
        alive, self._alive = spawn.Pipe(duplex=False)
        given = (sender, alive, name, campaign, results, results.parent / f"{results.name}-replays", self.arguments)
        self._process = spawn.Process(target=run_job, args=given)
        self._process.start()
        sender.close()
        alive.close()
        threading.Thread(target=self._listen, daemon=True).start()

    def cancel(self) -> None:
        """End the computation and all its processes; what was replayed is remembered."""
        self._finish(CANCELLED, "what has been computed is kept for the next time")
        self.stop()

    def stop(self) -> None:
        """End the process and those that it started."""
        self._process.terminate()
        self._process.join(timeout=GRACE)
        if self._process.is_alive():
            self._process.kill()
            self._process.join()
        self._alive.close()

    def status(self) -> dict[str, Any]:
        """What the page shows."""
        done, submitted = self.counted
        seconds = (self.ended or time.time()) - self.started
        total = max(submitted, self.usual)
        left = seconds * (total - done) / done if done >= 5 and self.state == RUNNING else None
        return {
            "name": self.name, "arguments": self.arguments, "state": self.state, "message": self.message,
            "stage": self.stages[-1] if self.stages else "starting", "stages": self.stages,
            "done": done, "total": total, "seconds": seconds, "seconds_left": left,
        }  # fmt: skip

    def _listen(self) -> None:
        """Take news from the process until it ends."""
        with suppress(EOFError, OSError):
            while True:
                kind, *news = self._news.recv()
                if kind == "stage":
                    self.stages.append(news[0])
                elif kind == "count":
                    self.counted = (news[0], news[1])
                else:
                    self._finish(kind, news[0])
                self.changed()
        self._process.join()
        if self.state == RUNNING:
            code = self._process.exitcode
            self._finish(FAILED, f"the computation ended unexpectedly (exit status {code}); nothing of it was written")
            self.changed()

    def _finish(self, state: str, message: str) -> None:
        self.state, self.message, self.ended = state, message, time.time()


def run_job(
    sender: Connection, alive: Connection, name: str, campaign: Path, results: Path, remembered: Path, arguments: dict[str, Any]
) -> None:
    """Compute in this process and its own workers, and send what happens; the last message is that of the end."""
    end_with_parent(alive)
    signal.signal(signal.SIGTERM, _leave)
    lock = threading.Lock()

    def send(*news: Any) -> None:
        with lock, suppress(OSError):
            sender.send(news)

    try:
        with workers(None, fresh=True) as pool:
            assert pool is not None
            executor = RememberingExecutor(pool, remembered, lambda done, submitted: send("count", done, submitted))
            found = COMPUTATIONS[name](campaign, results, executor, lambda stage, done, total: send("stage", stage), **arguments)
        shutil.rmtree(remembered, ignore_errors=True)
        send(DONE, found["headline"])
    except CompropeError as error:
        send(FAILED, str(error))
    except Exception as error:  # whatever it is, the page shows a sentence
        send(FAILED, f"internal error: {type(error).__name__}: {' '.join(str(error).split())}")


def _leave(_number: int, _frame: FrameType | None) -> None:
    """End in an orderly way, so that the processes of the pool end first."""
    raise SystemExit(1)
