"""A hanging rope with a free mass (no sheave) beside exudyn, MoorDyn and the stored series of a third program, in one run.

    python benchmarks/hanging_peers.py --peer PEER/bin/python [--until 4]

PEER is an environment of its own with `pip install exudyn==1.13.6 moordyn==2.7.2`. 50 m, 1.2 kg/m, EA 1e7 N, EI 20 N m2,
60 kg free at the lower end; the upper end moves by 0.05 sin(2 pi 0.2 t) m. Processor time is of one thread.

MoorDyn starts with its nodes evenly spread, not stretched more where more hangs below: its rope rings along itself, which the
tension tells the lateral waves. So it is compared with this project's kernels from the same start, at steps that resolve that.
"""

import argparse
import json
import subprocess
import sys
import time
from dataclasses import asdict
from pathlib import Path

import numpy as np

from comprope_system.studies.verification.free_rope import FreeRope, Hanging, lead_sine, swing_sideways
from comprope_system.studies.verification.reference import reference, rms

EVERY = 0.05  # s
FINE = 2e-4  # s, a step that resolves waves along the rope
PEERS = (
    ("exudyn", "exudyn_hanging.py", 1000, 1e-3),
    ("exudyn", "exudyn_hanging.py", 100, 2e-3),
    ("moordyn", "moordyn_hanging.py", 1000, 2e-5),
)


def peer(interpreter: str, script: str, elements: int, step: float, until: float) -> dict:
    """Series and cost of another program."""
    case = asdict(Hanging(elements)) | {"amplitude": 0.05, "frequency": 0.2, "step": step, "until": until, "every": EVERY}
    command = [interpreter, str(Path(__file__).with_name(script)), json.dumps(case)]
    found = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return json.loads(found.splitlines()[-1])


def ours(elements: int, step: float, until: float) -> dict:
    """The same with this project's kernels."""
    swing_sideways(Hanging(elements), step, step, step)
    begin = time.process_time()
    series = swing_sideways(Hanging(elements), step, until, EVERY)
    spent = time.process_time() - begin
    return dict(zip(("time", "middle", "bottom"), series, strict=True)) | {"cpu_per_second": spent / until}


def evenly(elements: int, step: float, until: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Series from a start with nodes evenly spread."""
    rope = Hanging(elements)
    moving, middle = FreeRope(rope, lead_sine), elements // 2
    moving.q[: moving.n] = np.linspace(0.0, moving.q[moving.n - 1], moving.n)
    rows = [(0.0, 0.0, 0.0)]
    for k in range(1, round(until / step) + 1):
        moving.step(k * step, step)
        if k % round(EVERY / step) == 0:
            rows.append((k * step, moving.q[moving.n + 1 + middle], moving.q[moving.n + 1 + elements]))
    return tuple(np.array(rows).T)


def line(name: str, elements: int, step: float, found: dict, until: float, beside: tuple | None = None) -> str:
    """One row: cost, and differences from the third program's series, or from another."""
    when, middle, bottom = (values[(beside or reference())[0] <= until - EVERY] for values in beside or reference())
    a, b = (
        1e3 * rms(np.interp(when, found["time"], found[key]) - own) for key, own in (("middle", middle), ("bottom", bottom))
    )
    return f"{name:9} {elements:5} {1e3 * step:7.3f} ms {found['cpu_per_second']:8.3f} CPU s/s   {a:.4f} mm {b:.5f} mm"


def main() -> None:
    """Run all and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peer", default=sys.executable)
    parser.add_argument("--until", type=float, default=4.0)
    chosen = parser.parse_args()
    print("program, elements, step, cost, rms difference of middle and lower end from the stored series")
    for elements, step in ((1000, 1e-3), (250, 1e-3)):
        print(line("comprope", elements, step, ours(elements, step, chosen.until), chosen.until), flush=True)
    for name, script, elements, step in PEERS:
        beside = evenly(elements, FINE, chosen.until) if name == "moordyn" else None
        found = peer(chosen.peer, script, elements, step, chosen.until)
        print(line(name, elements, step, found, chosen.until, beside), flush=True)


if __name__ == "__main__":
    main()
