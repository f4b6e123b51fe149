"""Entry points for Python and C: the kernels linked with the effects of a model.

The joined functions live in a small file of their own in the user's cache folder, named by the
content of every kernel they contain. So they are compiled once for a machine, whichever copy of this
package asks for them, and a changed kernel is never mistaken for an old one.
"""

import inspect
import sys
import threading
import types
from collections.abc import Iterable
from functools import cache
from typing import Any

from ...kernels import inlining, jit
from ...kernels.disk_cache import kernel_folder
from ...kernels.entry import Entry
from ...kernels.entry_source import EntrySource, Tables
from ...kernels.inlining import inlined_kernel
from ...kernels.joined import entries_of, entries_text, joined_module
from ...kernels.kernel_linking import linked, merged
from ..effects import REGISTRY, numerical_tangent
from ..effects.base import HOOKS, Effect
from ..effects.checks.kernel_checks import require_consistent
from ..effects.user_effects import FILES
from ..integration import (
    derivative_hook,
    initial_state,
    input_interpolation,
    mesh,
    newmark,
    outputs,
    static_equilibrium,
    time_stepping,
)
from ..linalg import block_band, bordered_band, multi_rhs
from ..mechanics import (
    axial_law,
    base_motion,
    effect_hooks,
    end_conditions,
    energy,
    equations_of_motion,
    internal_forces,
    internal_tangent,
    run_record,
    sensors,
    wall_motion,
)
from ..mechanics.contact import contact_law, contact_tangent, sheave_contact
from ..parameters import parameter_vector
from ..runtime import array_layout, kernel_arguments, simd, status
from ..runtime.kernel_arguments import TABLE, Directions
from ..sensitivity import directions
from ..sensitivity import effects as effect_derivatives
from ..sensitivity import end_conditions as end_condition_derivatives
from ..sensitivity import equations_of_motion as force_derivatives
from ..sensitivity import internal_forces as internal_force_derivatives
from ..sensitivity import newmark as newmark_derivatives
from ..sensitivity import sensors as sensor_derivatives
from ..sensitivity import sheave_contact as sheave_contact_derivatives
from ..sensitivity import static_equilibrium as static_equilibrium_derivatives
from .codegen import hook_source, lacks_tangents

MODULES = (
    kernel_arguments, array_layout, status, axial_law, base_motion, internal_forces, internal_tangent, contact_law,
    contact_tangent, sheave_contact, end_conditions, equations_of_motion, block_band, bordered_band, newmark, energy,
    run_record, wall_motion, time_stepping, static_equilibrium, mesh, initial_state, input_interpolation, sensors, outputs,
    simd, multi_rhs,
    internal_force_derivatives, sheave_contact_derivatives, directions, effect_derivatives, end_condition_derivatives,
    force_derivatives, newmark_derivatives, sensor_derivatives, static_equilibrium_derivatives,
)  # fmt: skip
# Functions that a model, or derivatives, put in the place of those that do nothing.
HOOK_MODULES = (effect_hooks, derivative_hook)
_LOCK = threading.RLock()
ENTRIES = {
    "generate_mesh": mesh.generate_mesh,
    "check_mesh": mesh.check_mesh,
    "check_reach": initial_state.check_reach,
    "check_start": initial_state.check_start,
    "check_motion": input_interpolation.check_motion,
    "start_at_rest": initial_state.start_at_rest,
    "start_inputs": input_interpolation.start_inputs,
    "interpolate_inputs": input_interpolation.interpolate_inputs,
    "advance": time_stepping.advance,
    "evaluate_outputs": outputs.evaluate_outputs,
    "energy_residual": outputs.energy_residual,
    "forces": equations_of_motion.forces_of_state,
    "place_ends": end_conditions.place_ends_of_state,
    "read_displacement": outputs.read_displacement,
    "read_side_maximum": outputs.read_side_maximum,
    "advance_with_directions": time_stepping.advance,
    "changed_equilibrium": static_equilibrium_derivatives.solve_changed_equilibrium,
    "differentiate_forces": force_derivatives.differentiate_forces,
    "read_sensors_along": sensor_derivatives.read_sensors_along,
}
ABSENT: dict[str, tuple[Any, ...]] = {"advance": (Directions,)}  # groups that an entry point does without
TABLES = Tables(TABLE)
SOURCES = {name: EntrySource(name, kernel, TABLES, ABSENT.get(name, ())) for name, kernel in ENTRIES.items()}


def compiled(effects: tuple[str, ...] | None = None) -> dict[str, Entry]:
    """The entry points (see ENTRIES) for the effects named, by default for all that are registered.

    Raises `InputError` for a user's own effect that cannot be compiled or does not hold together.
    """
    with _LOCK:
        return _joined(tuple(REGISTRY[name] for name in (REGISTRY if effects is None else effects)))


@cache
def _joined(chosen: tuple[type[Effect], ...]) -> dict[str, Entry]:
    hooks = "\n".join(hook_source(hook, list(chosen)) for hook in HOOKS)
    folder = kernel_folder([hooks, entries_text(SOURCES), *_sources(chosen), repr(_slots(chosen))])
    if not (folder / "joined.py").exists():
        for effect in chosen:
            if effect.source:
                require_consistent(effect)
    joined = joined_module(folder)
    for effect in chosen:
        _link_effect(effect, joined)
    joined.__dict__["kernel"] = inlined_kernel
    exec(hooks, joined.__dict__)
    replacing = {f"all_{hook}": getattr(joined, f"all_{hook}") for hook in HOOKS}
    replacing |= {"advance_directions": newmark_derivatives.advance_directions}
    joined.__dict__.update(linked(merged(MODULES, replacing), joined.__name__))
    return entries_of(joined, folder, SOURCES)


def _link_effect(effect: type[Effect], joined: types.ModuleType) -> None:
    """Put the kernels of an effect into the joined module, by effect and hook."""
    own = linked(vars(sys.modules[effect.__module__]), joined.__name__)
    joined.__dict__.update({f"{effect.name}_{hook}": own[one.__name__] for hook, one in effect.hooks.items()})
    if lacks_tangents(effect):
        names = vars(numerical_tangent) | {"effect_kernel": own[effect.hooks["forces"].__name__], "__name__": joined.__name__}
        code = numerical_tangent.difference_forces.__code__
        joined.__dict__[f"{effect.name}_tangents"] = inlined_kernel(types.FunctionType(code, names, f"{effect.name}_tangents"))


def _sources(chosen: Iterable[type[Effect]]) -> list[str]:
    """The source of every kernel; of own effects as it was run, whatever has become of the file."""
    modules = {effect.__module__ for effect in chosen if not effect.source}
    own = (*MODULES, *HOOK_MODULES, jit, inlining, numerical_tangent)
    built_in = [inspect.getsource(one) for one in (*own, *(sys.modules[name] for name in sorted(modules)))]
    return built_in + sorted({FILES[effect.source].text for effect in chosen if effect.source})


def _slots(chosen: Iterable[type[Effect]]) -> list[tuple[int, str]]:
    """Which entries of the parameter vector the kernels know, and as what."""
    absent = tuple(f"effects.{name}." for name in set(REGISTRY) - {effect.name for effect in chosen})
    return [(k, name) for k, name in enumerate(parameter_vector.DECLARED) if not name.startswith(absent)]
