"""C source that is generated: the model's variables, and the kernels' memory and how they are called."""

from collections.abc import Mapping

import numpy as np

from ..fmi.model_interface import ModelInterface, Variable
from ..fmi.validation import range_text
from ..rope.compiler.entry_points import compiled
from ..rope.compiler.workspace import without_friction
from ..rope.effects.base import REGISTRY, Effect
from ..rope.integration.input_interpolation import PAST
from ..rope.integration.outputs import SHOWN
from ..rope.runtime import status as words
from ..rope.runtime.jit import kind
from ..rope.runtime.parameter_vector import DECLARED
from ..rope.simulator.end_motion import NAMES
from .llvm_ir import CALLED, PREFIX

_HEADING = "/* Generated from the declarations of the model; not to be edited. */\n"
_INCLUDES = "#include <stddef.h>\n#include <stdint.h>\n"
# What makes a rope's state: the arrays of `state.State`, in that order, and the memory of its inputs.
_STATE = ("q0", "v0", "a0", "f0", "h0", "P0", "E", "start", "count", "time", "past")
_WINDOWS = ("u", "options", "spots")  # lie among the values of the variables
_HELD = ("n", "m", "effects", "state_size")  # numbers that stay the same for one rope
_C = {"integer": "int64_t", "flag": "int8_t", "number": "double", "array": "double *"}


def model_source(interface: ModelInterface, guid: str, token: str) -> str:
    """The variables as C's `VARIABLES`, and the identity for FMI 2.0 and 3.0 (see variables.h)."""
    rows = "".join(f"    {_row(one)},\n" for one in interface.variables)
    outputs = len(interface.of_role("output"))
    return (
        f'{_HEADING}#include "variables.h"\n\n#include <math.h>\n\n'
        f"const Variable VARIABLES[] = {{\n{rows}}};\n\n"
        f"const size_t VARIABLE_COUNT = {len(interface.variables)};\nconst size_t OUTPUT_COUNT = {outputs};\n"
        f"const char MODEL_NAME[] = {quoted(interface.name)};\n"
        f"const char MODEL_GUID[] = {quoted(guid)};\nconst char MODEL_TOKEN[] = {quoted(token)};\n"
    )


def _row(one: Variable) -> str:
    low = "-INFINITY" if one.minimum is None else _number(one.minimum)
    high = "INFINITY" if one.maximum is None else _number(one.maximum)
    unit = "" if one.unit == "1" else f" {one.unit}"
    words = (f"{one.role} {one.name}", unit, range_text(one), one.help)
    name, unit, accepted, help = (quoted(text) for text in words)
    start = _number(float(one.start or 0.0))
    return f"{{{one.kind.upper()}, {one.role.upper()}, {name}, {start}, {low}, {high}, {unit}, {accepted}, {help}}}"


def _number(value: float) -> str:
    """A number of C that has every bit of the value."""
    return float(value).hex()


def quoted(text: str) -> str:
    """A string of C; what is not plain ASCII stands as its bytes in UTF-8, in octal."""
    plain = set(range(ord(" "), ord("~") + 1)) - set(b'"\\?')
    return '"' + "".join(chr(byte) if byte in plain else f"\\{byte:03o}" for byte in text.encode()) + '"'


def effects_of(interface: ModelInterface) -> list[type[Effect]]:
    """The effects that a rope may have: those with parameters among its variables."""
    found = {one.name.split(".")[1] for one in interface.variables if one.name.startswith("effects.")}
    return [effect for name, effect in REGISTRY.items() if name in found]


def kernels_header(interface: ModelInterface, sizes: Mapping[int, Mapping[str, int]]) -> str:
    """What `rope_model.c` needs of the kernels: `kernels.h`.

    `sizes` says, for three numbers of nodes, how many numbers each array of a rope has.
    """
    outputs = {"y": len(interface.of_role("output")), "past": PAST}
    used = {name for entry in CALLED for name in compiled()[entry].names if kind(name) == "array"} - set(_WINDOWS)
    chosen = {n: {name: (dict(found) | outputs)[name] for name in sorted(used)} for n, found in sizes.items()}
    parts = [_constants(interface), _slots(interface), _arrays(chosen), _words(), *(_call(name) for name in CALLED)]
    return f"{_HEADING}#ifndef KERNELS_H\n#define KERNELS_H\n\n{_INCLUDES}\n" + "\n".join(parts) + "\n#endif\n"


def _places(interface: ModelInterface) -> dict[str, int]:
    return {one.name: place for place, one in enumerate(interface.variables)}


