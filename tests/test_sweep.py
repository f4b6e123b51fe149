"""Sweeps: order, interruption and going on, failures, executors."""

import importlib
import importlib.util
import json
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from comprope.errors import InputError, SimulationError
from comprope_system.parallel import sweep as sweep_module
from comprope_system.parallel.executors import workers
from comprope_system.parallel.sweep import key_of, sweep, values
from comprope_system.presets import model_path

calls: list[int] = []


def square(case: Any) -> int:
    calls.append(case["x"])
    if case["x"] == 13:
        raise SimulationError("unlucky")
    return int(case["x"] ** 2)


def interrupted(case: Any) -> int:
    if case["x"] == 3:
        raise KeyboardInterrupt
    return int(case["x"] ** 2)


@pytest.fixture(autouse=True)
def _no_calls() -> Iterator[None]:
    calls.clear()
    yield


def numbers(*xs: int) -> list[dict[str, int]]:
    return [{"x": x} for x in xs]


def test_values_come_in_the_order_of_the_cases() -> None:
    with ThreadPoolExecutor(3) as executor:
        assert values(sweep(square, numbers(5, 1, 4, 1), executor)) == [25, 1, 16, 1]
    assert sorted(calls) == [1, 4, 5]  # equal cases run once


def test_an_interrupted_sweep_goes_on_where_it_stopped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = tmp_path / "results.jsonl"
    monkeypatch.setattr(interrupted, "__qualname__", "square")  # the same function, once it is not interrupted
    with pytest.raises(KeyboardInterrupt):
        sweep(interrupted, numbers(1, 2, 3, 4), store=store)
    assert len(store.read_text().splitlines()) == 2
    assert values(sweep(square, numbers(1, 2, 3, 4), store=store)) == [1, 4, 9, 16]
    assert calls == [3, 4]
    assert values(sweep(square, numbers(4, 3, 2, 1), store=store)) == [16, 9, 4, 1]
    assert calls == [3, 4]


def test_a_killed_sweep_goes_on(tmp_path: Path) -> None:
    store = tmp_path / "results.jsonl"
    program = tmp_path / "killed.py"
    program.write_text(
        "import os, sys\nfrom pathlib import Path\nfrom comprope_system.parallel.sweep import sweep\n"
        "def task(case):\n    if case['x'] == 2 and sys.argv[1] == 'die':\n        os._exit(9)\n    return case['x'] + 100\n"
        f"print([one.value for one in sweep(task, [{{'x': x}} for x in range(4)], store=Path({str(store)!r}))])\n"
    )
    assert subprocess.run([sys.executable, program, "die"], check=False).returncode == 9
    before = store.read_text()
    assert len(before.splitlines()) == 2
    end = subprocess.run([sys.executable, program, "live"], check=True, capture_output=True, text=True)
    assert end.stdout.strip() == "[100, 101, 102, 103]"
    assert store.read_text().startswith(before)
    assert len(store.read_text().splitlines()) == 4


def test_a_line_cut_short_is_run_again(tmp_path: Path) -> None:
    store = tmp_path / "results.jsonl"
    sweep(square, numbers(1, 2), store=store)
    store.write_text(store.read_text()[:-15])
    calls.clear()
    assert values(sweep(square, numbers(1, 2, 3), store=store)) == [1, 4, 9]
    assert calls == [2, 3]
    calls.clear()
    assert values(sweep(square, numbers(1, 2, 3), store=store)) == [1, 4, 9]
    assert calls == []


def test_a_failed_case_is_told_and_tried_again(tmp_path: Path) -> None:
    store = tmp_path / "results.jsonl"
    outcomes = sweep(square, numbers(12, 13), store=store)
    assert [one.failed for one in outcomes] == ["", "unlucky"]
    with pytest.raises(SimulationError, match="'x': 13}: unlucky"):
        values(outcomes)
    sweep(square, numbers(12, 13), store=store)
    assert calls == [12, 13, 13]


def test_the_key_is_that_of_the_content() -> None:
    assert key_of(square, {"x": 1, "y": 2.0}) == key_of(square, {"y": 2.0, "x": 1})
    assert key_of(square, {"x": 1}) != key_of(square, {"x": 2})
    assert key_of(square, {"x": 1}) != key_of(interrupted, {"x": 1})


