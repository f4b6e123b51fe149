"""The app without a browser: who may use it, what it takes, and that nothing is written by halves."""

import asyncio
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from starlette.testclient import TestClient
from typer.main import get_command

import comprope_system
from comprope.errors import InputError, SimulationError
from comprope.rope.model_file import dump, load, with_changes
from comprope_system.app import computations, replays, routes
from comprope_system.app.desk import Desk
from comprope_system.app.remembering_executor import RememberingExecutor
from comprope_system.app.server import make_app
from comprope_system.app.state import State
from comprope_system.app.workspace import Workspace, fingerprint, new_result, write_record
from comprope_system.campaign_setup.column_roles import Role
from comprope_system.campaign_setup.corrections import Corrections
from comprope_system.cli import app, main
from comprope_system.identification.comparison.compare import compare
from comprope_system.identification.data.campaign import load_campaign
from comprope_system.measurements.campaign_file import read_campaign_file
from comprope_system.parallel.executors import threads

from . import virtual_elevator

PORT, TOKEN = 8123, "a-token"
OWN = {"host": f"127.0.0.1:{PORT}", "origin": f"http://127.0.0.1:{PORT}"}


@pytest.fixture
def private(tmp_path, monkeypatch):
    """The user's cache in a folder of the test."""
    monkeypatch.setenv("COMPROPE_CACHE", str(tmp_path / "cache"))
    return tmp_path / "work" / "campaign"


@pytest.fixture
def client(private):
    with TestClient(make_app(private, TOKEN, PORT), base_url=f"http://127.0.0.1:{PORT}") as found:
        yield found


# -- who may use it ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("query", "headers", "said"),
    [
        ("", {}, "token"),
        ("?token=wrong", {}, "token"),
        ("?token=", {"cookie": f"comprope-{PORT}=wrong"}, "token"),
        (f"?token={TOKEN}", {"host": "evil.example"}, "Host"),
        (f"?token={TOKEN}", {"host": f"evil.example:{PORT}"}, "Host"),
        (f"?token={TOKEN}", {"origin": "https://evil.example"}, "Origin"),
        (f"?token={TOKEN}", {"origin": "null"}, "Origin"),
    ],
)
@pytest.mark.parametrize("path", ["/", "/state", "/events", "/static/app.js", "/nothing"])
def test_nobody_else_is_answered(client, path, query, headers, said):
    found = client.get(path + query, headers=headers)
    assert found.status_code == 403 and said in found.text
    assert "set-cookie" not in found.headers


def test_only_pages_of_the_app_may_change_anything(client):
    path = f"/files/run.csv?token={TOKEN}"
    assert client.put(path, content=b"x").status_code == 403
    assert client.put(path, content=b"x", headers={"origin": f"http://127.0.0.1:{PORT + 1}"}).status_code == 403
    assert client.get(f"/state?token={TOKEN}").json()["uploads"] == []
    assert client.put(path, content=b"x", headers=OWN).status_code == 200


def test_the_token_of_the_address_is_kept_in_a_cookie(client):
    first = client.get(f"/?token={TOKEN}")
    assert first.status_code == 200 and "SameSite=Strict" in first.headers["set-cookie"]
    assert "HttpOnly" in first.headers["set-cookie"]
    assert client.get("/state").status_code == 200
    assert "frame-ancestors 'self'" in first.headers["content-security-policy"]


# -- what it takes -----------------------------------------------------------------------------------------


def put(client, name, content):
    return client.put(f"/files/{name}?token={TOKEN}", content=content, headers=OWN)


def names(client):
    return [one["name"] for one in client.get(f"/state?token={TOKEN}").json()["uploads"]]


def test_uploads_are_bounded_and_whole(client, monkeypatch):
    monkeypatch.setattr(routes, "MAX_FILE", 2**20)
    assert put(client, "small.csv", b"x" * 2**20).status_code == 200
    refused = put(client, "large.csv", b"x" * (2**20 + 1))
    assert refused.status_code == 422 and "1 MiB" in refused.json()["error"]
    assert names(client) == ["small.csv"]


@pytest.mark.parametrize("name", [".hidden", "..", "a%00b.csv", "campaign.toml", "%2e%2e%2f.bashrc", "a%1b.csv"])
def test_names_that_are_none_are_refused(client, private, name):
    assert put(client, name, b"x").status_code in (404, 405, 422)
    assert names(client) == [] and not private.exists()


def test_a_path_is_no_more_than_its_last_part(private):
    workspace = Workspace(private)
    for name in ("../../run.csv", "C:\\data\\run.csv", "/etc/run.csv"):
        assert workspace.upload_path(name) == workspace.uploads / "run.csv"


@pytest.mark.parametrize("content", [b"[]", b"no json", b"\xff", b"{" * 100])
def test_requests_of_another_form_are_a_sentence(client, content):
    found = client.post(f"/jobs?token={TOKEN}", content=content, headers=OWN)
    assert found.status_code == 422 and found.json()["error"] == "the request is no JSON object"


