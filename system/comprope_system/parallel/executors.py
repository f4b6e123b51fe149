"""Executors for sweeps: this process, processes of this machine, or a Dask cluster."""

import importlib
import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection

from comprope.errors import InputError, SimulationError

DASK = "dask://"
WAIT = 10  # s to wait for a cluster


@contextmanager
def workers(jobs: int | None = None, executor: Executor | str | None = None, *, fresh: bool = False) -> Iterator[Executor | None]:
    """An executor of concurrent.futures: the one given, a Dask cluster's by its address dask://HOST:PORT, or `jobs` processes.

    By default there is one process per core; with `jobs` 1 there is no executor, and a sweep runs in this
    process, unless a `fresh` one is requested. Raises `InputError` for an invalid address or if Dask is not installed,
    `SimulationError` if the scheduler does not answer.
    """
    if isinstance(executor, str):
        with _dask(executor) as cluster:
            yield cluster
    elif executor is not None:
        yield executor
    elif (count := jobs or os.cpu_count() or 1) == 1 and not fresh:
        yield None
    else:
        # Each worker has a core to itself: threads of its linear algebra would only wait for one another.
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        # A fresh interpreter for each worker: forking one that has threads (a progress bar's) is not safe.
        spawn = multiprocessing.get_context("spawn")
        reader, writer = spawn.Pipe(duplex=False)
        pool = ProcessPoolExecutor(count, mp_context=spawn, initializer=end_with_parent, initargs=(reader,))
        try:
            yield pool
        except BaseException:  # such as Ctrl-C: nobody waits for what is still being computed
            writer.close()
            raise
        finally:
            pool.shutdown(wait=True, cancel_futures=True)
            writer.close()
            reader.close()


def end_with_parent(reader: Connection) -> None:
    """End this process as soon as the other end of the pipe is closed, which also happens when its owner is killed.

    Ctrl-C, which a terminal sends to all processes, is left to that owner.
    """

    def wait() -> None:
        with suppress(EOFError, OSError):
            reader.recv_bytes()
        os._exit(1)

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=wait, daemon=True).start()


@contextmanager
def _dask(address: str) -> Iterator[Executor]:
    if not address.startswith(DASK):
        raise InputError(f"--executor {address}: {DASK}HOST:PORT is accepted, the address of a Dask scheduler")
    try:
        distributed = importlib.import_module("distributed")
    except ImportError:
        raise InputError(f"--executor {address}: Dask is not installed; pip install 'comprope[dask]'") from None
    try:
        client = distributed.Client(f"tcp://{address.removeprefix(DASK)}", timeout=WAIT)
    except (OSError, ValueError) as error:
        raise SimulationError(f"--executor {address}: no Dask scheduler answers there: {error}") from None
    with client:
        executor: Executor = client.get_executor()
        try:
            yield executor
        finally:
            executor.shutdown(wait=False)


@contextmanager
def threads(executor: Executor | str | None = None) -> Iterator[Executor]:
    """The executor given, else threads of this process, for a few replays: their kernels run side by side."""
    from comprope.rope.compiler.entry_points import compiled

    if executor is not None:
        with processes(None, executor) as given:
            yield given
        return
    compiled()  # once, before the threads ask for it
    with ThreadPoolExecutor(os.cpu_count() or 1) as own:
        yield own


@contextmanager
def processes(jobs: int | None, executor: Executor | str | None = None) -> Iterator[Executor]:
    """The executor given, else processes, for hundreds of replays; with one job, this process."""
    with workers(jobs, executor) as chosen:
        if chosen is not None:
            yield chosen
        else:
            with ThreadPoolExecutor(1) as own:
                yield own
