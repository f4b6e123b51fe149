"""`comprope verify`: verification of the numerics."""

from pathlib import Path
from typing import Annotated

import typer

NAMES = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="[NAME]...", help="reference, offset, periods, capstan, shortening, convergence, invariants; default all."
    ),
]
OUT = Annotated[Path, typer.Option(metavar="DIR", help="Folder for HTML page and figures.")]


def verify(names: NAMES = None, out: OUT = Path("verification")) -> None:
    """Verify the numerics: another program, closed-form solutions, mesh and step convergence, symmetry, conservation.

    Writes an HTML page with tables and figures; the exit status is 1 if a check fails.
    """
    from ...studies.verification.workflow import run

    run(names or (), out)
