"""What all tests have in common."""

import os

import pytest

# As the command does it: threads of the linear algebra would wait for one another on a busy machine.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


# The files that take longest. They come first, so that no worker is left with one of them when the others are done.
LONG = (
    "test_residual_force", "test_raw_logs", "test_own_effect", "test_identify_instruments", "test_identify_nuisances",
    "test_identify_far", "test_fmi_importers", "test_native", "test_plant", "test_rope_kernels", "test_public_interface",
    "test_identify_story", "test_identify_coarse", "test_packaging", "test_fmi_package", "test_fmi_tools", "test_tune",
    "test_design", "test_app_browser", "test_command_running",
)  # fmt: skip


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the tests of the files in LONG first."""
    order = {name: place for place, name in enumerate(LONG)}
    items.sort(key=lambda item: order.get(item.path.stem, len(LONG)))


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
