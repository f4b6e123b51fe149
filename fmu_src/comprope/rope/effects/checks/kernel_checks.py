"""Consistency checks of user-defined effects: kernels compile, are finite, vanish at neutral values, and agree with each other.

The requirements are met by every built-in effect: powers are those of the forces, velocities are derivatives of positions,
and tangents of forces. Tangents may leave out what is small.
"""

import re
from collections.abc import Callable, Sequence
from typing import Any

import numba
import numpy as np
from numba.core.errors import NumbaError
from numpy.typing import NDArray

from ....errors import InputError
from ....kernels import jit
from ...parameters.parameter_vector import ELEMENT
from ...runtime.array_layout import BAND, BEND_RATE, CURVATURE, MOMENT, STIFF
from ...runtime.kernel_arguments import Weights
from ..base import HOOK_TYPES, HOOKS, Effect
from .trial_state import NODES, STEP, TIME, TrialState

Floats = NDArray[np.float64]
COLOURS = re.compile(r"\x1b\[[0-9;]*m")  # of the compiler's messages, where a package for colours is installed
CLOSE = 1e-5  # relative, for what has to be exact: what differences leave
ROUGH = 0.2  # relative, for tangents, which may be approximate
_BLOCKS = ((0, 0), (1, 3), (2, 7))  # how far apart the nodes of a block of the band are, and its first section
_RETURNED = {
    "groove": "x, y and their derivatives by the angle", "rail": "y and its derivative by the depth",
    "moments": "the power [W]", "forces": "the power [W]",
}  # fmt: skip


def require_consistent(effect: type[Effect]) -> None:
    """Raise `InputError`, with file and line, for the first thing that is wrong with an effect's kernels."""
    for hook, function in effect.hooks.items():
        try:
            problem = _compiler_problem(function, hook) or _result_problem(effect, hook) or _CHECKS.get(hook, _no_check)(effect)
        except Exception as error:  # a kernel may raise anything where it runs without a compiler
            problem = f"{type(error).__name__}: {error}"
        if problem:
            plain = getattr(function, "py_func", function)
            raise InputError(f"{effect.source}, line {plain.__code__.co_firstlineno}: {plain.__name__}: {problem}")


def _compiler_problem(function: Any, hook: str) -> str | None:
    """Why a kernel cannot be compiled for arrays without a length, as the joined kernels are."""
    if jit.PURE:
        return None
    weights = numba.types.NamedUniTuple(numba.float64, len(Weights._fields), Weights)
    types: dict[Any, Any] = {int: numba.int64, float: numba.float64, Weights: weights}
    try:
        function.compile(tuple(types.get(HOOK_TYPES.get(name), jit.POINTER) for name in HOOKS[hook].split(", ")))
    except NumbaError as error:
        return _compiler_message([line.strip() for line in COLOURS.sub("", str(error)).splitlines()])
    return None


def _compiler_message(lines: Sequence[str]) -> str:
    """The error message of numba, in one sentence."""
    place = next((line.partition(", line ")[2].split(":")[0] for line in lines if line.startswith("File ")), "")
    reason = next((line for line in lines if line and not line.startswith("Failed in")), "")
    if reason.startswith("No implementation"):
        call = next((line.removeprefix(">>>").strip() for line in lines if line.startswith(">>>")), reason)
        reason = f"{call} is not possible; kernels compute with numbers and single entries of arrays"
    return f"cannot be compiled{f' (line {place})' if place else ''}: {reason}"


def _result_problem(effect: type[Effect], hook: str) -> str | None:
    """Problems with the results of a hook at neutral and at nominal values."""
    for state in ("neutral", "nominal"):
        trial = TrialState(effect, nominal=state == "nominal")
        before = {name: array.copy() for name, array in trial.arguments.items() if isinstance(array, np.ndarray)}
        given = trial.call(hook)
        if not _returns_as_declared(hook, given):
            return f"returns {'nothing' if given is None else repr(given)}; {_RETURNED.get(hook, 'nothing')} is accepted"
        returned = np.ravel(0.0 if given is None else given)
        if not all(np.all(np.isfinite(np.ravel(array))) for array in (returned, *trial.arguments.values())):
            return f"gives numbers that are not finite where every quantity is {state}"
        changed = any(not np.array_equal(trial.arguments[name], array) for name, array in before.items())
        if state == "neutral" and hook != "begin" and (changed or np.any(returned)):
            return "changes something where every quantity is neutral"
    return None


def _returns_as_declared(hook: str, given: Any) -> bool:
    """Whether a hook returns as many numbers as it should."""
    numbers = given if isinstance(given, tuple) else () if given is None else (given,)
    wanted = {"groove": 4, "rail": 2, "moments": 1, "forces": 1}.get(hook, 0)
    return len(numbers) == wanted and all(isinstance(one, int | float) for one in numbers)


def _differ(given: Any, expected: Any, close: float = CLOSE) -> bool:
    given, expected = np.asarray(given, float), np.asarray(expected, float)
    return bool(np.abs(given - expected).max() > close * np.abs(expected).max() + 1e-9)


