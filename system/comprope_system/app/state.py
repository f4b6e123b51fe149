"""What the page shows: the campaign, uploaded files, results, the running job, and the commands that do the same."""

import json
import os
import shlex
from contextlib import suppress
from pathlib import Path
from typing import Any

from comprope.errors import InputError
from comprope.rope.effects import INSTRUMENT, REGISTRY
from comprope.user_cache import write_whole

from ..measurements.campaign_file import read_campaign_file
from ..measurements.units import UNITS
from .job import RUNNING, Job
from .workspace import Workspace

PRESETS = ("tower50", "tower50_light", "building200")


class State:
    """The campaign of an app and its one job; `version` changes with everything that the page shows."""

    def __init__(self, campaign: Path) -> None:
        self.workspace = Workspace(campaign)
        self.job: Job | None = None
        self.version = 0
        self._closing = False
        self._mark = self.workspace.root / "job.json"

    def changed(self) -> None:
        """There is something new to show."""
        self.version += 1
        if self.job and self.job.state != RUNNING and not self._closing:
            self._mark.unlink(missing_ok=True)

    def start(self, name: str, arguments: dict[str, Any]) -> None:
        """Start a job; raises `InputError` while another one is running."""
        if self.job and self.job.state == RUNNING:
            raise InputError(f"{self.job.name} is running; wait for it or cancel it")
        workspace = self.workspace
        described = read_campaign_file(workspace.campaign / "campaign.toml")
        fit = sum(run.role == "fit" for run in described.runs)
        write_whole(self._mark, json.dumps({"name": name, "arguments": arguments, "server": os.getpid()}))
        self.job = Job(name, arguments, workspace.campaign, workspace.results(), fit, self.changed)
        self.changed()

    def cancel(self) -> None:
        """Cancel the running job, or forget one that has ended or was interrupted."""
        if self.job and self.job.state == RUNNING:
            self.job.cancel()
        else:
            self.job = None
        self._mark.unlink(missing_ok=True)
        self.changed()

    def close(self) -> None:
        """End the job's process with the server; a later one offers to resume it."""
        self._closing = True
        if self.job and self.job.state == RUNNING:
            self.job.stop()

    def interrupted(self) -> dict[str, Any] | None:
        """The job that was running when an earlier server ended."""
        if self.job and self.job.state == RUNNING:
            return None
        with suppress(OSError, ValueError):
            found: dict[str, Any] = json.loads(self._mark.read_text("utf-8"))
            return found
        return None

    def shown(self) -> dict[str, Any]:
        """Everything, as JSON."""
        workspace = self.workspace
        return {
            "version": self.version, "folder": str(workspace.campaign), "exists": workspace.exists,
            "uploads": [{"name": one.name, "size": one.stat().st_size} for one in workspace.uploaded()],
            "results": workspace.shown_results(), "job": self.job.status() if self.job else None,
            "interrupted": self.interrupted(), "effects": effects(workspace), "units": {q: list(u) for q, u in UNITS.items()},
            "presets": list(PRESETS), "commands": self.commands(),
        }  # fmt: skip

    def commands(self) -> list[str]:
        """The commands that do what has been done here."""
        workspace = self.workspace
        folder = shlex.quote(str(workspace.campaign))
        names = workspace.records()
        found = _new_command(folder, [one.name for one in workspace.uploaded()])
        found += [f"comprope check {folder}"] if workspace.exists else []
        found += [f"comprope compare {folder} --report compare.html"] if "compare" in names else []
        found += [f"comprope diagnose {folder} --report diagnose.html"] if "diagnose" in names else []
        files: dict[str, str] = {}  # model files by the name of the result
        for name, facts in ((name, one["facts"]) for name, one in names.items() if one["model"]):
            files[name] = f"model{len(files) + 1}"
            start = [f"--start {shlex.quote(f'{key}={value:.6g}')}" for key, value in (facts.get("start") or {}).items()]
            what = ["add", folder, shlex.quote(facts["effect"]), *start] if "effect" in facts else ["improve", folder]
            out = files[name]
            found.append(f"comprope {' '.join(what)} --out {out}.toml --report {out}.html --fmu {out}_fmus")
        if "overlay" in names:
            models = [f"--model {files[one]}.toml" for one in names["overlay"]["facts"]["models"] if one in files]
            found.append(f"comprope compare {folder} {' '.join(models)} --report overlay.html")
        return found


def _new_command(folder: str, files: list[str]) -> list[str]:
    """The command that describes the uploaded files, none without; corrections are in campaign.toml."""
    models = [f" --model {shlex.quote(one)}" for one in files if one.endswith(".toml")]
    runs = [one for one in files if not one.endswith(".toml")]
    return [f"comprope new {folder} {shlex.join(runs)}{''.join(models)}  # then correct {folder}/campaign.toml"] if runs else []


def effects(workspace: Workspace) -> list[str]:
    """Names of all effects that can be added, faults of instruments with their channel."""
    columns: list[str] = []
    with suppress(InputError):
        if workspace.exists:
            columns = [one.column for one in read_campaign_file(workspace.campaign / "campaign.toml").channels]
    return [*REGISTRY, *(f"{fault}.{column}" for fault in INSTRUMENT for column in columns)]
