"""A diagnosis on a Dask cluster gives the numbers of one in this process, also when a worker dies on the way."""

import os
import signal
from pathlib import Path

import pytest

import comprope_system

from . import virtual_elevator

HIDDEN = {"effects.sheave_eccentricity.eccentricity": 2e-3, "effects.sheave_eccentricity.phase": 0.7}


@pytest.mark.slow
def test_a_worker_that_is_killed_changes_nothing(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    campaign = virtual_elevator.campaign(tmp_path / "campaign", HIDDEN)
    stages: list[str] = []
    killed: list[int] = []
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, protocol="tcp", dashboard_address=None
    ) as cluster:

        def progress(text: str, done: int = 0, total: int = 0) -> None:
            stages.append(text)
            if text == "linear screening of all effects":
                killed.append(next(iter(cluster.workers.values())).pid)
                os.kill(killed[0], signal.SIGKILL)

        address = cluster.scheduler_address.replace("tcp://", "dask://")
        found = comprope_system.diagnose(campaign, executor=address, progress=progress)
    assert killed
    assert stages.index("linear screening of all effects") < len(stages) - 1
    alone = comprope_system.diagnose(campaign)
    assert found.verdict == alone.verdict == "sheave_eccentricity"
    assert found.to_json()["probabilities"] == alone.to_json()["probabilities"]
