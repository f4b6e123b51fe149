"""The kernels as LLVM's intermediate code, for no processor in particular, and the memory they need.

Runs as a program in a process of its own, since numba fixes processor and optimisation when it is imported:

    python -m comprope.native.ir code|sizes OUT [EFFECT.py ...]

EFFECT.py are files of effects that register themselves, in the order in which they were registered.
"""

import importlib.util
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ..errors import CompropeError

PREFIX = "comprope_"
# What a program without Python calls, of `compose.ENTRIES`.
CALLED = ("divide", "coarse", "reach", "settle", "begin_motion", "lead", "travel", "show")
_PLAIN = {"PYTHONHASHSEED": "0", "NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": "", "NUMBA_OPT": "0"}
_NODES = (40, 41, 50)


def kernels(effects: Sequence[Path] = ()) -> str:
    """The code of all kernels in CALLED, each under its name behind PREFIX, in one module; nothing else is visible."""
    return _apart("code", effects, _PLAIN)


def sizes(effects: Sequence[Path] = ()) -> dict[int, dict[str, int]]:
    """For some numbers of nodes, how many numbers each array of a rope has, by the arrays' names in the kernels."""
    found = json.loads(_apart("sizes", effects, {"COMPROPE_PURE_PYTHON": "1"}))
    return {int(nodes): arrays for nodes, arrays in found.items()}


def _apart(what: str, effects: Sequence[Path], settings: dict[str, str]) -> str:
    """What this program writes when it runs apart."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        command = [sys.executable, "-m", __name__, what, str(out), *map(str, effects)]
        environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[2]), "COMPROPE_CACHE": folder}
        environment.pop("COMPROPE_PURE_PYTHON", None)
        result = subprocess.run(command, env=environment | settings, capture_output=True, text=True, check=False)
        if result.returncode:
            raise CompropeError(f"the kernels cannot be compiled: {(result.stderr.strip().splitlines() or ['no message'])[-1]}")
        return out.read_text("utf-8")


def _register(path: Path) -> None:
    """Run a file of effects under a name of its own."""
    spec = importlib.util.spec_from_file_location(f"comprope_effect_{path.stem}", path)
    if spec is None or spec.loader is None:
        raise CompropeError(f"{path}: not a Python file")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)


def _code() -> str:
    import llvmlite.binding as llvm
    import numba

    from ..rope.compose import compiled
    from ..rope.jit import OPTIONS

    whole: Any = llvm.parse_assembly("")
    for name in CALLED:
        entry = compiled()[name]
        options: Any = OPTIONS | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
        function: Any = numba.njit(entry.signature, **options)(entry.function)
        (made,) = function.overloads.values()
        module = llvm.parse_assembly(function.inspect_llvm(made.signature.args))
        module.get_function(made.fndesc.llvm_func_name).name = PREFIX + name
        whole.link_in(module)
    for value in (*whole.functions, *whole.global_variables):
        if not value.is_declaration and not value.name.startswith(PREFIX):
            value.linkage = "internal"
    return str(whole)


def _sizes() -> str:
    import numpy as np

    from ..rope.bound import Bound
    from ..rope.slots import DECLARED

    ropes = {n: Bound(n, np.zeros(len(DECLARED))).moving for n in _NODES}
    return json.dumps({n: {name: array.size for name, array in arrays.items()} for n, arrays in ropes.items()})


if __name__ == "__main__":
    from ..rope import effects as _builtin  # noqa: F401 -- they come first

    for one in sys.argv[3:]:
        _register(Path(one))
    Path(sys.argv[2]).write_text({"code": _code, "sizes": _sizes}[sys.argv[1]](), encoding="utf-8")
