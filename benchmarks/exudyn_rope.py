"""A rope round a free sheave in exudyn 1.13.6; run by exudyn_b.py with an interpreter that has exudyn.

    python exudyn_rope.py '{"radius": 0.3, ...}'        prints one line of JSON

ANCF cable elements hang over a rigid body that may rise and turn. A static solution without friction gives
the start; then the rope's ends follow the trip. x is lateral, y up, the origin is the axle as built.
"""

import json
import sys
import time

sys.exudynFast = True
import exudyn as exu  # noqa: E402
from exudyn import beams, itemInterface  # noqa: E402

VARIABLE = exu.OutputVariableType
item = itemInterface


class Trip:
    """Way and velocity of a trip that is tabled as seven phases: (start time, way, velocity, acceleration, jerk)."""

    def __init__(self, phases):
        self.phases = phases

    def at(self, t):
        """Way and velocity at a time [s]."""
        start, s, v, a, j = next(phase for phase in reversed(self.phases) if phase[0] <= t or phase is self.phases[0])
        t -= start
        return s + t * (v + t * (a / 2.0 + t * j / 6.0)), v + t * (a + t * j / 2.0)


def cable(case):
    """Element of the rope: strain counts from the natural length, so that it hangs stretched."""
    mean = (0.5 * case["sheave_mass"] + 25.0 * case["mass_per_length"]) * case["gravity"]
    return item.Cable2D(
        physicsMassPerLength=case["mass_per_length"],
        physicsBendingStiffness=case["bending_stiffness"],
        physicsAxialStiffness=case["axial_stiffness"],
        physicsBendingDamping=case["bending_damping"],
        physicsAxialDamping=case["axial_damping"],
        physicsReferenceAxialStrain=-mean / case["axial_stiffness"],
        useReducedOrderIntegration=2,
        strainIsRelativeToReference=0,
    )


def build(mbs, case):
    """The system; returns the elements of the rope, the sheave's node, the contacts, the lock and the driven ends."""
    r, g, mass = case["radius"], case["gravity"], case["sheave_mass"]
    stops = [[[-r, case["car"]], 1e-4, "R"], [[0.0, 0.0], r, "R"], [[r, case["counterweight"]], 1e-4, "R"]]
    curve = beams.CreateReevingCurve(
        stops, drawingLinesPerCircle=64, radialOffset=0.0, removeLastLine=False, numberOfANCFnodes=case["nodes"]
    )
    nodes, elements, *_ = beams.PointsAndSlopes2ANCFCable2D(
        mbs, curve["ancfPointsSlopes"], curve["elementLengths"], cable(case),
        massProportionalLoad=[0.0, -g, 0.0], firstNodeIsLastNode=False,
        fixedConstraintsNode0=[1, 0, 0, 0], fixedConstraintsNode1=[1, 0, 0, 0],
    )  # fmt: skip
    ground = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(item.NodePointGround()), coordinate=0))

    def tied(node, coordinate):
        marker = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
        return mbs.AddObject(item.CoordinateConstraint(markerNumbers=[ground, marker]))

    ends = [tied(node, 1) for node in (nodes[0], nodes[-1])]
    sheave = mbs.AddNode(item.NodeRigidBody2D())
    body = mbs.AddObject(item.ObjectRigidBody2D(physicsMass=mass, physicsInertia=case["sheave_inertia"], nodeNumber=sheave))
    tied(sheave, 0)
    mbs.AddLoad(item.Force(markerNumber=mbs.AddMarker(item.MarkerNodeRigid(nodeNumber=sheave)), loadVector=[0.0, -mass * g, 0.0]))
    lock = tied(sheave, 2)
    disc = mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=body))
    contacts = [touching(mbs, case, disc, element) for element in elements]
    return elements, sheave, contacts, lock, ends