# -- each kernel against the others --------------------------------------------------------------------------


def _no_check(effect: type[Effect]) -> str | None:
    return None


def _forces(effect: type[Effect]) -> str | None:
    trial = TrialState(effect, nominal=True)
    return _power(trial.call("forces"), float(trial.arguments["f"] @ trial.arguments["v"]), "forces")


def _power(given: float, done: float, what: str) -> str | None:
    return f"returns a power of {given:.6g} W, but its {what} do {done:.6g} W" if _differ(given, done) else None


def _moments(effect: type[Effect]) -> str | None:
    trial, m = TrialState(effect, nominal=True), NODES + 1

    def inner(section: int) -> Floats:
        own: Floats = trial.arguments["w"][section * m + 1 : section * m + NODES - 1]
        return own

    def moment() -> Floats:
        inner(MOMENT)[:] = 0.0
        trial.call("moments")
        return inner(MOMENT).copy()

    def bent(step: float) -> None:
        inner(CURVATURE)[:] += step

    elastic = inner(MOMENT).copy()
    given = trial.call("moments")
    done = -float((inner(MOMENT) - elastic) @ inner(BEND_RATE)) * float(trial.p[ELEMENT])
    if problem := _power(given, done, "moments"):
        return problem
    stiff = inner(STIFF).copy()
    wrong = np.any(stiff) and _differ(stiff, trial.slope(bent, moment), ROUGH)
    return "what it adds to w[STIFF] is not the derivative of its moment by curvature" if wrong else None


def _tangents(effect: type[Effect]) -> str | None:
    if "forces" not in effect.hooks:
        return "without forces there is nothing to differentiate"
    for weights, array, word in ((Weights(1.0, 0.0), "q", "position"), (Weights(0.0, 1.0), "v", "velocity")):
        trial = TrialState(effect, nominal=True)
        trial.arguments["weights"] = weights
        trial.call("tangents")
        stated, held = _dense(trial.arguments["A"]), _dense(np.ones_like(trial.arguments["A"]))
        found = -held * np.array([trial.slope(_mover(trial.arguments[array], k), trial.forces) for k in range(2 * NODES + 2)]).T
        if np.any(stated) and _differ(stated, found, ROUGH):
            worst = np.unravel_index(np.abs(stated - found).argmax(), found.shape)
            return f"by {word} it adds {stated[worst]:.4g} to A where minus the derivative of the force is {found[worst]:.4g}"
    return None


def _mover(array: Floats, k: int) -> Callable[[float], None]:
    def move(step: float) -> None:
        array[k] += step

    return move


def _dense(band: Floats) -> Floats:
    """The dense matrix of a band."""
    m, rows = NODES + 1, band.reshape(BAND, NODES + 1)
    full = np.zeros((2 * m, 2 * m))
    for apart, first in _BLOCKS:
        for i in range(NODES - apart if apart else m):
            block = rows[first : first + 4, i] if apart else rows[[0, 1, 1, 2], i]
            here, there = (i, m + i), (i + apart, m + i + apart)
            full[np.ix_(here, there)] = block.reshape(2, 2)
            full[np.ix_(there, here)] = block.reshape(2, 2).T
    return full


def _ends(effect: type[Effect]) -> str | None:
    def placed(step: float) -> dict[str, Floats]:
        at = TrialState(effect, nominal=True).arguments
        at |= {"t": TIME + step, "q": at["q"] + at["v"] * step + 0.5 * at["a"] * step**2, "v": at["v"] + at["a"] * step}
        effect.hooks["ends"](*(at[name] for name in HOOKS["ends"].split(", ")))
        return at

    now, later, earlier = placed(0.0), placed(STEP), placed(-STEP)
    for word, of, what in (("velocity", "position", "qv"), ("acceleration", "velocity", "va")):
        if _differ(now[what[1]], (later[what[0]] - earlier[what[0]]) / (2.0 * STEP)):
            return f"the {word} that it gives an end is not the derivative of the {of} by time"
    return None


def _groove(effect: type[Effect]) -> str | None:
    trial = TrialState(effect, nominal=True)

    def turn(step: float) -> None:
        trial.arguments["angle"] += step

    given = trial.call("groove")
    wrong = _differ(given[2:], trial.slope(turn, lambda: np.array(trial.call("groove")))[:2])
    return "the last two numbers that it returns are not the derivatives of the first two by the angle" if wrong else None


def _rail(effect: type[Effect]) -> str | None:
    trial = TrialState(effect, nominal=True)

    def lower(step: float) -> None:
        trial.arguments["depth"] += step

    wrong = _differ(trial.call("rail")[1:], trial.slope(lower, lambda: np.array(trial.call("rail")))[:1])
    return "the second number that it returns is not the derivative of the first by the depth" if wrong else None


_CHECKS = {"forces": _forces, "moments": _moments, "tangents": _tangents, "ends": _ends, "groove": _groove, "rail": _rail}
