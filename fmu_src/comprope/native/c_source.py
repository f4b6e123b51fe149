"""C source that is generated: the model's variables, and the kernels' memory and how they are called."""

from collections.abc import Mapping, Sequence

from ..fmi.arrays import groups_of
from ..fmi.model_interface import ModelInterface, Variable
from ..fmi.validation import range_text
from ..kernels.entry_source import EntrySource
from ..kernels.status import MESSAGE_VALUES, Messages
from .component import Component
from .llvm_ir import PREFIX

_HEADING = "/* Generated from the declarations of the model; not to be edited. */\n"
_INCLUDES = "#include <stddef.h>\n#include <stdint.h>\n"
_C_TYPES = {int: "int64_t", bool: "int8_t", float: "double", type(None): "void"}


def model_source(interface: ModelInterface, guid: str, token: str) -> str:
    """The variables as C's `VARIABLES`, and the identity for FMI 2.0 and 3.0 (see variables.h)."""
    sizes = {group.elements[0].name: (len(group.elements), group.stride) for group in groups_of(interface)}
    rows = "".join(f"    {_row(one, *sizes.get(one.name, (0, 1)))},\n" for one in interface.variables)
    outputs = len(interface.of_role("output"))
    return (
        f'{_HEADING}#include "variables.h"\n\n#include <math.h>\n\n'
        f"const Variable VARIABLES[] = {{\n{rows}}};\n\n"
        f"const size_t VARIABLE_COUNT = {len(interface.variables)};\nconst size_t OUTPUT_COUNT = {outputs};\n"
        f"const char MODEL_NAME[] = {quoted(interface.name)};\n"
        f"const char MODEL_GUID[] = {quoted(guid)};\nconst char MODEL_TOKEN[] = {quoted(token)};\n"
    )


def _row(one: Variable, elements: int, stride: int) -> str:
    low = "-INFINITY" if one.minimum is None else _number(one.minimum)
    high = "INFINITY" if one.maximum is None else _number(one.maximum)
    unit = "" if one.unit == "1" else f" {one.unit}"
    texts = (f"{one.role} {one.name}", unit, range_text(one), one.help)
    name, unit, accepted, help = (quoted(text) for text in texts)
    start = _number(float(one.start or 0.0))
    role = "TUNABLE" if one.tunable else one.role.upper()
    return f"{{{one.kind.upper()}, {role}, {name}, {start}, {low}, {high}, {unit}, {accepted}, {help}, {elements}, {stride}}}"


def _number(value: float) -> str:
    """A number of C that has every bit of the value."""
    return float(value).hex()


def quoted(text: str) -> str:
    """A string of C; what is not plain ASCII stands as its bytes in UTF-8, in octal."""
    plain = set(range(ord(" "), ord("~") + 1)) - set(b'"\\?')
    return '"' + "".join(chr(byte) if byte in plain else f"\\{byte:03o}" for byte in text.encode()) + '"'


def kernels_header(component: Component) -> str:
    """What the C sources need of the kernels: `kernels.h`."""
    used = {name for entry in component.sources.values() for name in entry.used}
    parts = [
        _constants(component),
        component.declarations,
        _arrays(component, used),
        _among_values(component),
        _messages(component.messages),
        *(_call(source) for source in component.sources.values()),
    ]
    return f"{_HEADING}#ifndef KERNELS_H\n#define KERNELS_H\n\n{_INCLUDES}\n" + "\n".join(filter(None, parts)) + "\n#endif\n"


def _constants(component: Component) -> str:
    """Numbers of the component, and the place of the first input."""
    if [one.name for one in component.interface.of_role("output")] != list(component.outputs):
        raise ValueError("the model's outputs do not stand in the order of the kernels")
    inputs = component.places[component.interface.of_role("input")[0].name]
    values = {"FIRST_INPUT": inputs, "MESSAGE_VALUES": MESSAGE_VALUES} | dict(component.constants)
    return "enum {\n" + "".join(f"    {name} = {value},\n" for name, value in values.items()) + "};\n"


