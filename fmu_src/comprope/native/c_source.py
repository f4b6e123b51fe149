"""C source that is generated: the model's variables, and the kernels' memory and how they are called."""

from collections.abc import Mapping

import numpy as np

from ..fmi.model_interface import ModelInterface, Variable
from ..fmi.validation import range_text
from ..kernels.status import MESSAGE_VALUES
from ..rope.compiler.entry_points import SOURCES, TABLES
from ..rope.compiler.workspace import without_friction
from ..rope.effects.base import REGISTRY, Effect
from ..rope.integration.outputs import OUTPUTS
from ..rope.runtime.parameter_vector import DECLARED
from ..rope.runtime.status import MESSAGES
from ..rope.simulator.end_motion import NAMES
from .llvm_ir import CALLED, PREFIX

_HEADING = "/* Generated from the declarations of the model; not to be edited. */\n"
_INCLUDES = "#include <stddef.h>\n#include <stdint.h>\n"
_LAST_OF_STATE = "Ends.samples"  # the arrays of a rope up to this one are what its state consists of
_AMONG_VARIABLES = ("Ends.u", "Ends.options", "Outputs.sensors")  # have no memory of their own
ARRAYS, INTEGERS = TABLES.arrays, TABLES.integers
_C_TYPES = {int: "int64_t", bool: "int8_t", float: "double", type(None): "void"}


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
    texts = (f"{one.role} {one.name}", unit, range_text(one), one.help)
    name, unit, accepted, help = (quoted(text) for text in texts)
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
    fixed = {"Outputs.y": len(interface.of_role("output"))} | dict.fromkeys(_AMONG_VARIABLES, 0)
    used = {name for entry in CALLED for name in SOURCES[entry].used}
    chosen = {n: {name: (dict(found) | fixed)[name] for name in ARRAYS if name in used} for n, found in sizes.items()}
    parts = [_constants(interface), _slots(interface), _arrays(chosen), _messages(), *(_call(name) for name in CALLED)]
    return f"{_HEADING}#ifndef KERNELS_H\n#define KERNELS_H\n\n{_INCLUDES}\n" + "\n".join(parts) + "\n#endif\n"


def _places(interface: ModelInterface) -> dict[str, int]:
    return {one.name: place for place, one in enumerate(interface.variables)}


def _constants(interface: ModelInterface) -> str:
    """Places of values that the kernels read where they lie; they must lie in the kernels' order."""
    places = _places(interface)
    sensors = sum(name.startswith("lateral_displacement[") for name in places)
    sensor_values = [f"sensors[{k}].{what}" for k in range(1, sensors + 1) for what in ("height", "on_counterweight_side")]
    readings = [f"{what}[{k}]" for k in range(1, sensors + 1) for what in ("lateral_displacement", "in_view")]
    firsts = {
        "FIRST_SENSOR": _first(places, sensor_values, "derivative_inputs"),
        "FIRST_OPTION": _first(places, ["derivative_inputs", "inputs_at_end"]),
        "FIRST_INPUT": _first(places, list(NAMES)),
        "FIRST_OUTPUT": _first(places, [*readings, *OUTPUTS]),
        "SENSORS": sensors,
        "EFFECTS": len(effects_of(interface)),
        "HISTORIES": sum(one.states for one in effects_of(interface)),
        "MESSAGE_VALUES": MESSAGE_VALUES,
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
    names, special = list(DECLARED), without_friction(np.full(len(DECLARED), np.nan)).tolist()
    places = [_places(interface).get(names[k], -1) for k in known]
    pairs = [f"    {{{slot}, {_number(special[k])}}},\n" for slot, k in enumerate(known) if special[k] == special[k]]
    return (
        f"enum {{ SLOT_COUNT = {len(places)}, FRICTIONLESS_COUNT = {len(pairs)} }};\n\n"
        f"static const int SLOT_PLACES[SLOT_COUNT] = {{{', '.join(map(str, places))}}};\n\n"
        "static const struct {\n    size_t slot;\n    double value;\n} FRICTIONLESS[FRICTIONLESS_COUNT] = {\n"
        + "".join(pairs)
        + "};\n"
    )


def _arrays(sizes: Mapping[int, Mapping[str, int]]) -> str:
    """The rope's tables of arrays and integers, and the sizes of the arrays, which grow linearly with the number of nodes."""
    few, more, many = sorted(sizes)
    names, rows = list(sizes[few]), []
    if [ARRAYS[name] for name in names] != list(range(len(names))):
        raise ValueError("the arrays of a rope do not come first in the kernels' table")
    for name in names:
        slope = (sizes[more][name] - sizes[few][name]) // (more - few)
        fixed = sizes[few][name] - slope * (few + 1)
        if any(sizes[n][name] != slope * (n + 1) + fixed for n in (more, many)):
            raise ValueError(f"the array {name} does not grow linearly with the number of nodes")
        rows.append(f"    [{_constant(name)}] = {{{slope}, {fixed}}},\n")
    places = "".join(f"    {_constant(name)},\n" for name in names)
    integers = [name for name in INTEGERS if name.startswith("RopeData.")]
    numbers = "".join(f"    {_constant(name)} = {INTEGERS[name]},\n" for name in integers)
    return (
        f"enum {{\n{places}    ARRAYS,\n    STATE_ARRAYS = {_constant(_LAST_OF_STATE)} + 1,\n}};\n\n"
        f"enum {{\n{numbers}    INTEGERS = {len(integers)},\n}};\n\n"
        "typedef struct {\n    double *array[ARRAYS];\n    int64_t integer[INTEGERS];\n} Rope;\n\n"
        "static const struct {\n    size_t per_column, fixed;\n} SIZES[ARRAYS] = {\n" + "".join(rows) + "};\n"
    )


def _constant(name: str) -> str:
    """The constant in C for an array or integer: STATE_q for `State.q`."""
    group, _, field = name.partition(".")
    return f"{group.upper()}_{field}"


def _messages() -> str:
    rows = "".join(f"    [{status}] = {quoted(text)},\n" for status, (_, text, _) in sorted(MESSAGES.items()))
    return f"static const char *const MESSAGES[] = {{\n{rows}}};\n"


def _call(name: str) -> str:
    """The prototype of a compiled entry point, and a function that calls it with the tables of a rope."""
    source = SOURCES[name]
    result = _C_TYPES[source.result]
    numbers = "".join(f", {_C_TYPES[kind]} {one}" for one, kind in source.scalars.items())
    given = "".join(f", {one}" for one in source.scalars)
    stored = "void *" if result == "void" else f"{result} "
    body = f"    {stored}result = 0;\n    void *problem = 0;\n"
    body += f"    {PREFIX}{name}(&result, &problem, rope->array, rope->integer{given});\n"
    body += "" if result == "void" else "    return result;\n"
    return (
        f"int32_t {PREFIX}{name}({stored}*, void **, double **, int64_t *{numbers});\n\n"
        f"static inline {result} rope_{name}(Rope *rope{numbers})\n{{\n{body}}}\n"
    )
