"""The yardstick for one Newton iteration: microseconds of the bordered band solution in plain C (see limit.c)."""

import ctypes
import subprocess
import tempfile
from functools import cache
from pathlib import Path

import numpy as np
from scipy.linalg import solveh_banded

SOURCE = Path(__file__).with_name("limit.c")
WIDTH, SIDES = 5, 3


@cache
def compiled() -> ctypes.CDLL:
    """limit.c, compiled for this processor."""
    library = Path(tempfile.mkdtemp()) / "limit.so"
    subprocess.run(["gcc", "-O3", "-march=native", "-ffast-math", "-shared", "-fPIC", "-o", library, SOURCE], check=True)
    loaded = ctypes.CDLL(str(library))
    loaded.limit.restype = ctypes.c_double
    return loaded


def random_band(n: int, random: np.random.Generator) -> np.ndarray:
    """Rows of a positive definite band, a[i, k] = A(i, i - k), and rows of the identity behind them."""
    a = np.zeros((n + WIDTH, WIDTH + 1))
    a[:, 0] = 1.0
    a[:n, 0] = 12.0
    for k in range(1, WIDTH + 1):
        a[k:n, k] = random.normal(size=n - k)
    return a


def microseconds(nodes: int, repeats: int = 200) -> float:
    """Shortest time of factor, three right-hand sides and Schur complement for `nodes` nodes [us].

    Raises RuntimeError if the border's columns are not solved to 1e-9, which would make the time worthless.
    """
    n, random = 2 * nodes, np.random.default_rng(0)
    a, right, columns = random_band(n, random), np.zeros((n + WIDTH, SIDES)), random.normal(size=(n, 2))
    right[:n] = random.normal(size=(n, SIDES))
    factor, solution = np.zeros_like(a), np.zeros_like(right)
    arrays = (ctypes.c_void_p(one.ctypes.data) for one in (a, factor, solution, right, columns))
    shortest = compiled().limit(ctypes.c_long(n), *arrays, ctypes.c_long(repeats))
    lower = np.array([np.append(a[k:n, k], np.zeros(k)) for k in range(WIDTH + 1)])
    expected = solveh_banded(lower, right[:n, 1:], lower=True)
    if abs(solution[:n, 1:] - expected).max() > 1e-9 * abs(expected).max():
        raise RuntimeError("limit.c does not solve the band")
    return float(shortest)
