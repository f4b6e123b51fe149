"""The text of a new campaign.toml."""

import json
import re
from collections.abc import Mapping, Sequence

from ..measurements.files.raw_table import printable
from .column_roles import Role


def campaign_text(
    name: str, model: str, tables: Mapping[str, Mapping[str, object]], channels: Sequence[tuple[str, Role, float | None]],
    runs: Sequence[tuple[str, str, Mapping[str, str], Mapping[str, object]]],
) -> str:  # fmt: skip
    """The file: name, model, tables such as `[car]` and `[plant]`, channels with noise, runs with role, names and changes."""
    lines = ["# Written by `comprope new`. Check what each column was taken for; docs: first_campaign.md", ""]
    lines += [f"name = {_value(name)}", f"model = {_value(model)}", ""]
    for title, table in tables.items():
        if table:
            lines += [f"[{title}]", *(f"{_key(key)} = {_value(value)}" for key, value in table.items()), ""]
    for column, role, noise in channels:
        lines += [f"[[channels]]  # {role.certainty}: {printable(role.why, 100)}", f"column = {_value(column)}"]
        lines += [f"quantity = {_value(role.quantity)}", *([f"sensor = {_value(role.sensor)}"] if role.sensor else [])]
        reference = "absolute" if role.quantity == "sheave_angular_velocity" else "rest"
        lines += [f"unit = {_value(role.unit)}", *(["sign = -1"] if role.sign < 0 else []), f"reference = {_value(reference)}"]
        lines += [*([f"noise = {noise:g}"] if noise else []), ""]
    for file, role_of_run, columns, changes in runs:
        lines += ["[[runs]]", f"file = {_value(file)}", f"role = {_value(role_of_run)}"]
        for key, table in (("columns", columns), ("set", changes)):
            if table:
                lines.append(f"{key} = {_value(table)}")
        lines.append("")
    return "\n".join(lines).rstrip() + "\n"


def _key(key: str) -> str:
    """A key in TOML, between quotation marks if it is not plain."""
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else json.dumps(key, ensure_ascii=False)


def _value(value: object) -> str:
    """A value in TOML, whose strings are written as those of JSON, and tables in one line."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{_key(name)} = {_value(one)}' for name, one in value.items())} }}"
    return json.dumps(value, ensure_ascii=False)
