"""The reference result kept inside an FMU: inputs and outputs of a short simulation."""

from collections.abc import Iterable, Sequence

from .instance import Instance
from .model_interface import ModelInterface

INPUT_FILE, OUTPUT_FILE = "resources/reference_in.csv", "resources/reference_out.csv"
DURATION, OUTPUT_INTERVAL = 4.0, 0.05  # s, of the simulation, and between rows of results


def reference_result(interface: ModelInterface) -> dict[str, bytes]:
    """Files by path in the FMU: real outputs every 50 ms, and the inputs that change, for every communication step."""
    instance, places = Instance(interface), {one.name: place for place, one in enumerate(interface.variables)}
    moved = list(interface.reference_inputs(0.0))
    outputs = [one.name for one in interface.of_role("output") if one.kind == "real"]
    given, found, dt = [], [], interface.step_size
    for count in range(round(DURATION / dt) + 1):
        time = count * dt
        values = list(interface.reference_inputs(time).values())
        instance.set_values("real", [places[name] for name in moved], values)
        if count == 0:
            instance.exit_initialization()
        given.append([time, *values])
        if count % round(OUTPUT_INTERVAL / dt) == 0:
            found.append([time, *instance.get_values("real", [places[name] for name in outputs])])
        instance.do_step(time, dt)
    # Accelerations are second differences of positions, so inputs keep every digit. Nine digits suffice for results:
    # differences between the systems' sines and cosines are smaller.
    inputs = {INPUT_FILE: _table(moved, given, ".17g")} if moved else {}
    return inputs | {OUTPUT_FILE: _table(outputs, found, ".9g")}


def _table(names: Sequence[str], rows: Iterable[Sequence[object]], form: str) -> bytes:
    lines = [",".join(["time", *names]), *(",".join(format(value, form) for value in row) for row in rows)]
    return ("\n".join(lines) + "\n").encode()
