"""Join the kernels and the effects of a model into the few functions that Python calls.

The joined functions live in a small file of their own in the user's cache folder, named by the
content of every kernel they contain. So they are compiled once for a machine, whichever copy of this
package asks for them, and a changed kernel is never mistaken for an old one.
"""

import hashlib
import inspect
import os
import sys
import tempfile
import threading
import types
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numba

from . import (
    acting,
    band,
    contact,
    direction,
    display,
    dynamics,
    elastica,
    ends,
    following,
    glance,
    groove,
    hooks,
    jit,
    journey,
    lanes,
    ledger,
    march,
    newmark,
    sensors,
    slope,
    slots,
    standing,
    statics,
    tangent,
    travel,
    vector,
    words,
    work,
    zone,
)  # fmt: skip
from .effects import REGISTRY, differenced
from .effects.base import HOOKS, Effect, Kernel
from .effects.own import FILES
from .effects.sound import require_sound

MODULES = (
    work, words, jit, hooks, elastica, contact, ends, dynamics, band, zone, newmark, ledger, march, statics, standing, following,
    travel, sensors, display, vector, lanes, slope, groove, direction, acting, tangent, journey, glance,
)  # fmt: skip
_LOCK = threading.RLock()
ENTRIES = {
    "divide": (standing.divide, "number"),
    "coarse": (standing.coarse, "integer"),
    "reach": (standing.out_of_reach, "integer"),
    "settle": (standing.settle, "integer"),
    "begin_motion": (following.begin_motion, "nothing"),
    "lead": (following.lead, "nothing"),
    "travel": (travel.travel, "integer"),
    "show": (display.show, "nothing"),
    "residual": (display.residual_energy, "number"),
    "evaluate": (dynamics.forces, "nothing"),
    "place": (ends.place_ends, "nothing"),
    "sight": (sensors.sight, "nothing"),
    "side_maximum": (sensors.side_maximum, "nothing"),
    "advance_tangent": (journey.travel_tangent, "integer"),
    "hang_again": (glance.hang_again, "number"),
    "differentiate": (tangent.differentiate, "nothing"),
    "look": (glance.look, "nothing"),
}


def hook_source(hook: str, effects: list[type[Effect]]) -> str:
    """Source of one function that runs a hook through all effects that have it."""
    having = [(k, effect) for k, effect in enumerate(effects) if hook in effect.hooks or (hook == "tangents" and _bare(effect))]
    calls = [(k, f"{effect.name}_{hook}({HOOKS[hook]})") for k, effect in having]
    if hook == "groove":
        lines = ["x, y, gx, gy = 0.0, 0.0, 0.0, 0.0"]
        for _, call in calls:
            lines += [f"a, b, c, d = {call}", "x, y, gx, gy = x + a, y + b, gx + c, gy + d"]
        return _function(hook, HOOKS[hook], [*lines, "return x, y, gx, gy"])
    powered = hook in ("moments", "forces")
    arguments = HOOKS[hook] + (", power" if powered else "")
    lines = [f"power[{k}] {'=' if hook == 'moments' else '+='} {call}" if powered else call for k, call in calls]
    if hook == "moments":
        lines = [f"power[{k}] = 0.0" for k in range(len(effects))] + lines
    return _function(hook, arguments, lines or ["pass"])


def _bare(effect: type[Effect]) -> bool:
    """Whether an effect has forces without tangents, which are then found by differences."""
    return "forces" in effect.hooks and "tangents" not in effect.hooks


def _function(name: str, arguments: str, lines: list[str]) -> str:
    body = "\n".join(f"    {line}" for line in lines)
    return f"@kernel\ndef all_{name}({arguments}):\n{body}\n"


def entry_source(name: str, function: Kernel, returns: str) -> str:
    """Source of one function that Python calls: the kernel `function`."""
    names = list(inspect.signature(getattr(function, "py_func", function)).parameters)
    arguments = ", ".join(names)
    call = f"{function.__name__}({arguments})"
    return f"def call_{name}({arguments}):\n    {call if returns == 'nothing' else f'return {call}'}\n"


def cache_folder(sources: Iterable[str]) -> Path:
    """Folder for what is compiled from these sources, in the user's cache or, failing that, a temporary one."""
    key = hashlib.sha256("\0".join([*sources, numba.__version__, sys.version]).encode()).hexdigest()[:16]
    for base in (os.environ.get("COMPROPE_CACHE"), _user_cache(), Path(tempfile.gettempdir()) / "comprope"):
        if base:
            folder = Path(base) / key
            try:
                folder.mkdir(parents=True, exist_ok=True)
            except OSError:
                continue
            if os.access(folder, os.W_OK):
                return folder
    return Path(tempfile.mkdtemp(prefix="comprope"))


def _user_cache() -> Path:
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", tempfile.gettempdir())) / "comprope" / "cache"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "comprope"


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
    folder = cache_folder([acting, entries, *_sources(chosen), repr(_slots(chosen))])
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
        if _bare(effect):
            names = vars(differenced) | {"own_forces": own[effect.hooks["forces"].__name__], "__name__": joined.__name__}
            code = differenced.differenced.__code__
            joined.__dict__[f"{effect.name}_tangents"] = jit.kernel(types.FunctionType(code, names, f"{effect.name}_tangents"))
    joined.__dict__["kernel"] = jit.kernel
    exec(acting, joined.__dict__)
    names = {key: value for module in MODULES for key, value in vars(module).items()}
    names |= {f"all_{hook}": getattr(joined, f"all_{hook}") for hook in HOOKS}
    joined.__dict__.update(bound(names, joined.__name__))
    exec(compile(entries, _file(folder / "joined.py", entries), "exec"), joined.__dict__)
    return {name: jit.Entry(getattr(joined, f"call_{name}"), returns) for name, (_, returns) in ENTRIES.items()}


def _sources(chosen: Iterable[type[Effect]]) -> list[str]:
    """The source of every kernel; of own effects as it was run, whatever has become of the file."""
    modules = {effect.__module__ for effect in chosen if not effect.source}
    built_in = [inspect.getsource(one) for one in (*MODULES, differenced, *(sys.modules[name] for name in sorted(modules)))]
    return built_in + sorted({FILES[effect.source].text for effect in chosen if effect.source})


def _slots(chosen: Iterable[type[Effect]]) -> list[tuple[int, str]]:
    """Which entries of the parameter vector the kernels know, and as what."""
    absent = tuple(f"effects.{name}." for name in set(REGISTRY) - {effect.name for effect in chosen})
    return [(k, name) for k, name in enumerate(slots.DECLARED) if not name.startswith(absent)]


def bound(names: Mapping[str, Any], module: str) -> dict[str, Any]:
    """A copy of a namespace in which every kernel calls the kernels of that copy."""
    copy = {key: value for key, value in names.items() if not key.startswith("__")} | {"__name__": module}
    for key, value in names.items():
        function = getattr(value, "py_func", value)
        compilable = value is not function or (jit.PURE and isinstance(function, types.FunctionType))
        if compilable and function.__module__ not in (jit.__name__, module):
            copy[key] = jit.kernel(types.FunctionType(function.__code__, copy, function.__name__))
    return copy


def _file(path: Path, text: str) -> str:
    """Write the text where it is not written yet, whole or not at all; returns the path."""
    if not path.exists():
        with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False, suffix=".tmp") as file:
            file.write(text)
        Path(file.name).replace(path)
    return str(path)
