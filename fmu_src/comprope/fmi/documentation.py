"""The documentation inside an FMU: one HTML page with its variables and its requirements."""

from pathlib import Path

from jinja2 import Environment

from .arrays import Group, groups_of
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
    environment.filters |= {"range": _range, "caption": _caption, "type": _type, "start": _start}
    scalars = tuple(Group((one,), place) for place, one in enumerate(interface.variables))
    groups = groups_of(interface) if fmi == "3.0" else scalars
    roles = ("input", "output", "parameter")
    tables = [(role, found) for role in roles if (found := [one for one in groups if one.variable.role == role])]
    pictures = [path.read_text("utf-8") for path in interface.pictures]
    return environment.from_string(_PAGE.read_text("utf-8")).render(
        model=interface, pictures=pictures, version=version, python=python, needs=needs, systems=systems, fmi=fmi, tables=tables
    )


def _caption(picture: str) -> str:
    """The title of an SVG picture."""
    return picture.partition("<title>")[2].partition("</title>")[0]


def _type(group: Group) -> str:
    """Type of a variable, number of elements of an array, and whether it is tunable, as in `real, 6 values`."""
    size = f", {len(group.elements)} values" if len(group.elements) > 1 else ""
    return group.variable.kind + size + (", tunable" if group.variable.tunable else "")


def _start(group: Group) -> str:
    """Start values, those of an array separated by spaces."""
    return " ".join(str(one.start) for one in group.elements)


def _range(variable: Variable) -> str:
    low, high = (f"{bound:g}" if bound is not None else "" for bound in (variable.minimum, variable.maximum))
    return f"{low} to {high}" if low and high else f"at least {low}" if low else f"at most {high}" if high else "any"
