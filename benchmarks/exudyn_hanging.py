"""A hanging rope with a free mass in exudyn 1.13.6; run by hanging_peers.py with an interpreter that has exudyn.

    python exudyn_hanging.py '{"elements": 1000, "step": 1e-3, ...}'        prints one line of JSON

ANCF cable elements along -y, stretched at the start by their own weight and the mass; the upper end is led sideways.
"""

import json
import sys
import time
from math import cos, pi, sin

sys.exudynFast = True
import exudyn as exu  # noqa: E402
from exudyn import beams, itemInterface  # noqa: E402

item = itemInterface


def build(mbs, case):
    """The rope with its mass; returns the sensors of its middle and its lower end."""
    count, length, weight = case["elements"], case["length"], case["mass_per_length"] * case["gravity"]
    element = item.Cable2D(
        physicsMassPerLength=case["mass_per_length"],
        physicsBendingStiffness=case["bending_stiffness"],
        physicsAxialStiffness=case["axial_stiffness"],
        useReducedOrderIntegration=2,
    )
    nodes = beams.GenerateStraightLineANCFCable2D(
        mbs, [0, 0, 0], [0, -length, 0], count, element, massProportionalLoad=[0, -case["gravity"], 0],
        fixedConstraintsNode0=[0, 0, 0, 0], fixedConstraintsNode1=[0, 0, 0, 0],
    )[0]  # fmt: skip
    for i, node in enumerate(nodes):
        s = length * i / count
        tension = case["mass"] * case["gravity"] + weight * (length - s)
        sag = (case["mass"] * case["gravity"] * s + weight * (length * s - 0.5 * s * s)) / case["axial_stiffness"]
        mbs.SetNodeParameter(node, "initialCoordinates", [0, -sag, 0, -tension / case["axial_stiffness"]])
    lead(mbs, nodes[0], case)
    body = mbs.AddNode(item.NodePoint2D(referenceCoordinates=[0, -length], initialCoordinates=[0, -sag]))
    mbs.AddObject(item.ObjectMassPoint2D(physicsMass=case["mass"], nodeNumber=body))
    marker = mbs.AddMarker(item.MarkerNodePosition(nodeNumber=body))
    mbs.AddLoad(item.LoadForceVector(markerNumber=marker, loadVector=[0, -case["mass"] * case["gravity"], 0]))
    for c in (0, 1):
        pair = [mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=one, coordinate=c)) for one in (body, nodes[-1])]
        mbs.AddObject(item.ObjectConnectorCoordinate(markerNumbers=pair))
    return [sensor(mbs, node) for node in (nodes[count // 2], nodes[-1])]


def sensor(mbs, node):
    """A sensor of a node's displacement."""
    kept = {"storeInternal": True, "writeToFile": False, "outputVariableType": exu.OutputVariableType.Displacement}
    return mbs.AddSensor(item.SensorNode(nodeNumber=node, **kept))


def lead(mbs, node, case):
    """Hold the upper end, and lead it sideways."""
    ground = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(item.NodePointGround()), coordinate=0))
    x, y = (mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=c)) for c in (0, 1))
    w, size = 2.0 * pi * case["frequency"], case["amplitude"]
    led = mbs.AddObject(item.ObjectConnectorCoordinate(markerNumbers=[ground, x]))
    mbs.SetObjectParameter(led, "offsetUserFunction", lambda mbs, t, number, offset: size * sin(w * t))
    mbs.SetObjectParameter(led, "offsetUserFunction_t", lambda mbs, t, number, offset: size * w * cos(w * t))
    mbs.AddObject(item.ObjectConnectorCoordinate(markerNumbers=[ground, y]))


def settings(case):
    """Trapezoidal rule of index 2, modified Newton."""
    found = exu.SimulationSettings()
    found.linearSolverType = exu.LinearSolverType.EigenSparse
    found.parallel.numberOfThreads = 1
    found.solutionSettings.writeSolutionToFile = False
    found.solutionSettings.sensorsWritePeriod = case["every"]
    found.timeIntegration.endTime = case["until"]
    found.timeIntegration.numberOfSteps = round(case["until"] / case["step"])
    found.timeIntegration.newton.useModifiedNewton = True
    found.timeIntegration.newton.relativeTolerance = 1e-5
    found.timeIntegration.verboseMode = 0
    return found


def main(case):
    """Simulate, and print series and processor time."""
    system = exu.SystemContainer()
    mbs = system.AddSystem()
    sensors = build(mbs, case)
    mbs.Assemble()
    begin = time.process_time()
    mbs.SolveDynamic(settings(case), solverType=exu.DynamicSolverType.TrapezoidalIndex2)
    spent = time.process_time() - begin
    middle, bottom = (mbs.GetSensorStoredData(one) for one in sensors)
    series = {"time": middle[:, 0].tolist(), "middle": middle[:, 1].tolist(), "bottom": bottom[:, 1].tolist()}
    print(json.dumps(series | {"cpu_per_second": spent / case["until"]}))


if __name__ == "__main__":
    main(json.loads(sys.argv[1]))
