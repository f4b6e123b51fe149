"""A hanging rope with a free mass in MoorDyn 2.7.2; run by hanging_peers.py with an interpreter that has moordyn.

    python moordyn_hanging.py '{"elements": 1000, "step": 2e-5, ...}'        prints one line of JSON

Explicit, so its step is bound by the waves along an element. z is up; without water, its forces are nil.
"""

import json
import sys
import tempfile
import time
from math import pi, sin
from pathlib import Path

import moordyn

INPUT = """MoorDyn: hanging rope
---------------------- LINE TYPES -----------------------------------
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
rope 0.012 {mass_per_length} {axial_stiffness} 0 {bending_stiffness} 0 0 0 0
---------------------- POINTS -----------------------------------
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Coupled 0 0 0 0 0 0 0
2 Free 0 0 {bottom:.9f} {mass} 0 0 0
---------------------- LINES -----------------------------------
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (#) (#) (m) (-) (-)
1 rope 1 2 {length} {elements} -
---------------------- OPTIONS -----------------------------------
0 writeLog
{step} dtM
RK4 tScheme
{gravity} g
1e-9 WtrDnsty
200 WtrDpth
1e5 kBot
1e3 cBot
0.001 dtIC
0.0 TmaxIC
0.01 threshIC
------------------------- need this line --------------------------------------
"""


def create(case, folder):
    """The system, its rope stretched by its weight and the mass; its files go into `folder`."""
    force = case["mass"] * case["gravity"] + 0.5 * case["mass_per_length"] * case["gravity"] * case["length"]
    bottom = -case["length"] * (1.0 + force / case["axial_stiffness"])
    file = Path(folder) / "rope.txt"
    file.write_text(INPUT.format(**case, bottom=bottom))
    system = moordyn.Create(str(file))
    moordyn.SetVerbosity(system, moordyn.LEVEL_ERR)
    return system


def main(case, folder):
    """Simulate, and print series and processor time."""
    system, w, size, every = create(case, folder), 2.0 * pi * case["frequency"], case["amplitude"], 1e-3
    moordyn.Init(system, [0.0, 0.0, 0.0], [size * w, 0.0, 0.0])
    rope, rows = moordyn.GetLine(system, 1), []
    begin = time.process_time()
    for k in range(round(case["until"] / every)):
        if k % round(case["every"] / every) == 0:
            rows.append((k * every, *(moordyn.GetLineNodePos(rope, i)[0] for i in (case["elements"] // 2, case["elements"]))))
        here, there = (size * sin(w * every * one) for one in (k, k + 1))
        moordyn.Step(system, [here, 0.0, 0.0], [(there - here) / every, 0.0, 0.0], k * every, every)
    spent = time.process_time() - begin
    moordyn.Close(system)
    columns = zip(("time", "middle", "bottom"), map(list, zip(*rows, strict=True)), strict=True)
    print("\n" + json.dumps(dict(columns) | {"cpu_per_second": spent / case["until"]}))


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as own:
        main(json.loads(sys.argv[1]), own)
