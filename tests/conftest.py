"""What all tests have in common."""

import os

import pytest

# As the command does it: threads of the linear algebra would wait for one another on a busy machine.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


@pytest.fixture(scope="session", autouse=True)
def compiled_kernels(request: pytest.FixtureRequest) -> None:
    """Where several workers share a run, let them compile the kernels together before the tests, each once.

    Else the first test of each would wait for one worker that compiles. One half begins with the first kernel, the other with the
    last one; where they meet, the rest is in the cache.
    """
    worker = getattr(request.config, "workerinput", None)
    if worker and worker["workercount"] > 1:
        from comprope.rope.compiler.entry_points import compiled

        backwards = int(worker["workerid"].removeprefix("gw")) % 2 == 1
        for entry in list(compiled().values())[:: -1 if backwards else 1]:
            _ = entry.compiled