def test_results_of_another_version_of_the_program_are_not_taken_over(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = tmp_path / "results.jsonl"
    sweep(square, numbers(2), store=store)
    other = tmp_path / "changed.py"
    other.write_text("x = 1")
    monkeypatch.setattr(sweep_module, "source_files", lambda: [other])
    sweep_module._source.cache_clear()
    try:
        sweep(square, numbers(2), store=store)
        assert calls == [2, 2]
        other.write_text("x = 2")
        sweep_module._source.cache_clear()
        sweep(square, numbers(2), store=store)
        assert calls == [2, 2, 2]
        sweep(square, numbers(2), store=store)
        assert calls == [2, 2, 2]
    finally:
        sweep_module._source.cache_clear()


def test_the_key_covers_every_module_that_a_task_runs() -> None:
    """Also those that only the tasks of one command import, and the presets."""
    covered = set(sweep_module.source_files())
    modules = (
        "vibration.prescribed_trip",
        "vibration.reduced_model.swing",
        "tuning.task",
        "vibration.modal.modes",
        "presets.paper_installations",
    )
    kernels = ("comprope.rope.integration.newmark", "comprope.drive.trajectory.s_curve")
    for name in (*(f"comprope_system.{name}" for name in modules), *kernels):
        assert Path(str(importlib.import_module(name).__file__)) in covered, name
    assert model_path("tower50") in covered


def test_the_key_covers_the_file_of_the_task_itself(tmp_path: Path) -> None:
    keys = []
    for text in ("def task(case): return 1", "def task(case): return 2"):
        (tmp_path / "own_task.py").write_text(text)
        specification = importlib.util.spec_from_file_location("own_task", tmp_path / "own_task.py")
        assert specification and specification.loader
        module = importlib.util.module_from_spec(specification)
        with pytest.MonkeyPatch.context() as patch:
            patch.setitem(sys.modules, "own_task", module)
            specification.loader.exec_module(module)
            sweep_module._source.cache_clear()
            keys.append(key_of(module.task, {"x": 1}))
    sweep_module._source.cache_clear()
    assert keys[0] != keys[1]


def test_the_key_covers_the_files_of_effects_that_the_model_names(tmp_path: Path) -> None:
    file = tmp_path / "effect.py"
    case, keys = {"model": {"own_effects": [str(file)]}}, []
    for text in ("stiffness = 1.0", "stiffness = 2.0"):
        file.write_text(text)
        keys.append(key_of(square, case))
    assert keys[0] != keys[1]


def test_an_unreadable_file_of_results_is_named(tmp_path: Path) -> None:
    (tmp_path / "results.jsonl").write_bytes(b"\xff\xfe")
    with pytest.raises(InputError, match=r"results\.jsonl: cannot be read"):
        sweep(square, numbers(1), store=tmp_path / "results.jsonl")


def test_results_are_lines_of_json_as_they_come(tmp_path: Path) -> None:
    sweep(square, numbers(3), store=tmp_path / "new" / "results.jsonl")
    (row,) = map(json.loads, (tmp_path / "new" / "results.jsonl").read_text().splitlines())
    assert row == {"key": key_of(square, {"x": 3}), "case": {"x": 3}, "value": 9}


def test_processes() -> None:
    from comprope_system.studies.paper.fig7 import profile

    trips = [{"trip": {"distance": d, "speed": 9.0, "acceleration": 1.1, "jerk": 0.93}} for d in (10.0, 22.0)]
    with workers(2) as executor:
        assert executor is not None
        found = values(sweep(profile, trips, executor))
    assert found == [profile(trip) for trip in trips]


def test_one_job_needs_no_executor() -> None:
    with workers(1) as executor:
        assert executor is None


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "localhost:8786"])
def test_other_addresses_are_refused(address: str) -> None:
    with pytest.raises(InputError, match="dask://HOST:PORT is accepted"), workers(executor=address):
        pass


def test_dask_by_address(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    from comprope_system.studies.paper.fig7 import profile

    trips = [{"trip": {"distance": d, "speed": 9.0, "acceleration": 1.1, "jerk": 0.93}} for d in (10.0, 22.0, 40.0)]
    local = {"n_workers": 1, "threads_per_worker": 1, "processes": False, "dashboard_address": None}
    with distributed.LocalCluster(protocol="tcp", **local) as cluster:
        address = cluster.scheduler_address.replace("tcp://", "dask://")
        with workers(executor=address) as executor:
            found = values(sweep(profile, trips, executor, tmp_path / "results.jsonl"))
    assert found == [profile(trip) for trip in trips]
    assert len((tmp_path / "results.jsonl").read_text().splitlines()) == 3


def test_a_cluster_that_does_not_answer_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("comprope_system.parallel.executors.WAIT", 1)
    with pytest.raises(SimulationError, match="no Dask scheduler answers"), workers(executor="dask://127.0.0.1:9"):
        pass
