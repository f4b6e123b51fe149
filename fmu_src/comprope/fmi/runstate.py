"""A whole run as bytes: what the face knows, and the engine's own state behind it."""

import json
import struct
from dataclasses import asdict, dataclass
from typing import Any

from ..errors import InputError

_MAGIC = b"comprope run 1\n"
_LENGTHS = struct.Struct("<QQ")


@dataclass(frozen=True)
class RunState:
    """Where a run stands. Floats keep every bit: they are written with all the digits they need."""

    model: str
    values: dict[str, Any]
    first_inputs: dict[str, Any]
    outputs: dict[str, Any]
    start: float
    stop: float | None
    time: float
    running: bool
    failure: str | None


def pack(state: RunState, engine: bytes) -> bytes:
    """The run as bytes, valid in any process that has the same FMU."""
    head = json.dumps(asdict(state)).encode()
    return _MAGIC + _LENGTHS.pack(len(head), len(engine)) + head + engine


def unpack(data: bytes, model: str) -> tuple[RunState, bytes]:
    """The run and the engine's state; raises `InputError` for bytes that are not a state of `model`."""
    try:
        state, engine = _parts(data)
    except (ValueError, TypeError, struct.error) as error:
        raise InputError(f"saved state: {len(data)} bytes that are not a whole state of this FMU") from error
    if state.model != model:
        raise InputError(f"saved state: made by {state.model}; only states of {model} are accepted")
    return state, engine


def _parts(data: bytes) -> tuple[RunState, bytes]:
    if not data.startswith(_MAGIC):
        raise ValueError("no state")
    start = len(_MAGIC) + _LENGTHS.size
    head, engine = _LENGTHS.unpack(data[len(_MAGIC) : start])
    if len(data) != start + head + engine:
        raise ValueError("cut or padded")
    return RunState(**json.loads(data[start : start + head])), data[start + head :]
