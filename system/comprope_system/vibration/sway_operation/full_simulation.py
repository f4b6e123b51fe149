"""The same swing by the full model: the ends sway by the effect `building_sway`."""

import numpy as np

from comprope.rope.effects import RopeModel
from comprope.rope.model_file import with_changes
from comprope.rope.simulator.rope import CompensationRope

from .parked_response import SIDES, STEP, Floats, Sway, building_share, side_nodes


def simulated_amplitudes(model: RopeModel, car: float, sway: Sway, period: float) -> Floats:
    """Largest displacement relative to the building [m] of car's and counterweight's side (2,), the car parked at `car` [m]."""
    values = {"amplitude": sway.amplitude, "frequency": 1.0 / period, "phase": 0.5 * np.pi}
    rope = CompensationRope(with_changes(model, {f"effects.building_sway.{name}": one for name, one in values.items()}))
    rope.solve_equilibrium(car, model.shaft.height - car)
    n, q = rope.n, rope.state.q
    rest, heights = _straight(rope, model), -np.asarray(q[:n]).copy()
    places, share = [side_nodes(heights, side) for side in SIDES], building_share(model, heights)
    path, largest = np.asarray(rope.workspace.ends.path).copy(), np.zeros(2)
    for k in range(round(sway.duration / STEP)):
        rope.step(STEP, path)
        moved = np.asarray(q[n + 1 : 2 * n + 1]) - rest
        moved -= share * sway.amplitude * np.cos(2.0 * np.pi * (k + 1) * STEP / period)
        largest = np.maximum(largest, [np.abs(moved[at]).max() for at in places])
    return largest


def _straight(rope: CompensationRope, model: RopeModel) -> Floats:
    """Lateral positions (n,) [m] of the nodes of a rope at rest in a building at rest."""
    still = CompensationRope(model)
    still.solve_equilibrium(-float(rope.state.q[0]), -float(rope.state.q[rope.n - 1]))
    return np.asarray(still.state.q[still.n + 1 : 2 * still.n + 1]).copy()
