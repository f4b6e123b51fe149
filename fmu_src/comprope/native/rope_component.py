"""The rope as the native FMU needs it."""

from collections.abc import Mapping

import numpy as np

from ..fmi.model_interface import ModelInterface
from ..rope.compiler.entry_points import SOURCES, TABLES
from ..rope.compiler.workspace import without_friction
from ..rope.effects.base import REGISTRY, Effect
from ..rope.effects.user_effects import FILES
from ..rope.integration.outputs import OUTPUTS
from ..rope.parameters.parameter_vector import DECLARED
from ..rope.runtime.status import MESSAGES
from ..rope.simulator.end_motion import NAMES
from .component import Component
from .llvm_ir import CALLED, rope_sizes

_OPTIONS = ("derivative_inputs", "inputs_at_end")
_SENSOR = ("height", "on_counterweight_side")


def rope_component(interface: ModelInterface, sizes: Mapping[int, Mapping[str, int]] | None = None) -> Component:
    """The rope with the variables of its interface; the effects that it may have are compiled in, a user's own as well.

    `sizes` are those of `llvm_ir.rope_sizes`, by default computed.
    """
    effects = effects_of(interface)
    files = {one.source: FILES[one.source].text for one in effects if one.source}
    names = [one.name for one in interface.variables]
    sensors = sum(name.startswith("lateral_displacement[") for name in names)
    readings = [f"{what}[{k}]" for k in range(1, sensors + 1) for what in ("lateral_displacement", "in_view")]
    outputs = [*readings, *OUTPUTS]
    found = rope_sizes(files) if sizes is None else sizes
    return Component(
        "rope",
        interface,
        {name: SOURCES[name] for name in CALLED["rope"]},
        TABLES,
        {nodes + 1: dict(arrays) | {"Outputs.y": len(outputs)} for nodes, arrays in found.items()},
        "Ends.samples",
        {
            "Ends.u": NAMES,
            "Ends.options": _OPTIONS,
            "Outputs.sensors": [f"sensors[{k}].{what}" for k in range(1, sensors + 1) for what in _SENSOR],
        },
        outputs,
        MESSAGES,
        {"SENSORS": sensors, "EFFECTS": len(effects), "HISTORIES": sum(one.states for one in effects)},
        _slots(interface, effects),
        files,
    )


def effects_of(interface: ModelInterface) -> list[type[Effect]]:
    """The effects that a rope may have: those with parameters among its variables, in the order in which they were first run."""
    found = {one.name.split(".")[1] for one in interface.variables if one.name.startswith("effects.")}
    return [effect for name, effect in REGISTRY.items() if name in found]


def _slots(interface: ModelInterface, chosen: list[type[Effect]]) -> str:
    """Where each of the kernels' parameters stands among the values, which are tunable, and those without friction."""
    effects = tuple(f"effects.{one.name}." for one in chosen)
    known = [k for k, name in enumerate(DECLARED) if not name.startswith("effects.") or name.startswith(effects)]
    names, special = list(DECLARED), without_friction(np.full(len(DECLARED), np.nan)).tolist()
    values = {one.name: place for place, one in enumerate(interface.variables)}
    places = [values.get(names[k], -1) for k in known]
    pairs = [f"    {{{slot}, {float(special[k]).hex()}}},\n" for slot, k in enumerate(known) if special[k] == special[k]]
    tunable = {one.name for one in interface.variables if one.tunable}
    tuned = [slot for slot, k in enumerate(known) if names[k] in tunable]
    return (
        f"enum {{ SLOT_COUNT = {len(places)}, TUNABLE_COUNT = {len(tuned)}, FRICTIONLESS_COUNT = {len(pairs)} }};\n\n"
        f"static const int SLOT_PLACES[SLOT_COUNT] = {{{', '.join(map(str, places))}}};\n\n"
        f"static const size_t TUNABLE_SLOTS[TUNABLE_COUNT] = {{{', '.join(map(str, tuned))}}};\n\n"
        "static const struct {\n    size_t slot;\n    double value;\n} FRICTIONLESS[FRICTIONLESS_COUNT] = {\n"
        + "".join(pairs)
        + "};\n"
    )
