"""Source text of the functions that run all effects of a model, and of those that Python calls."""

import inspect

from ..effects.base import HOOKS, Effect, Kernel


def hook_source(hook: str, effects: list[type[Effect]]) -> str:
    """Source of one function that runs a hook through all effects that have it."""
    having = [(k, effect) for k, effect in enumerate(effects) if hook in effect.hooks or (hook == "tangents" and bare(effect))]
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


def bare(effect: type[Effect]) -> bool:
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
