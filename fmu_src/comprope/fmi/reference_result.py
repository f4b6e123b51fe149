"""A result to compare with, kept inside an FMU: a short run of the model, and what it gives."""

from collections.abc import Iterable, Sequence

from .instance import Instance
from .model_interface import ModelInterface

IN, OUT = "resources/reference_in.csv", "resources/reference_out.csv"
DURATION, EVERY = 4.0, 0.05  # s, of the run and from one row of results to the next


def reference(interface: ModelInterface) -> dict[str, bytes]:
    """Files by their path in the FMU: the real outputs every 50 ms, and inputs that move for every communication step."""
    instance, places = Instance(interface), {one.name: place for place, one in enumerate(interface.variables)}
    moved = list(interface.motion(0.0))
    outputs = [one.name for one in interface.of_role("output") if one.kind == "real"]
    given, found, dt = [], [], interface.step_size
    for count in range(round(DURATION / dt) + 1):
        time = count * dt
        values = list(interface.motion(time).values())
        instance.set_values("real", [places[name] for name in moved], values)
        if count == 0:
            instance.exit_initialization()
        given.append([time, *values])
        if count % round(EVERY / dt) == 0:
            found.append([time, *instance.get_values("real", [places[name] for name in outputs])])
        instance.do_step(time, dt)
    # Accelerations are second differences of positions, so inputs keep every digit. Nine are enough for results: what
    # other systems' sines and cosines may change lies behind them.
    inputs = {IN: _table(moved, given, ".17g")} if moved else {}
    return inputs | {OUT: _table(outputs, found, ".9g")}


def _table(names: Sequence[str], rows: Iterable[Sequence[object]], form: str) -> bytes:
    lines = [",".join(["time", *names]), *(",".join(format(value, form) for value in row) for row in rows)]
    return ("\n".join(lines) + "\n").encode()
