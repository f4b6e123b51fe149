"""Error messages for invalid tables: one line per problem, with key, value and what is accepted."""

import types
from collections.abc import Sequence
from difflib import get_close_matches
from typing import Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from .quantities import quantities

Location = Sequence[str | int]


def validation_problems(error: ValidationError, component: type[BaseModel]) -> list[str]:
    """One line `<key> = <value>: <what is accepted>` for each problem found by the validation of `component`."""
    return [_sentence(component, dict(item)) for item in error.errors(include_url=False)]


def dotted_key(location: Location) -> str:
    """The location of a value as a dotted key; list indices start at 1, as in `sensors[1].height`."""
    text = ""
    for part in location:
        text += f"[{part + 1}]" if isinstance(part, int) else f".{part}"
    return text.lstrip(".")


def accepted(owner: type[BaseModel], name: str) -> str:
    """What the field `name` of a component accepts: range and unit, choices or form, and its line of help."""
    field = _fields(owner)[name]
    number = next((item for item in quantities(owner) if item.name == name), None)
    if number:
        unit = "" if number.unit == "1" else f" {number.unit}"
        return f"a number from {number.minimum:g} to {number.maximum:g}{unit} is accepted ({number.help})"
    if get_origin(field.annotation) is Literal:
        choices = " or ".join(f'"{choice}"' for choice in get_args(field.annotation))
        return f"{choices} is accepted ({field.description})"
    nested = _component_in(field.annotation)
    if nested is not None:
        wanted = "a list of tables" if get_origin(field.annotation) is tuple else "a table"
        return f"{wanted} with the keys {', '.join(_fields(nested))} is accepted"
    return f"accepted is: {field.description}"


def _fields(component: type[BaseModel]) -> dict[str, FieldInfo]:
    """The fields of a component by the names they have in a file."""
    return {field.alias or name: field for name, field in component.model_fields.items()}


def suggestion(unknown: str, known: Sequence[str]) -> str:
    """`did you mean "x"?` if a known name is similar to the unknown one; otherwise the known names."""
    close = get_close_matches(unknown, known, n=1, cutoff=0.6)
    return f'did you mean "{close[0]}"?' if close else f"accepted are {', '.join(known) or 'none'}"


def _sentence(component: type[BaseModel], item: dict[str, Any]) -> str:
    location, kind = item["loc"], item["type"]
    key = dotted_key(location)
    if kind == "value_error":
        return f"{key}: {item['ctx']['error']}" if key else str(item["ctx"]["error"])
    owner = _component_at(component, location[:-1])
    last = location[-1] if location else None
    if kind == "extra_forbidden":
        known = list(_fields(owner)) if owner else []
        return f"{key}{_value_text(item['input'])}: unknown key; {suggestion(str(last), known)}"
    wanted = accepted(owner, last) if owner and isinstance(last, str) else _item_accepted(component, item)
    return f"{key}: missing; {wanted}" if kind == "missing" else f"{key}{_value_text(item['input'])}: {wanted}"


def _item_accepted(component: type[BaseModel], item: dict[str, Any]) -> str:
    nested = _component_at(component, item["loc"])
    return f"a table with the keys {', '.join(_fields(nested))} is accepted" if nested else str(item["msg"])


def _value_text(value: Any) -> str:
    """` = value` in TOML notation; empty for a table, which is long."""
    if isinstance(value, dict):
        return ""
    text = str(value).lower() if isinstance(value, bool) else f'"{value}"' if isinstance(value, str) else str(value)
    return f" = {text}" if len(text) <= 60 else f" = {text[:57]}..."


def _component_at(component: type[BaseModel], location: Location) -> type[BaseModel] | None:
    current: type[BaseModel] | None = component
    for part in location:
        if isinstance(part, str):
            field = _fields(current).get(part) if current else None
            current = _component_in(field.annotation) if field else None
    return current


def _component_in(annotation: Any) -> type[BaseModel] | None:
    """The component in a type annotation: itself, or the one within `X | None` or `tuple[X, ...]`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    if get_origin(annotation) in (Union, types.UnionType, tuple, list):
        return next((found for part in get_args(annotation) if (found := _component_in(part))), None)
    return None
