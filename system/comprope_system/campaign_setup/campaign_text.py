"""The text of a new campaign.toml."""

import json
import re
from collections.abc import Mapping, Sequence

from ..measurements.files.raw_table import printable
from .column_roles import Role
from .run_entries import RunEntry


def campaign_text(
    name: str, model: str, tables: Mapping[str, Mapping[str, object]], channels: Sequence[tuple[str, Role, float | None]],
    runs: Sequence[RunEntry],
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
        lines += [f"unit = {_value(role.unit)}", *(["sign = -1"] if role.sign < 0 else []), f"reference = {_value(role.zero)}"]
        lines += [*([f"noise = {noise:g}"] if noise else []), ""]
    for run in runs:
        lines += ["[[runs]]", f"file = {_value(run.file)}", f"role = {_value(run.role)}"]
        lines += [f"car_start = {run.answers.car_start:g}"] if run.answers.car_start is not None else []
        tables_of_run = {"files": run.files, "columns": run.columns, "readings": run.readings, "set": run.answers.changes}
        lines += [*(f"{key} = {_value(table)}" for key, table in tables_of_run.items() if table), ""]
    return "\n".join(lines).rstrip() + "\n"


def _key(key: str) -> str:
    """A key in TOML, between quotation marks if it is not plain."""
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else _text(key)


def _value(value: object) -> str:
    """A value in TOML; tables in one line."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{_key(name)} = {_value(one)}' for name, one in value.items())} }}"
    return _text(value)


def _text(value: object) -> str:
    """A text or number in TOML, which is written as in JSON but for the character DEL."""
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