def touching(mbs, case, disc, element):
    """Contact of one element with the groove, as one segment."""
    shape = mbs.AddMarker(item.MarkerBodyCable2DShape(bodyNumber=element, numberOfSegments=1))
    data = mbs.AddNode(item.NodeGenericData(initialCoordinates=[0.1, -2.0, 0.0], numberOfDataCoordinates=3))
    return mbs.AddObject(
        item.ObjectContactFrictionCircleCable2D(
            markerNumbers=[disc, shape],
            nodeNumber=data,
            numberOfContactSegments=1,
            contactStiffness=case["contact_stiffness"] * case["element"],
            contactDamping=case["contact_damping"] * case["element"],
            frictionVelocityPenalty=500.0,
            frictionStiffness=1e-8,
            frictionCoefficient=0.0,
            circleRadius=case["radius"],
        )
    )


def hang(mbs, settings):
    """Solve for the shape at rest, the weight coming on in geometric load steps."""
    solver = settings.staticSolver
    solver.adaptiveStep, solver.numberOfLoadSteps, solver.verboseMode = False, 20, 0
    solver.loadStepGeometric, solver.loadStepGeometricRange, solver.stabilizerODE2term = True, 1e4, 1e4
    solver.newton.relativeTolerance, solver.newton.absoluteTolerance = 1e-6, 1e-4
    mbs.SolveStatic(settings, updateInitialValues=True)


def release(mbs, case, contacts, lock, ends):
    """Switch friction on, let the sheave turn, and drive the ends."""
    trip = Trip(case["phases"])
    for contact in contacts:
        mbs.SetObjectParameter(contact, "frictionCoefficient", case["friction"])
        mbs.SetObjectParameter(contact, "frictionStiffness", 1e5)
    mbs.SetObjectParameter(lock, "activeConnector", False)
    for end, sign in zip(ends, (1.0, -1.0), strict=True):
        mbs.SetObjectParameter(end, "offsetUserFunction", lambda mbs, t, i, offset, sign=sign: sign * trip.at(t)[0])
        mbs.SetObjectParameter(end, "offsetUserFunction_t", lambda mbs, t, i, offset, sign=sign: sign * trip.at(t)[1])


def march(mbs, settings, case):
    """Integrate with the implicit trapezoidal rule and a modified Newton method; returns processor seconds."""
    solver = settings.timeIntegration
    solver.endTime, solver.numberOfSteps, solver.verboseMode = case["until"], round(case["until"] / case["step"]), 0
    solver.newton.useModifiedNewton, solver.newton.relativeTolerance, solver.newton.absoluteTolerance = True, 1e-5, 1e-6
    solver.newton.maxIterations = 25
    solver.discontinuous.iterationTolerance, solver.discontinuous.maxIterations = 1e-2, 3
    solver.discontinuous.ignoreMaxIterations = True
    begin = time.process_time()
    mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.TrapezoidalIndex2)
    return time.process_time() - begin


def tension(mbs, element, length):
    """Sensor of the axial force in the middle of an element."""
    middle = [0.5 * length, 0.0, 0.0]
    force = item.SensorBody(bodyNumber=element, localPosition=middle, outputVariableType=VARIABLE.ForceLocal)
    force.storeInternal, force.writeToFile = True, False
    return mbs.AddSensor(force)


def main(case):
    """Hang, march, and print cost, mean tensions and the sheave's final place."""
    system = exu.SystemContainer()
    mbs = system.AddSystem()
    elements, sheave, contacts, lock, ends = build(mbs, case)
    tensions = [tension(mbs, one, case["element"]) for one in (elements[0], elements[-1])]
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.linearSolverType = exu.LinearSolverType.EigenSparse
    settings.parallel.numberOfThreads = 1
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = 0.02
    hang(mbs, settings)
    release(mbs, case, contacts, lock, ends)
    cpu = march(mbs, settings, case)
    place = mbs.GetNodeOutput(sheave, VARIABLE.Coordinates)
    car, counterweight = (float(mbs.GetSensorStoredData(one)[1:, 1].mean()) for one in tensions)
    result = {"cpu": cpu, "elements": len(elements), "car_tension": car, "counterweight_tension": counterweight}
    print(json.dumps(result | {"angle": float(place[2]), "height": float(place[1])}))


if __name__ == "__main__":
    main(json.loads(sys.argv[1]))