def _constants(interface: ModelInterface) -> str:
    """Places of values that the kernels read where they lie; they must lie in the kernels' order."""
    places = _places(interface)
    sensors = sum(name.startswith("lateral_displacement[") for name in places)
    spots = [f"sensors[{k}].{what}" for k in range(1, sensors + 1) for what in ("height", "on_counterweight_side")]
    shown = [f"{what}[{k}]" for k in range(1, sensors + 1) for what in ("lateral_displacement", "in_view")]
    firsts = {
        "FIRST_SENSOR": _first(places, spots, "derivative_inputs"),
        "FIRST_OPTION": _first(places, ["derivative_inputs", "inputs_at_end"]),
        "FIRST_INPUT": _first(places, list(NAMES)),
        "FIRST_OUTPUT": _first(places, [*shown, *SHOWN]),
        "SENSORS": sensors,
        "EFFECTS": len(effects_of(interface)),
        "HISTORIES": sum(one.states for one in effects_of(interface)),
        "TOLD": words.TOLD,
    }
    return "enum {\n" + "".join(f"    {name} = {value},\n" for name, value in firsts.items()) + "};\n"


def _first(places: dict[str, int], names: list[str], empty: str = "") -> int:
    first = places[names[0] if names else empty]
    if [places[name] for name in names] != list(range(first, first + len(names))):
        raise ValueError(f"the model's variables {names[0]} ... do not stand in the order of the kernels")
    return first


def _slots(interface: ModelInterface) -> str:
    """Where each of the kernels' parameters stands among the values, and which ones a rope without friction has instead."""
    effects = tuple(f"effects.{one.name}." for one in effects_of(interface))
    known = [k for k, name in enumerate(DECLARED) if not name.startswith("effects.") or name.startswith(effects)]
    names, smooth = list(DECLARED), without_friction(np.full(len(DECLARED), np.nan)).tolist()
    places = [_places(interface).get(names[k], -1) for k in known]
    pairs = [f"    {{{slot}, {_number(smooth[k])}}},\n" for slot, k in enumerate(known) if smooth[k] == smooth[k]]
    return (
        f"enum {{ SLOT_COUNT = {len(places)}, SMOOTH_COUNT = {len(pairs)} }};\n\n"
        f"static const int SLOT_PLACES[SLOT_COUNT] = {{{', '.join(map(str, places))}}};\n\n"
        "static const struct {\n    size_t slot;\n    double value;\n} SMOOTH[SMOOTH_COUNT] = {\n" + "".join(pairs) + "};\n"
    )


def _arrays(sizes: Mapping[int, Mapping[str, int]]) -> str:
    """The arrays of a rope, those of its state first, and their sizes, which grow evenly with the number of nodes."""
    few, more, many = sorted(sizes)
    names = [*_STATE, *(name for name in sizes[few] if name not in _STATE)]
    rows = []
    for name in names:
        slope = (sizes[more][name] - sizes[few][name]) // (more - few)
        fixed = sizes[few][name] - slope * (few + 1)
        if any(sizes[n][name] != slope * (n + 1) + fixed for n in (more, many)):
            raise ValueError(f"the array {name} does not grow evenly with the number of nodes")
        rows.append(f"    {{{slope}, {fixed}}}, /* {name} */\n")
    places = "".join(f"    AT_{name},\n" for name in (*names, *_WINDOWS))
    return (
        f"enum {{\n{places}    ALL_ARRAYS,\n    ARRAYS = AT_{_WINDOWS[0]}, /* that have memory of their own */\n"
        f"    STATE_ARRAYS = {len(_STATE)},\n}};\n\n"
        "typedef struct {\n    int64_t " + ", ".join(_HELD) + ";\n    double *array[ALL_ARRAYS];\n} Rope;\n\n"
        "static const struct {\n    size_t per_column, fixed;\n} SIZES[ARRAYS] = {\n" + "".join(rows) + "};\n"
    )


def _words() -> str:
    texts = {status: text for status, (_, text, _) in words.WORDS.items()}
    rows = "".join(f"    [{status}] = {quoted(text)},\n" for status, text in sorted(texts.items()))
    return f"static const char *const WORDS[] = {{\n{rows}}};\n"


def _call(name: str) -> str:
    """The prototype of a compiled kernel, and a function that calls it with the arrays of a rope filled in."""
    entry = compiled()[name]
    result = {"none": "void *", "float64": "double ", "int64": "int64_t "}[str(entry.signature.return_type)]
    returns = "void" if result == "void *" else result.strip()
    prototype = ", ".join(f"{_C[kind(one)]}" for one in entry.names)
    given = "".join(f", {_C[kind(one)]} {one}" for one in entry.names if kind(one) != "array" and one not in _HELD)
    arguments = ", ".join(_argument(one) for one in entry.names)
    body = f"    {result}result = 0;\n    void *problem = 0;\n    {PREFIX}{name}(&result, &problem, {arguments});\n"
    body += "" if returns == "void" else "    return result;\n"
    return (
        f"int32_t {PREFIX}{name}({result}*, void **, {prototype});\n\n"
        f"static inline {returns} rope_{name}(const Rope *rope{given})\n{{\n{body}}}\n"
    )


def _argument(name: str) -> str:
    return f"rope->array[AT_{name}]" if kind(name) == "array" else f"rope->{name}" if name in _HELD else name
