"""Serving the app on the loopback of this machine."""

import secrets
import socket
import sys
import webbrowser
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from pathlib import Path

import uvicorn
from starlette.applications import Starlette
from starlette.middleware import Middleware

from comprope.errors import InputError

from .desk import Desk
from .guard import Guard
from .routes import Routes
from .state import State

LOOPBACK = "127.0.0.1"
TOKEN_BYTES = 24
PATIENCE = 1  # s that open connections are given at the end


def make_app(campaign: Path, token: str, port: int, *, warm: bool = False) -> Starlette:
    """The app for one campaign folder, which need not exist; a `warm` one loads what it will need at once."""
    state, desk = State(campaign), Desk()

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        if warm:
            desk.warm()
        try:
            yield
        finally:
            state.close()
            desk.close()

    return Starlette(routes=Routes(state, desk).all(), middleware=[Middleware(Guard, token=token, port=port)], lifespan=lifespan)


def serve(campaign: Path, port: int = 0, *, browser: bool = True) -> None:
    """Serve until interrupted; prints the address, with its token, and opens it in a browser. Port 0 is any free one."""
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as listening:
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listening.bind((LOOPBACK, port))
            listening.listen()  # who opens the address at once waits until it is served
        except OSError as error:
            raise InputError(f"--port {port}: {error.strerror}; another number is accepted, or 0 for any free one") from None
        port, token = listening.getsockname()[1], secrets.token_urlsafe(TOKEN_BYTES)
        address = f"http://{LOOPBACK}:{port}/?token={token}"
        app = make_app(campaign, token, port, warm=True)
        sys.stdout.write(f"{address}\n")
        sys.stdout.flush()
        if browser:
            webbrowser.open(address)
        server = uvicorn.Server(uvicorn.Config(app, log_level="warning", timeout_graceful_shutdown=PATIENCE))
        with suppress(KeyboardInterrupt):
            server.run([listening])