def test_without_a_campaign_there_is_nothing_to_compute(client):
    for path in ("/run/compare", "/jobs", "/replay", "/campaign", "/overlay"):
        given = {"name": "diagnose", "effect": "a", "values": [1.0], "source": "diagnose", "names": ["add air_drag"]}
        found = client.post(f"{path}?token={TOKEN}", json=given, headers=OWN)
        assert found.status_code == 422 and found.json()["error"]


def test_only_files_of_results_can_be_downloaded(client):
    for path in ("/report/compare", "/download/compare/report.html", "/download/compare/previews.pickle", "/static/app.html"):
        assert client.get(f"{path}?token={TOKEN}").status_code == 404
    for path in ("/report/..%2f..", "/download/..%2f../report.html", "/static/..%2fserver.py"):
        assert client.get(f"{path}?token={TOKEN}").status_code in (403, 404)


def test_the_commands_are_those_that_do_the_same(client, private):
    for name in ("up.csv", "a b.csv", "tower.toml"):
        put(client, name, b"x")
    (command,) = client.get(f"/state?token={TOKEN}").json()["commands"]
    assert command.startswith(f"comprope new {private} 'a b.csv' up.csv --model tower.toml")


def test_the_commands_of_models_name_start_and_overlay(client, private):
    private.mkdir(parents=True)
    (private / "campaign.toml").write_text(virtual_elevator.description())
    results, start = Workspace(private).results(), {"effects.air_drag.drag_coefficient": 0.5}
    made = {
        "add air_drag from drag_coefficient 0.5": {"effect": "air_drag", "start": start},
        "improve": {"effects": ["air_drag"]},
        "overlay": {"models": ["improve", "add air_drag from drag_coefficient 0.5"]},
    }
    for k, (name, facts) in enumerate(made.items()):
        with new_result(results, name) as folder:
            write_record(folder, {"name": name, "headline": "", "finished": k, "facts": facts, "model": name != "overlay"})
    add, improve, overlay = client.get(f"/state?token={TOKEN}").json()["commands"][-3:]
    assert add.startswith(f"comprope add {private} air_drag --start effects.air_drag.drag_coefficient=0.5 --out model1.toml")
    assert improve.startswith(f"comprope improve {private} --out model2.toml")
    assert overlay == f"comprope compare {private} --model model2.toml --model model1.toml --report overlay.html"
    options = {one for command in (add, improve, overlay) for one in command.split() if one.startswith("--")}
    known = {text for one in get_command(app).commands.values() for each in one.params for text in each.opts}
    assert options <= known


def test_a_fit_from_a_setting_that_nobody_previewed_is_refused(client, private):
    private.mkdir(parents=True)
    (private / "campaign.toml").write_text(virtual_elevator.description())
    asked = {"name": "add", "effect": "air_drag", "values": [1.0]}
    found = client.post(f"/jobs?token={TOKEN}", json=asked, headers=OWN)
    assert found.status_code == 422 and found.json()["error"] == "air_drag: there is no preview of it; diagnose first"


def test_effects_of_the_model_are_replayed_where_the_comparison_shows_them(tmp_path):
    folder = virtual_elevator.campaign(tmp_path / "campaign", {"effects.bearing_friction.coulomb_torque": 15.0})
    model, results, key = load(folder / "elevator.toml"), tmp_path / "results", "effects.bearing_friction.coulomb_torque"
    dump(with_changes(model, {key: 10.0}), folder / "elevator.toml")
    computations.compare(folder, results)
    found = replays.replay(results, "compare", "bearing_friction", [14.0])  # N m
    campaign = replace(load_campaign(folder), model=with_changes(model, {key: 14.0}))
    with threads() as workers:
        truth = compare(campaign, workers)
    assert found["errors"] == pytest.approx({"fit": truth.fit_nrmse, "validate": truth.validate_nrmse}, rel=1e-9)
    assert set(found["curves"]) == {run.file for run in campaign.runs}
    with pytest.raises(InputError, match="there is no preview of it; compare first"):
        replays.replay(results, "compare", "air_drag", [1.0])
    with pytest.raises(InputError, match="compare, diagnose are accepted"):
        replays.replay(results, "../../etc", "air_drag", [1.0])


# -- nothing by halves -------------------------------------------------------------------------------------


def test_a_result_is_there_whole_or_not_at_all(tmp_path):
    for k in range(2):
        with new_result(tmp_path, "compare") as folder:
            (folder / "report.html").write_text(f"page {k}")
    with pytest.raises(ZeroDivisionError), new_result(tmp_path, "compare") as folder:
        (folder / "report.html").write_text("half a page")
        _ = 1 / 0
    assert (tmp_path / "compare" / "report.html").read_text() == "page 1"
    assert [one.name for one in tmp_path.iterdir()] == ["compare"]


