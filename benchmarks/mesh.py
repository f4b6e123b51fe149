"""What the mesh leaves of error on a 12 m trip in the 50 m tower, wherever the nodes sit on the sheave.

    python benchmarks/mesh.py [--elements 0.05 0.04 ...] [--set KEY=VALUE ...]

Each element length against elements of 1 cm on the same trip, which starts a quarter of an element higher each
time: root-mean-square differences of what each sensor of the preset sees, of the sheave's height and of all sensors
together (lateral), from their values at rest before the trip, and the differences of these values at rest themselves.
"""

import argparse

import numpy as np
from cases import model, path, trip

from comprope.rope.simulator.rope import CompensationRope

FINEST, STEP, COMMUNICATION = 0.01, 0.002, 0.02  # m, s, s
ORIGIN, TRAVEL, UNTIL = 10.0, 12.0, 12.0  # m, m, s


def seen(element: float, origin: float, changes: dict[str, float]) -> np.ndarray:
    """What each sensor sees, then the sheave's height, in mm: (times, sensors + 1)."""
    chosen = model("tower50", rope__element_length=element, solver__step=STEP, **changes)
    rope, way = CompensationRope(chosen), trip("tower50", origin, origin + TRAVEL)
    rope.solve_equilibrium(origin, chosen.shaft.height - origin)
    rows = []
    for k in range(round(UNTIL / COMMUNICATION) + 1):
        shown = rope.all_outputs()
        rows.append([shown[f"lateral_displacement[{i}]"] for i in range(1, len(chosen.sensors) + 1)])
        rows[-1].append(shown["sheave_displacement"])
        rope.step(COMMUNICATION, path(chosen, way, k * COMMUNICATION, (k + 1) * COMMUNICATION))
    return 1e3 * np.array(rows)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elements", type=float, nargs="+", default=[0.05], help="element lengths [m]")
    parser.add_argument("--set", nargs="*", default=[], metavar="KEY=VALUE", help="values of the model to change")
    chosen = parser.parse_args()
    changes = {key.replace(".", "__"): float(value) for key, _, value in (one.partition("=") for one in chosen.set)}
    names = [sensor.name for sensor in model("tower50").sensors] + ["sheave"]
    print(f"{'rms about rest, um':>34}{'at rest, um':>56}")
    print(f"{'element':>8}{'shift':>6}" + "".join(f"{one:>9}" for one in [*names, "lateral", *names]))
    for element in chosen.elements:
        for shift in (0.0, 0.25, 0.5, 0.75):
            origin = ORIGIN + shift * element
            error = 1e3 * (seen(element, origin, changes) - seen(FINEST, origin, changes))
            about = np.sqrt(np.mean((error - error[0]) ** 2, axis=0))
            pooled = np.sqrt(np.mean(about[:-1] ** 2))
            print(f"{element:8.3f}{shift:6.2f}" + "".join(f"{one:9.1f}" for one in (*about, pooled, *error[0])))


if __name__ == "__main__":
    main()
