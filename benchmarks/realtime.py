"""Computing time of one communication step of 10 ms: median, 99.9th percentile and maximum, against its 10 ms budget.

    python benchmarks/realtime.py dist/CompensationRope_native.fmu dist/CompensationRope.fmu [--steps 3000]

Each FMU rides the rope of the 50 m tower and of the 200 m building up a trip, in this process, through fmpy: a step is
setting two positions, stepping and reading all real outputs. The model without an FMU around it comes last. Elapsed time
is what a real-time loop sees, here with whatever else runs on the machine; processor time is free of that.
"""

import argparse
import gc
import math
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

from comprope.fmi.instance import Instance
from comprope.fmi.model_interface import ModelInterface
from comprope.rope.model_file import load
from comprope.rope.simulator.cosimulation import interface
from comprope_system import presets

STEP = 0.01
SWITCHES = ("derivative_inputs", "inputs_at_end")
ENDS = ("car_position", "counterweight_position")
SPEEDS = {"tower50": 2.5, "building200": 5.0}  # m/s, at the middle of the trip
Ride = Callable[[float, Sequence[float]], None]


def through_fmu(path: str, model: ModelInterface, inputs: Sequence[str] = ENDS, dt: float = STEP) -> Ride:
    """One step of `dt` [s] of an FMU whose parameters are those of a model with as many sensors.

    Inputs are positions held over the step, or, if there are more, positions, velocities and accelerations at its end.
    """
    description = read_model_description(path)
    places = {one.name: one.valueReference for one in description.modelVariables}
    outputs = [one.valueReference for one in description.modelVariables if one.causality == "output" and one.type == "Real"]
    name = description.coSimulation.modelIdentifier
    slave = FMU2Slave(guid=description.guid, unzipDirectory=extract(path), modelIdentifier=name, instanceName="one")
    slave.instantiate()
    slave.setupExperiment(startTime=0.0)
    settable = [one for one in model.variables if one.role != "output" and one.kind == "real"]
    slave.setReal([places[one.name] for one in settable], [one.start for one in settable])
    slave.setBoolean([places[name] for name in SWITCHES], [len(inputs) > len(ENDS)] * len(SWITCHES))
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    given = [places[name] for name in inputs]

    def step(time: float, values: Sequence[float]) -> None:
        slave.setReal(given, values)
        slave.doStep(time, dt)
        slave.getReal(outputs)

    return step


def direct(model: ModelInterface, inputs: Sequence[str] = ENDS, dt: float = STEP) -> Ride:
    """One step of the model itself, as of `through_fmu`."""
    instance, places = Instance(model), {one.name: place for place, one in enumerate(model.variables)}
    given = [places[name] for name in inputs]
    outputs = [place for place, one in enumerate(model.variables) if one.role == "output" and one.kind == "real"]
    instance.set_values("boolean", [places[name] for name in SWITCHES], [len(inputs) > len(ENDS)] * len(SWITCHES))
    instance.exit_initialization()

    def step(time: float, values: Sequence[float]) -> None:
        instance.set_values("real", given, values)
        instance.do_step(time, dt)
        instance.get_values("real", outputs)

    return step


def durations(step: Ride, height: float, speed: float, steps: int) -> np.ndarray:
    """Elapsed and processor time of each step [s], one row each, along half a cosine up and down the shaft."""
    turn = math.pi * height / (2.0 * speed)  # s from landing to landing
    found = np.empty((2, steps))
    gc.disable()
    for count in range(steps):
        car = 0.5 * height * (1.0 - math.cos(math.pi * count * STEP / turn))
        begin, used = time.perf_counter(), time.thread_time()
        step(count * STEP, (car, height - car))
        found[:, count] = time.perf_counter() - begin, time.thread_time() - used
    gc.enable()
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fmus", nargs="*", metavar="FMU")
    parser.add_argument("--steps", type=int, default=3000)
    options = parser.parse_args()
    print("| rope | run by | time | median | 99.9th percentile | worst | faster than real time |\n|---|---|---|---|---|---|---|")
    for preset, speed in SPEEDS.items():
        model = interface(load(presets.model_path(preset)))
        height = next(float(one.start or 0.0) for one in model.variables if one.name == "shaft.height")
        rides = [(Path(path).stem, through_fmu(path, model)) for path in options.fmus] + [("directly", direct(model))]
        for name, step in rides:
            took = 1e3 * durations(step, height, speed, options.steps)
            for clock, one in zip(("elapsed", "processor"), took, strict=True):
                shown = " | ".join(f"{value:.2f} ms" for value in (np.median(one), np.quantile(one, 0.999), one.max()))
                print(f"| {preset} | {name} | {clock} | {shown} | {10.0 / one.mean():.0f} times |", flush=True)


if __name__ == "__main__":
    main()
