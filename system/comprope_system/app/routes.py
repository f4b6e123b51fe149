"""What the app answers: the page, its state, uploads, descriptions, computations, reports and downloads."""

import asyncio
import contextlib
import json
import uuid
from collections.abc import AsyncIterator, Callable
from typing import Any
from urllib.parse import unquote

from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response, StreamingResponse
from starlette.routing import Route

from comprope.errors import CompropeError, InputError

from . import computations, descriptions, page, replays
from .computations import COMPUTATIONS, JSON, MODEL, PAGE
from .desk import Desk
from .state import State
from .workspace import MAX_FILE

MAX_JSON = 2**20  # bytes of a request that is no file
PAUSE = 0.2  # s between looks for news
BEAT = 1.0  # s between reports of a running job, whose time goes on without news
DOWNLOADS = (PAGE, JSON, MODEL)
SHORT = {"check": computations.check, "compare": computations.compare}


class Routes:
    """The answers, for one campaign."""

    def __init__(self, state: State, desk: Desk) -> None:
        self.state, self.desk = state, desk

    def all(self) -> list[Route]:
        """Every address with its methods."""
        told = {
            ("/", "GET"): self.index, ("/static/{name}", "GET"): self.static, ("/state", "GET"): self.shown,
            ("/events", "GET"): self.events, ("/files/{name}", "PUT"): self.upload, ("/files/{name}", "DELETE"): self.remove,
            ("/describe", "POST"): self.describe, ("/campaign", "POST"): self.save, ("/run/{name}", "POST"): self.run,
            ("/replay", "POST"): self.replay, ("/overlay", "POST"): self.overlay,
            ("/fmus", "POST"): self.fmus, ("/jobs", "POST"): self.start,
            ("/job", "DELETE"): self.cancel, ("/results/{name}", "DELETE"): self.forget,
            ("/preview", "GET"): self.preview, ("/report/{name}", "GET"): self.report,
            ("/download/{name}/{file}", "GET"): self.download,
        }  # fmt: skip
        return [Route(path, explained(answer), methods=[method]) for (path, method), answer in told.items()]

    async def index(self, request: Request) -> Response:
        """The page."""
        return page.page()

    async def static(self, request: Request) -> Response:
        """Styles and scripts."""
        return page.static(request.path_params["name"])

    async def shown(self, request: Request) -> Response:
        """The state."""
        return JSONResponse(self.state.shown())

    async def events(self, request: Request) -> Response:
        """The state whenever it has changed, as server-sent events."""
        return StreamingResponse(self._news(request), media_type="text/event-stream")

    async def _news(self, request: Request) -> AsyncIterator[str]:
        seen, waited = -1, 0.0
        while not await request.is_disconnected():
            running = self.state.job is not None and self.state.job.state == "running"
            if seen != self.state.version or (running and waited >= BEAT):
                seen, waited = self.state.version, 0.0
                yield f"data: {json.dumps(self.state.shown())}\n\n"
            await asyncio.sleep(PAUSE)
            waited += PAUSE

    async def upload(self, request: Request) -> Response:
        """Take a file, completely or not at all, up to `MAX_FILE` bytes."""
        path = self.state.workspace.upload_path(unquote(request.path_params["name"]))
        temporary, size = path.with_name(f".{uuid.uuid4().hex}"), 0
        try:
            with temporary.open("wb") as file:
                async for part in request.stream():
                    size += len(part)
                    if size > MAX_FILE:
                        raise InputError(f"{path.name}: larger than {MAX_FILE >> 20} MiB, which is the most that is accepted")
                    file.write(part)
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)
        return self._news_and({"name": path.name, "size": size})

    async def remove(self, request: Request) -> Response:
        """Remove an uploaded file."""
        self.state.workspace.upload_path(unquote(request.path_params["name"])).unlink(missing_ok=True)
        return self._news_and({})

    async def describe(self, request: Request) -> Response:
        """What the uploaded files are taken for, with corrections."""
        workspace, stated = self.state.workspace, await body(request)
        found = await self.desk.run(descriptions.describe, workspace.uploaded(), workspace.staged, workspace.name, stated)
        return JSONResponse(found)

    async def save(self, request: Request) -> Response:
        """Write the campaign that was described."""
        workspace = self.state.workspace
        given = (workspace.staged, workspace.name, workspace.campaign.absolute())
        return self._news_and(await asyncio.to_thread(descriptions.save_campaign, *given))

    async def run(self, request: Request) -> Response:
        """A short computation."""
        name = request.path_params["name"]
        if name not in SHORT:
            raise InputError(f"{name}: {', '.join(SHORT)} are accepted")
        self._require_campaign()
        found = await self.desk.run(SHORT[name], self.state.workspace.campaign, self.state.workspace.results())
        return self._news_and(found)

    async def overlay(self, request: Request) -> Response:
        """The models of some results, drawn together."""
        names = [self._known(str(one)) for one in (await body(request))["names"]]
        workspace = self.state.workspace
        return self._news_and(await self.desk.run(computations.overlay, workspace.campaign, workspace.results(), names))

    async def replay(self, request: Request) -> Response:
        """A true replay of what a slider was moved to."""
        asked = await body(request)
        self._require_campaign()
        results, source = self.state.workspace.results(), str(asked["source"])
        return JSONResponse(await self.desk.run(replays.replay, results, source, str(asked["effect"]), numbers(asked["values"])))

    async def fmus(self, request: Request) -> Response:
        """Build the FMUs of a result."""
        asked = await body(request)
        name = self._known(str(asked["name"]))
        found = await self.desk.run(computations.fmus, self.state.workspace.results(), name, bool(asked.get("native")))
        return self._news_and(found)

    async def start(self, request: Request) -> Response:
        """Start a long computation."""
        asked = await body(request)
        self._require_campaign()
        name, effect = str(asked["name"]), asked.get("effect")
        if name not in COMPUTATIONS or (name == "add") != isinstance(effect, str):
            raise InputError(f"{name}: {', '.join(COMPUTATIONS)} are accepted, add with an effect")
        arguments: dict[str, Any] = {"effect": effect} if name == "add" else {}
        if name == "add" and "values" in asked:
            found = self.desk.run(replays.start_of_fit, self.state.workspace.results(), effect, numbers(asked["values"]))
            arguments["start"] = await found
        elif name == "add" and "start" in asked:
            arguments["start"] = {str(key): float(value) for key, value in asked["start"].items()}
        self.state.start(name, arguments)
        return self._news_and({})

    async def cancel(self, request: Request) -> Response:
        """Cancel the running job."""
        await asyncio.to_thread(self.state.cancel)
        return self._news_and({})

    async def forget(self, request: Request) -> Response:
        """Remove a result."""
        self.state.workspace.forget(self._known(unquote(request.path_params["name"])))
        return self._news_and({})

    async def preview(self, request: Request) -> Response:
        """The curves of the described files."""
        return page.report(self.state.workspace.staged / descriptions.PREVIEW)

    async def report(self, request: Request) -> Response:
        """The report of a result."""
        return page.report(self.state.workspace.file(unquote(request.path_params["name"]), PAGE))

    async def download(self, request: Request) -> Response:
        """A file of a result."""
        name, file = unquote(request.path_params["name"]), request.path_params["file"]
        path = self.state.workspace.file(name, file) if file in DOWNLOADS else None
        if path is None and file.endswith(".fmu") and name in self.state.workspace.records():
            path = next((one for one in self.state.workspace.fmu_folder(name).glob("*.fmu") if one.name == file), None)
        return FileResponse(path, filename=path.name) if path else Response("there is no such file", 404)

    def _known(self, name: str) -> str:
        """The name of a result; raises `InputError` if there is none."""
        if name not in self.state.workspace.records():
            raise InputError(f"{name[:80]}: there is no such result")
        return name

    def _require_campaign(self) -> None:
        if not self.state.workspace.exists:
            raise InputError("there is no campaign yet: drop the files of a logger and save it first")

    def _news_and(self, found: dict[str, Any]) -> Response:
        self.state.changed()
        return JSONResponse(found)


async def body(request: Request) -> dict[str, Any]:
    """The JSON of a request; raises `InputError` for anything else, or too much."""
    text = b""
    async for part in request.stream():
        text += part
        if len(text) > MAX_JSON:
            raise InputError("the request is too large")
    with contextlib.suppress(ValueError):
        found = json.loads(text or b"{}")
        if isinstance(found, dict):
            return found
    raise InputError("the request is no JSON object")


def numbers(values: Any) -> list[float]:
    """Numbers of a request."""
    return [float(one) for one in values]


def explained(answer: Callable[[Request], Any]) -> Callable[[Request], Any]:
    """The answer with every error as a sentence."""

    async def answered(request: Request) -> Response:
        try:
            response: Response = await answer(request)
        except CompropeError as error:
            return JSONResponse({"error": str(error)}, 422)
        except (KeyError, TypeError, ValueError) as error:
            return JSONResponse({"error": f"the request lacks something or has it wrong: {error}"}, 400)
        except Exception as error:  # whatever it is, the page shows a sentence
            return JSONResponse({"error": f"internal error: {type(error).__name__}: {' '.join(str(error).split())}"}, 500)
        return response

    return answered