def _among_values(component: Component) -> str:
    """The arrays that the kernels read where the values of variables lie; these must lie in the kernels' order."""
    places = component.places
    rows = [f"    {{{_constant(name)}, {_first(places, names)}}},\n" for name, names in component.among_variables.items()]
    return (
        f"enum {{ AMONG_VALUES_COUNT = {len(rows)} }};\n\nstatic const struct {{\n    size_t array, place;\n}} "
        f"AMONG_VALUES[AMONG_VALUES_COUNT] = {{\n{''.join(rows)}}};\n"
    )


def _first(places: Mapping[str, int], names: Sequence[str]) -> int:
    first = places[names[0]] if names else 0
    if [places[name] for name in names] != list(range(first, first + len(names))):
        raise ValueError(f"the model's variables {names[0]} ... do not stand in the order of the kernels")
    return first


def _arrays(component: Component, used: set[str]) -> str:
    """The tables of arrays and integers, and the sizes of the arrays, which grow linearly with the number of columns."""
    arrays, integers = component.tables.arrays, component.tables.integers
    names = [name for name in arrays if name in used]
    if [arrays[name] for name in names] != list(range(len(names))):
        raise ValueError("the arrays of the component do not come first in the kernels' table")
    numbers = {name: place for name, place in integers.items() if name in used}
    if list(numbers.values()) != list(range(len(numbers))):
        raise ValueError("the integers of the component do not come first in the kernels' table")
    places = "".join(f"    {_constant(name)},\n" for name in names)
    return (
        f"enum {{\n{places}    ARRAYS,\n    STATE_ARRAYS = {_constant(component.last_of_state)} + 1,\n}};\n\n"
        f"enum {{\n{''.join(f'    {_constant(name)},{chr(10)}' for name in numbers)}    INTEGERS,\n}};\n\n"
        "typedef struct {\n    double *array[ARRAYS];\n    int64_t integer[INTEGERS];\n} Tables;\n\n"
        "static const struct {\n    size_t per_column, fixed;\n} SIZES[ARRAYS] = {\n"
        + "".join(_size(component, name) for name in names)
        + "};\n"
    )


def _size(component: Component, name: str) -> str:
    """One row of SIZES; an array among the values of variables has none."""
    if name in component.among_variables:
        return f"    [{_constant(name)}] = {{0, 0}},\n"
    (few, small), (more, larger), (many, large) = sorted((n, sizes[name]) for n, sizes in component.sizes.items())
    slope = (larger - small) // (more - few)
    fixed = small - slope * few
    if (larger, large) != (slope * more + fixed, slope * many + fixed):
        raise ValueError(f"the array {name} does not grow linearly with the number of columns")
    return f"    [{_constant(name)}] = {{{slope}, {fixed}}},\n"


def _constant(name: str) -> str:
    """The constant in C for an array or integer: STATE_q for `State.q`."""
    group, _, field = name.partition(".")
    return f"{group.upper()}_{field}"


def _messages(messages: Messages) -> str:
    rows = "".join(f"    [{status}] = {quoted(text)},\n" for status, (_, text, _) in sorted(messages.items()))
    return f"static const char *const MESSAGES[] = {{\n{rows}}};\n"


def _call(source: EntrySource) -> str:
    """The prototype of a compiled entry point, and a function that calls it with the tables of a model."""
    result = _C_TYPES[source.result]
    numbers = "".join(f", {_C_TYPES[kind]} {one}" for one, kind in source.scalars.items())
    given = "".join(f", {one}" for one in source.scalars)
    stored = "void *" if result == "void" else f"{result} "
    body = f"    {stored}result = 0;\n    void *problem = 0;\n"
    body += f"    {PREFIX}{source.name}(&result, &problem, tables->array, tables->integer{given});\n"
    body += "" if result == "void" else "    return result;\n"
    return (
        f"int32_t {PREFIX}{source.name}({stored}*, void **, double **, int64_t *{numbers});\n\n"
        f"static inline {result} call_{source.name}(Tables *tables{numbers})\n{{\n{body}}}\n"
    )
