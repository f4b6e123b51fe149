"""`comprope app`: the way from raw files to a better model, in the browser."""

import importlib
from pathlib import Path
from typing import Annotated

import typer

from comprope.errors import InputError

FOLDER = Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="Folder with campaign.toml, or a new one to be made.")]
PORT = Annotated[int, typer.Option(metavar="N", min=0, max=65535, help="Port on 127.0.0.1; default any free one.")]
NO_BROWSER = Annotated[bool, typer.Option("--no-browser", help="Print the address only.")]


def app(campaign: FOLDER = Path("campaign"), port: PORT = 0, no_browser: NO_BROWSER = False) -> None:
    """Serve a page on this machine: drop raw files, check, compare, diagnose, move effects by hand, download the new model.

    Prints its address, with the token that it needs. Nobody but this machine's user can open it. Ends with Ctrl-C.
    """
    if campaign.is_file():
        raise InputError(f"{campaign}: is a file; the folder of a campaign is accepted")
    try:
        server = importlib.import_module("comprope_system.app.server")
    except ModuleNotFoundError as error:
        raise InputError(f"the app needs {error.name}; pip install 'comprope[app]'") from None
    server.serve(campaign, port, browser=not no_browser)
