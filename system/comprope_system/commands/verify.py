"""`comprope verify`: checks of the numerics."""

from pathlib import Path
from typing import Annotated

import typer

NAMES = Annotated[
    list[str] | None,
    typer.Argument(metavar="[NAME]...", help="reference, offset, periods, convergence, invariants; default all."),
]
OUT = Annotated[Path, typer.Option(metavar="DIR", help="Folder for page and figures.")]


def verify(names: NAMES = None, out: OUT = Path("verification")) -> None:
    """Check the numerics against another program, closed forms, finer meshes and steps, symmetry and conservation.

    Writes one page with tables and figures; the exit status is 1 if a check fails.
    """
    from ..verification.workflow import run

    run(names or (), out)
