"""A result to compare with, kept inside the FMU: a short trip of the rope's ends, and what the model gives for it."""

import math
from collections.abc import Iterable, Sequence

from ..fmi.engine import ModelInterface
from ..fmi.run import Run

IN, OUT = "resources/reference_in.csv", "resources/reference_out.csv"
DURATION, RISE = 4.0, 2.0  # s, m
_EVERY = 5  # communication steps from one row of results to the next


def reference(interface: ModelInterface) -> dict[str, bytes]:
    """The two files by their path in the FMU: inputs for every communication step of the model, outputs for every fifth."""
    run, places = Run(interface), {one.name: place for place, one in enumerate(interface.variables)}
    ends = [places[name] for name in ("car_position", "counterweight_position")]
    outputs = [one.name for one in interface.of_role("output") if one.kind == "real"]
    bottom, top = (float(value) for value in run.read("real", ends))
    given, found = [], []
    for count in range(round(DURATION / interface.step_size) + 1):
        time = count * interface.step_size
        positions = (bottom + rise(time), top - rise(time))
        run.write("real", ends, positions)
        if count == 0:
            run.begin()
        given.append([time, *positions])
        if count % _EVERY == 0:
            found.append([time, *run.read("real", [places[name] for name in outputs])])
        run.step(time, interface.step_size)
    # Accelerations are second differences of positions, so these keep every digit. Nine are enough for results: what
    # other systems' sines and cosines may change lies behind them.
    return {IN: _table(["car_position", "counterweight_position"], given, ".17g"), OUT: _table(outputs, found, ".9g")}


def rise(time: float) -> float:
    """Height [m] above the start: half a cosine, from rest to rest."""
    return 0.5 * RISE * (1.0 - math.cos(math.pi * min(time / DURATION, 1.0)))


def _table(names: Sequence[str], rows: Iterable[Sequence[object]], form: str) -> bytes:
    lines = [",".join(["time", *names]), *(",".join(format(value, form) for value in row) for row in rows)]
    return ("\n".join(lines) + "\n").encode()
