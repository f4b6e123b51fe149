"""Conversion of results to JSON."""

import json
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np

from comprope.atomic_files import atomic_write


def plain(value: Any) -> Any:
    """Mappings, sequences and numbers as JSON types; NaN and infinity become null."""
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [plain(item) for item in value]
    if isinstance(value, (float, np.floating)):
        return float(value) if isfinite(value) else None
    return value.item() if isinstance(value, np.generic) else value


def save_json(path: Path, value: Any) -> None:
    """Write a result to a JSON file, completely or not at all."""
    with atomic_write(path) as temporary:
        temporary.write_text(json.dumps(plain(value), indent=1) + "\n", encoding="utf-8")
