"""The kernels as LLVM's intermediate code, for no processor in particular, and the memory they need.

Runs as a program in a process of its own, since numba fixes processor and optimisation when it is imported:

    python -P -m comprope.native.llvm_ir rope|drive|sizes OUT [EFFECT.py ...]

EFFECT.py are files of a user's own effects, in the order in which they were first run.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import CompropeError

PREFIX = "comprope_"
# Entry points that a program without Python calls, of the `entry_points.ENTRIES` of each component.
CALLED = {
    "rope": (
        "generate_mesh", "check_mesh", "check_reach", "check_start", "start_at_rest", "start_inputs", "check_motion",
        "interpolate_inputs", "advance", "evaluate_outputs",
    ),
    "drive": ("count_points", "design_drive", "check", "start_at_rest", "advance_drive", "evaluate_drive"),
}  # fmt: skip
_PLAIN = {"PYTHONHASHSEED": "0", "NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": "", "NUMBA_OPT": "0"}
_NODES = (40, 41, 50)
# Of the C library: real functions of real numbers, and what compilers themselves call.
_C_LIBRARY = {
    "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "ceil", "copysign", "cos", "cosh", "erf", "erfc", "exp",
    "exp2", "expm1", "fabs", "floor", "fmax", "fmin", "fmod", "hypot", "lgamma", "log", "log10", "log1p", "log2", "memcpy",
    "memmove", "memset", "pow", "rint", "round", "sin", "sinh", "sqrt", "tan", "tanh", "tgamma", "trunc",
}  # fmt: skip


def kernels(component: str, files: Mapping[str, str]) -> str:
    """The code of all kernels in CALLED of rope or drive, each under its name behind PREFIX, in one module.

    Nothing else is visible. `files` has the sources of a user's own effects by path; comprope's own are always in.
    """
    return _apart(component, files, _PLAIN)


def rope_sizes(files: Mapping[str, str]) -> dict[int, dict[str, int]]:
    """For some numbers of nodes, how many numbers each array of a rope has, by group and name as in `entry_points.TABLES`."""
    found = json.loads(_apart("sizes", files, {"COMPROPE_PURE_PYTHON": "1"}))
    return {int(nodes): arrays for nodes, arrays in found.items()}


def _apart(what: str, files: Mapping[str, str], settings: dict[str, str]) -> str:
    """What this program writes when it runs apart; files are given as they were run, whatever has become of them."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        copies = [Path(folder) / f"{k}_{Path(path).name}" for k, path in enumerate(files)]
        for copy, text in zip(copies, files.values(), strict=True):
            copy.write_text(text, encoding="utf-8")
        command = [sys.executable, "-P", "-m", __name__, what, str(out), *map(str, copies)]
        environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[2]), "COMPROPE_CACHE": folder}
        environment.pop("COMPROPE_PURE_PYTHON", None)
        result = subprocess.run(command, env=environment | settings, capture_output=True, text=True, check=False)
        if result.returncode:
            raise CompropeError(f"the kernels cannot be compiled: {(result.stderr.strip().splitlines() or ['no message'])[-1]}")
        return out.read_text("utf-8")


def _code(component: str) -> str:
    import llvmlite.binding as llvm
    import numba

    from ..kernels.jit import OPTIONS

    whole: Any = llvm.parse_assembly("")
    for name, entry in _entries(component).items():
        options: Any = OPTIONS | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
        function: Any = numba.njit(entry.signature, **options)(entry.function)
        (made,) = function.overloads.values()
        module = llvm.parse_assembly(function.inspect_llvm(made.signature.args))
        module.get_function(made.fndesc.llvm_func_name).name = PREFIX + name
        whole.link_in(module)
    _hide_all_but_entries(whole)
    require_no_python(whole)
    # Addresses of numba's own objects in this process, which the code never follows.
    return re.sub(r"inttoptr \(i64 \d+ to ptr\)", "null", str(whole))


def _entries(component: str) -> dict[str, Any]:
    from ..drive.kernels import entry_points as drive
    from ..rope.compiler import entry_points as rope

    compiled = {"rope": rope, "drive": drive}[component].compiled()
    return {name: compiled[name] for name in CALLED[component]}


def _hide_all_but_entries(module: Any) -> None:
    """Drop what no entry needs, and name the rest by its place: numba's names hold hashes of all sources, and addresses."""
    import llvmlite.binding as llvm

    for value in (*module.functions, *module.global_variables):
        if not value.is_declaration and not value.name.startswith(PREFIX):
            value.linkage = "internal"
    passes = llvm.create_new_module_pass_manager()
    passes.add_global_dead_code_eliminate_pass()
    machine = llvm.Target.from_default_triple().create_target_machine()
    passes.run(module, llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options()))
    hidden = [one for one in (*module.functions, *module.global_variables) if one.linkage is llvm.Linkage.internal]
    for place, value in enumerate(hidden):
        value.name = f"kernel{place}"


def require_no_python(module: Any) -> None:
    """Raise `CompropeError` if an LLVM module calls more than the C library has."""
    called = {one.name for one in module.functions if one.is_declaration and not one.name.startswith("llvm.")}
    if foreign := sorted(called - _C_LIBRARY):
        raise CompropeError(f"they call {', '.join(foreign)}, which only Python has; kernels may not allocate, slice or print")


def _sizes() -> str:
    import numpy as np

    from ..kernels.entry_source import flattened
    from ..rope.compiler.workspace import RopeWorkspace
    from ..rope.parameters.parameter_vector import DECLARED

    ropes = {n: flattened(*RopeWorkspace(n, np.zeros(len(DECLARED))).groups) for n in _NODES}
    return json.dumps({n: {name: np.size(array) for name, array in fields.items()} for n, fields in ropes.items()})


if __name__ == "__main__":
    from ..rope.effects import user_effects

    for one in sys.argv[3:]:
        user_effects.load_file(Path(one), allow_code=True)
    wanted = sys.argv[1]
    Path(sys.argv[2]).write_text(_sizes() if wanted == "sizes" else _code(wanted), encoding="utf-8")
