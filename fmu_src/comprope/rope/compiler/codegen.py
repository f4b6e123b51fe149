"""Source text of the functions that run all effects of a model."""

from ..effects.base import HOOKS, Effect


def hook_source(hook: str, effects: list[type[Effect]]) -> str:
    """Source of one function that runs a hook through all effects that have it."""
    having = [
        (k, effect) for k, effect in enumerate(effects) if hook in effect.hooks or (hook == "tangents" and lacks_tangents(effect))
    ]
    calls = [(k, f"{effect.name}_{hook}({HOOKS[hook]})") for k, effect in having]
    if hook == "groove":
        lines = ["x, y, gx, gy = 0.0, 0.0, 0.0, 0.0"]
        for _, call in calls:
            lines += [f"a, b, c, d = {call}", "x, y, gx, gy = x + a, y + b, gx + c, gy + d"]
        return _function(hook, HOOKS[hook], [*lines, "return x, y, gx, gy"])
    if hook == "rail":
        lines = ["y, slope = 0.0, 0.0"]
        for _, call in calls:
            lines += [f"a, b = {call}", "y, slope = y + a, slope + b"]
        return _function(hook, HOOKS[hook], [*lines, "return y, slope"])
    powered = hook in ("moments", "forces")
    arguments = HOOKS[hook] + (", power" if powered else "")
    lines = [f"power[{k}] {'=' if hook == 'moments' else '+='} {call}" if powered else call for k, call in calls]
    if hook == "moments":
        lines = [f"power[{k}] = 0.0" for k in range(len(effects))] + lines
    return _function(hook, arguments, lines or ["pass"])


def lacks_tangents(effect: type[Effect]) -> bool:
    """Whether an effect has forces without tangents, which are then found by differences."""
    return "forces" in effect.hooks and "tangents" not in effect.hooks


def _function(name: str, arguments: str, lines: list[str]) -> str:
    body = "\n".join(f"    {line}" for line in lines)
    return f"@kernel\ndef all_{name}({arguments}):\n{body}\n"