def test_results_belong_to_the_content_of_the_files(private):
    private.mkdir(parents=True)
    (private / "campaign.toml").write_text(virtual_elevator.description())
    run = private / virtual_elevator.RUNS[0][0]
    run.write_text("time,car_position\n")
    workspace, before = Workspace(private), fingerprint(private)
    with new_result(workspace.results(), "compare") as folder:
        write_record(folder, {"name": "compare", "finished": 1.0})
    assert list(workspace.records()) == ["compare"]
    (private / "report.html").write_text("what a command wrote beside it")
    assert fingerprint(private) == before
    run.write_text("time,car_position\n0,1\n")
    assert workspace.records() == {}


def test_what_was_computed_is_not_computed_again(tmp_path):
    calls, counts = [], []
    path = tmp_path / "remembered"

    with ThreadPoolExecutor(1) as pool:
        for _ in range(2):
            executor = RememberingExecutor(pool, path, lambda *count: counts.append(count))
            results = [executor.submit(np.arange, k).result() for k in (2, 3)]
            failing = executor.submit(int, "no number")
            calls.append([len(one) for one in results])
            assert isinstance(failing.exception(), ValueError)
    assert calls == [[2, 3], [2, 3]] and len(list(path.iterdir())) == 2
    assert counts[-1] == (3, 3)


def test_a_computation_that_brings_its_process_down_is_a_sentence_and_the_next_one_works():
    async def both(desk):
        with pytest.raises(SimulationError, match="ended unexpectedly"):
            await desk.run(os._exit, 3)
        return await desk.run(os.path.basename, "a/b")

    desk = Desk()
    assert asyncio.run(both(desk)) == "b"
    desk.close()


def test_a_job_that_was_running_when_the_server_ended_can_be_resumed(private):
    private.mkdir(parents=True)
    first = State(private)
    (first.workspace.root / "job.json").write_text('{"name": "diagnose", "arguments": {}, "server": 1}')
    later = State(private)
    assert later.shown()["interrupted"]["name"] == "diagnose"
    later.cancel()
    assert State(private).interrupted() is None


# -- corrections -------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def raw(tmp_path_factory):
    return virtual_elevator.campaign(tmp_path_factory.mktemp("raw"), {})


def described(raw, folder, corrections):
    files = [raw / file for file, *_ in virtual_elevator.RUNS]
    return comprope_system.new(folder, files, model=raw / "elevator.toml", corrections=corrections)


def test_corrections_are_what_the_campaign_says(raw, tmp_path):
    stated = Corrections(
        columns={"cw_low": Role("lateral_displacement", "cm", "car_low", -1, reference="absolute"), "car_low": Role(None)},
        roles={"up.csv": "validate", "up_short.csv": "fit"},
        changes={"up.csv": {"sheave.mass": 80.0}},
    )
    result = described(raw, tmp_path / "corrected", stated)
    found = read_campaign_file(result.path)
    one = next(channel for channel in found.channels if channel.column == "cw_low")
    assert (one.unit, one.sensor, one.sign, one.reference) == ("cm", "car_low", -1, "absolute")
    assert {channel.column: channel.reference for channel in found.channels}["axle"] == "rest"
    assert "car_low" not in [channel.column for channel in found.channels]
    assert {run.file: run.role for run in found.runs}["up.csv"] == "validate"
    assert next(run for run in found.runs if run.file == "up.csv").set == {"sheave.mass": 80.0}


@pytest.mark.parametrize(
    ("stated", "said"),
    [
        (Corrections(columns={"cw_low": Role("lateral_displacement", "kg", "cw_low")}), "unit kg"),
        (Corrections(columns={"cw_low": Role("lateral_displacement", "mm", "attic")}), "a sensor of the model is needed"),
        (Corrections(columns={"cw_low": Role("lateral_displacement", "mm", "car_low")}), "is cw_low already|is car_low already"),
        (Corrections(columns={"cw_low": Role("lateral_displacement", "mm", "cw_low", reference="sea")}), "reference sea"),
        (Corrections(columns={"nothing": Role(None)}), "no such column"),
        (Corrections(roles={"up.csv": "spare"}), "fit or validate"),
        (Corrections(changes={"up.csv": {"sheave.mass": -1.0}}), "sheave.mass"),
    ],
)
def test_corrections_that_cannot_be_are_refused_and_nothing_is_written(raw, tmp_path, stated, said):
    with pytest.raises(InputError, match=said):
        described(raw, tmp_path / "refused", stated)
    assert not (tmp_path / "refused" / "campaign.toml").exists()


# -- the command -------------------------------------------------------------------------------------------


def test_a_file_is_no_folder_of_a_campaign(tmp_path, capsys):
    (tmp_path / "campaign.toml").write_text("")
    with pytest.raises(SystemExit) as ended:
        main(["app", str(tmp_path / "campaign.toml"), "--no-browser"])
    assert ended.value.code == 2 and "is a file" in capsys.readouterr().err


def test_a_port_that_is_taken_is_a_sentence(tmp_path, capsys, monkeypatch):
    import socket

    monkeypatch.setenv("COMPROPE_CACHE", str(tmp_path))
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(SystemExit) as ended:
            main(["app", str(tmp_path / "a"), "--port", str(port), "--no-browser"])
    told = capsys.readouterr()
    assert ended.value.code == 2 and f"--port {port}" in told.err and told.out == ""
