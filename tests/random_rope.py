"""A rope in a short shaft, bent and moving at random: what the tests of single kernels start from."""

import numpy as np

from comprope.quantities import quantities
from comprope.rope.compiler.workspace import RopeWorkspace
from comprope.rope.effects import REGISTRY

from .rope_tower import STUB, rope

TIME = 0.3  # s, of the states at random; an effect may depend on it
# What an effect needs beside itself to act at all.
COMPANIONS = {"shaft_airflow": {"effects.air_drag.drag_coefficient": 1.1}}


def nominal(effect: str) -> dict[str, float]:
    """Every quantity of an effect at its nominal value, with the effect's companions."""
    own = {f"effects.{effect}.{one.name}": one.nominal for one in quantities(REGISTRY[effect])}
    return own | COMPANIONS.get(effect, {})


def random_state(changes: dict[str, float], seed: int = 0) -> RopeWorkspace:
    """A rope in a short shaft, bent and moving at random, on a sheave that turns under it.

    Waves of 0.1 mm and a kink of a micrometre at each node keep part of the wrap in contact and part
    of it out; velocities of 0.2 m/s give every point of the wrap another slip. It is a rod, unless `changes` says otherwise:
    differences over 10 nm do not resolve how a segment loses its stiffness within 500 nm.
    """
    hung = rope({"rope.compression_ratio": 1.0} | changes, STUB)
    hung.solve_equilibrium(0.0, 1.0)
    do, n, m, random = RopeWorkspace(hung.n, hung.p), hung.n, hung.n + 1, np.random.default_rng(seed)
    do.state.from_bytes(hung.state.to_bytes())
    waves = np.sin(np.outer(np.arange(1, 6), np.linspace(0.0, np.pi, n)))
    for at in (0, m):
        do.state.q[at : at + n] += 1e-4 * random.normal(size=5) @ waves + 1e-6 * random.normal(size=n)
    do.state.q[m + n] = 0.3
    do.state.v[:] = 0.2 * random.normal(size=2 * m)
    do.state.v[m + n] = 0.5
    do.state.history[:] += 0.05 * random.normal(size=do.state.history.size)
    return do


def forces(do: RopeWorkspace, ck: float = 0.0, cc: float = 0.0, tangent: bool = False) -> np.ndarray:
    do.forces(t=TIME, ck=ck, cc=cc, tangent=tangent)
    return do.work.f.copy()
