"""Join the kernels and the effects of a model into the few functions that Python calls.

The joined functions live in a small file of their own in the user's cache folder, named by the
content of every kernel they contain. So they are compiled once for a machine, whichever copy of this
package asks for them, and a changed kernel is never mistaken for an old one.
"""

import inspect
import sys
import threading
import types
from collections.abc import Iterable, Mapping
from functools import cache, partial
from typing import Any

from ..effects import REGISTRY, numerical_tangent
from ..effects.base import HOOKS, Effect
from ..effects.kernel_checks import require_sound
from ..effects.user_effects import FILES
from ..integration import (
    initial_state,
    input_interpolation,
    mesh,
    newmark,
    outputs,
    static_equilibrium,
    time_stepping,
)
from ..linalg import block_band, bordered_band, multi_rhs
from ..mechanics import effect_hooks, end_conditions, energy, equations_of_motion, internal_forces, sensors, sheave_contact
from ..runtime import array_layout, jit, parameter_vector, simd, status
from ..sensitivity import directions
from ..sensitivity import effects as effect_derivatives
from ..sensitivity import internal_forces as internal_force_derivatives
from ..sensitivity import newmark as newmark_derivatives
from ..sensitivity import sensors as sensor_derivatives
from ..sensitivity import sheave_contact as sheave_contact_derivatives
from ..sensitivity import static_equilibrium as static_equilibrium_derivatives
from ..sensitivity import time_stepping as time_stepping_derivatives
from .codegen import bare, entry_source, hook_source
from .disk_cache import compiled_files, kernel_folder, source_file

MODULES = (
    array_layout, status, jit, effect_hooks, internal_forces, sheave_contact, end_conditions, equations_of_motion, block_band,
    bordered_band, newmark, energy, time_stepping, static_equilibrium, mesh, initial_state, input_interpolation, sensors, outputs,
    simd, multi_rhs, internal_force_derivatives, sheave_contact_derivatives, directions, effect_derivatives, newmark_derivatives,
    time_stepping_derivatives, sensor_derivatives, static_equilibrium_derivatives,
)  # fmt: skip
_LOCK = threading.RLock()
ENTRIES = {
    "divide": (mesh.divide, "number"),
    "coarse": (mesh.coarse, "integer"),
    "reach": (initial_state.out_of_reach, "integer"),
    "settle": (initial_state.settle, "integer"),
    "begin_motion": (input_interpolation.begin_motion, "nothing"),
    "lead": (input_interpolation.lead, "nothing"),
    "travel": (time_stepping.travel, "integer"),
    "show": (outputs.show, "nothing"),
    "residual": (outputs.residual_energy, "number"),
    "evaluate": (equations_of_motion.forces, "nothing"),
    "place": (end_conditions.place_ends, "nothing"),
    "sight": (sensors.sight, "nothing"),
    "side_maximum": (sensors.side_maximum, "nothing"),
    "advance_tangent": (time_stepping_derivatives.travel_tangent, "integer"),
    "hang_again": (static_equilibrium_derivatives.hang_again, "number"),
    "differentiate": (newmark_derivatives.differentiate, "nothing"),
    "look": (sensor_derivatives.look, "nothing"),
}


def compiled(effects: tuple[str, ...] | None = None) -> dict[str, jit.Entry]:
    """The joined functions (`jit.Entry`, see ENTRIES) for the effects named, by default for all that are registered.

    Raises `InputError` for a user's own effect that cannot be compiled or does not hold together.
    """
    with _LOCK:
        return _joined(tuple(REGISTRY[name] for name in (REGISTRY if effects is None else effects)))


@cache
def _joined(chosen: tuple[type[Effect], ...]) -> dict[str, jit.Entry]:
    acting = "\n".join(hook_source(hook, list(chosen)) for hook in HOOKS)
    entries = "\n".join(entry_source(name, *one) for name, one in ENTRIES.items())
    folder = kernel_folder([acting, entries, *_sources(chosen), repr(_slots(chosen))])
    if not (folder / "joined.py").exists():
        for effect in chosen:
            if effect.source:
                require_sound(effect)
    joined = types.ModuleType(f"comprope_joined_{folder.name}")
    # What is compiled is loaded again by the name of its module, which must not depend on where this package stands.
    sys.modules[joined.__name__] = joined
    for effect in chosen:
        own = bound(vars(sys.modules[effect.__module__]), joined.__name__)
        joined.__dict__.update({f"{effect.name}_{hook}": own[one.__name__] for hook, one in effect.hooks.items()})
        if bare(effect):
            names = vars(numerical_tangent) | {"own_forces": own[effect.hooks["forces"].__name__], "__name__": joined.__name__}
            code = numerical_tangent.differenced.__code__
            joined.__dict__[f"{effect.name}_tangents"] = jit.kernel(types.FunctionType(code, names, f"{effect.name}_tangents"))
    joined.__dict__["kernel"] = jit.kernel
    exec(acting, joined.__dict__)
    names = {key: value for module in MODULES for key, value in vars(module).items()}
    names |= {f"all_{hook}": getattr(joined, f"all_{hook}") for hook in HOOKS}
    joined.__dict__.update(bound(names, joined.__name__))
    exec(compile(entries, source_file(folder, entries), "exec"), joined.__dict__)
    compiling = {name: partial(compiled_files, folder, entries, f"call_{name}") for name in ENTRIES}
    return {name: jit.Entry(getattr(joined, f"call_{name}"), returns, compiling[name]) for name, (_, returns) in ENTRIES.items()}


def _sources(chosen: Iterable[type[Effect]]) -> list[str]:
    """The source of every kernel; of own effects as it was run, whatever has become of the file."""
    modules = {effect.__module__ for effect in chosen if not effect.source}
    built_in = [inspect.getsource(one) for one in (*MODULES, numerical_tangent, *(sys.modules[name] for name in sorted(modules)))]
    return built_in + sorted({FILES[effect.source].text for effect in chosen if effect.source})


def _slots(chosen: Iterable[type[Effect]]) -> list[tuple[int, str]]:
    """Which entries of the parameter vector the kernels know, and as what."""
    absent = tuple(f"effects.{name}." for name in set(REGISTRY) - {effect.name for effect in chosen})
    return [(k, name) for k, name in enumerate(parameter_vector.DECLARED) if not name.startswith(absent)]


def bound(names: Mapping[str, Any], module: str) -> dict[str, Any]:
    """A copy of a namespace in which every kernel calls the kernels of that copy."""
    copy = {key: value for key, value in names.items() if not key.startswith("__")} | {"__name__": module}
    for key, value in names.items():
        function = getattr(value, "py_func", value)
        compilable = value is not function or (jit.PURE and isinstance(function, types.FunctionType))
        if compilable and function.__module__ not in (jit.__name__, module):
            copy[key] = jit.kernel(types.FunctionType(function.__code__, copy, function.__name__))
    return copy
