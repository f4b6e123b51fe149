"""The whole problem, rope round a free sheave, beside exudyn at equal mesh and step.

    python benchmarks/exudyn_b.py --peer PEER/bin/python [--until 3]

PEER is an environment of its own with `pip install exudyn==1.13.6`. A 50 m trip from 2 m above the sheave:
1099 elements of 5 cm, 1 ms. Compare tensions and angle; the lateral shape that exudyn settles in is its own.
"""

import argparse
import json
import subprocess
from pathlib import Path

import numpy as np
from cases import COMMUNICATION, path, ride

from comprope.drive.parameters import Profile
from comprope.drive.trajectory.s_curve import SCurve, plan_s_curve
from comprope.rope.model_file import RopeModel, validated
from comprope.rope.simulator.rope import CompensationRope

RADIUS, ELEMENTS, STEP = 0.306, 1099, 0.001
CONTACT = {"stiffness": 4e7, "damping": 1e4, "friction_coefficient": 0.3, "slip_velocity": 0.02}


def problem(step: float | None = STEP) -> RopeModel:
    """The rope of the problem in our terms; 1099 elements of 5 cm; with the default step if None is given."""
    rope = {"mass_per_length": 1.2, "diameter": 0.012, "axial_stiffness": 1e7, "bending_stiffness": 20.0}
    table = {
        "shaft": {"height": 50.0, "pit": 2.0},
        "rope": rope | {"axial_damping": 2e3, "bending_damping": 0.02},
        "sheave": {"mass": 300.0, "radius": RADIUS, "inertia": 13.5},
        "contact": CONTACT,
        "solver": {"step": step} if step else {},
    }
    return validated(table, "problem")


def phases(trip: SCurve) -> list[tuple[float, float, float, float, float]]:
    """The trip as phases of constant jerk: start, way, velocity, acceleration, jerk."""
    lengths, found, t = (trip.ramp, trip.plateau, trip.ramp, trip.cruise, trip.ramp, trip.plateau, trip.ramp), [], trip.start_time
    for length in lengths:
        begin, middle = trip.at(t), trip.at(t + 0.5 * length)
        found.append((t, begin.position - trip.origin, begin.velocity, begin.acceleration, middle.jerk))
        t += length
    return found


def peer(interpreter: str, model: RopeModel, trip: SCurve, until: float) -> dict[str, float]:
    """The same problem in exudyn."""
    case = {
        "radius": RADIUS, "nodes": ELEMENTS + 1, "element": model.rope_length / ELEMENTS, "step": STEP, "until": until,
        "car": 2.0, "counterweight": 52.0, "gravity": model.shaft.gravity, "phases": phases(trip), "friction": 0.3,
        "sheave_mass": model.sheave.mass, "sheave_inertia": model.sheave.inertia,
        "contact_stiffness": CONTACT["stiffness"], "contact_damping": CONTACT["damping"],
        "mass_per_length": model.rope.mass_per_length, "bending_stiffness": model.rope.bending_stiffness,
        "axial_stiffness": model.rope.axial_stiffness, "bending_damping": model.rope.bending_damping,
        "axial_damping": model.rope.axial_damping,
    }  # fmt: skip
    script = Path(__file__).with_name("exudyn_rope.py")
    done = subprocess.run([interpreter, script, json.dumps(case)], check=True, capture_output=True, text=True)
    return json.loads(done.stdout.splitlines()[-1])


def ours(model: RopeModel, trip: SCurve, until: float) -> dict[str, float]:
    """Mean tensions and the sheave's final angle of our rope, read every communication step."""
    rope, rows = CompensationRope(model), []
    rope.solve_equilibrium(trip.origin, model.shaft.height - trip.origin)
    for k in range(round(until / COMMUNICATION)):
        rope.step(COMMUNICATION, path(model, trip, k * COMMUNICATION, (k + 1) * COMMUNICATION))
        rows.append(rope.outputs())
    means = {f"{end}_tension": float(np.mean([row[f"{end}_end_tension"] for row in rows])) for end in ("car", "counterweight")}
    return means | {"angle": rows[-1]["sheave_angle"]}


def main() -> None:
    """Print both side by side."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peer", required=True, help="Python interpreter that has exudyn 1.13.6")
    parser.add_argument("--until", type=float, default=3.0, help="seconds to simulate")
    options = parser.parse_args()
    model, trip = problem(), plan_s_curve(Profile(), 0.0, 50.0, 0.0)
    cost, longer = (
        min((ride(one, trip, options.until)[1] for _ in range(3)), key=lambda one: one.cpu) for one in (model, problem(None))
    )
    mine = ours(model, trip, options.until)
    other = peer(options.peer, model, trip, options.until)
    way = trip.at(options.until).position
    print(f"{'':24}{'comprope':>12}{'exudyn':>12}")
    rows = [
        ("elements", cost.nodes - 1, other["elements"]),
        ("CPU s per simulated s", cost.per_second, other["cpu"] / options.until),
        ("car's end, mean N", mine["car_tension"], other["car_tension"]),
        ("counterweight's end, N", mine["counterweight_tension"], other["counterweight_tension"]),
        ("sheave's angle, rad", mine["angle"], abs(other["angle"])),
        ("travel over radius, rad", way / RADIUS, way / RADIUS),
    ]
    for name, left, right in rows:
        print(f"{name:24}{left:12.5g}{right:12.5g}")
    for what, own in (("equal step", cost), ("our default step", longer)):
        print(f"ratio of CPU times, {what}: {other['cpu'] / options.until / own.per_second:.0f}")


if __name__ == "__main__":
    main()
