"""The documentation inside an FMU: one HTML page with its variables and its requirements."""

from pathlib import Path

from jinja2 import Environment

from .model_interface import ModelInterface, Variable

_PAGE = Path(__file__).with_name("page.html")


def documentation_page(
    interface: ModelInterface, version: str, python: str = "", needs: str = "", systems: str = "", fmi: str = "2.0"
) -> str:
    """The HTML page of a model's FMU for a version of FMI.

    `python` is the oldest version that runs it and `needs` the packages it requires; an FMU without Python has
    binaries for `systems` instead.
    """
    environment = Environment(autoescape=True, trim_blocks=True, keep_trailing_newline=True)
    environment.filters |= {"range": _range, "caption": _caption}
    tables = [(role, found) for role in ("input", "output", "parameter") if (found := interface.of_role(role))]
    pictures = [path.read_text("utf-8") for path in interface.pictures]
    return environment.from_string(_PAGE.read_text("utf-8")).render(
        model=interface, pictures=pictures, version=version, python=python, needs=needs, systems=systems, fmi=fmi, tables=tables
    )


def _caption(picture: str) -> str:
    """The title of an SVG picture."""
    return picture.partition("<title>")[2].partition("</title>")[0]


def _range(variable: Variable) -> str:
    low, high = (f"{bound:g}" if bound is not None else "" for bound in (variable.minimum, variable.maximum))
    return f"{low} to {high}" if low and high else f"at least {low}" if low else f"at most {high}" if high else "any"
