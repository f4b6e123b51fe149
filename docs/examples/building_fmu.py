"""A building as an FMU: two modes of a shear beam, driven by a record of the ground's acceleration.

Made with pythonfmu, which needs no more than this file and the record:

    pythonfmu build -f docs/examples/building_fmu.py ground.csv

The record has the columns `time` [s] and `ground_acceleration` [m/s2] and is packed into the FMU; it is taken to be linear
between its samples. Positions of car and counterweight come from the drive's FMU; outputs have the names of the inputs of the
rope's FMU.
"""

import csv
from math import pi, sin
from pathlib import Path

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

RECORD = "ground.csv"
SUBSTEP = 0.005  # s, of the classical Runge-Kutta method: a mode of 0.2 s is integrated to five digits
PARAMETERS = {
    "height": (50.0, "m, top landing above the bottom landing"),
    "pit": (1.5, "m, axle of the compensation sheave below the bottom landing: the base of the building"),
    "period_1": (1.12, "s, first mode"),
    "period_2": (0.373, "s, second mode"),
    "damping": (0.02, "ratio of both modes"),
}
INPUTS = {"car_position": 0.0, "counterweight_position": 50.0}
OUTPUTS = ("car_lateral_displacement", "counterweight_lateral_displacement", "base_acceleration")


class BuildingSway(Fmi2Slave):
    """Displacements are relative to the base, outward for the rope; the acceleration is towards the counterweight's side."""

    author = "comprope authors"
    description = "Building of two modes under a record of ground acceleration"

    def __init__(self, **arguments: object) -> None:
        super().__init__(**arguments)
        for name, (value, help) in PARAMETERS.items():
            setattr(self, name, value)
            self.register_variable(
                Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed, description=help)
            )
        for name, value in INPUTS.items():
            setattr(self, name, value)
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        for name in OUTPUTS:
            setattr(self, name, 0.0)
            self.register_variable(Real(name, causality=Fmi2Causality.output))
        with (Path(self.resources) / RECORD).open(encoding="utf-8", newline="") as file:
            rows = [(float(row["time"]), float(row["ground_acceleration"])) for row in csv.DictReader(file)]
        self.times, self.accelerations = ([row[k] for row in rows] for k in range(2))
        self.modes = [[0.0, 0.0], [0.0, 0.0]]  # coordinate [m] and its rate of each mode
        self.place = 0

    def exit_initialization_mode(self) -> None:
        """Outputs at the start."""
        self.show(0.0)

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance both modes, then show the ends where car and counterweight are at the end of the step."""
        count = max(1, round(step_size / SUBSTEP))
        for k in range(count):
            for mode in range(2):
                self.modes[mode] = self.advanced(mode, current_time + k * step_size / count, step_size / count)
        self.show(current_time + step_size)
        return True

    def ground(self, time: float) -> float:
        """Acceleration of the ground [m/s2], none after the record."""
        while self.place > 0 and self.times[self.place] > time:
            self.place -= 1
        while self.place + 2 < len(self.times) and self.times[self.place + 1] < time:
            self.place += 1
        k = self.place
        share = (time - self.times[k]) / (self.times[k + 1] - self.times[k])
        return self.accelerations[k] + share * (self.accelerations[k + 1] - self.accelerations[k]) if share <= 1.0 else 0.0

    def rates(self, mode: int, state: list[float], time: float) -> list[float]:
        """q'' = -2 z w q' - w^2 q - 4 / ((2 j - 1) pi) a, of mode j = mode + 1."""
        rate = 2.0 * pi / (self.period_1, self.period_2)[mode]
        driven = 2.0 / ((mode + 0.5) * pi) * self.ground(time)
        return [state[1], -2.0 * self.damping * rate * state[1] - rate * rate * state[0] - driven]

    def advanced(self, mode: int, time: float, step: float) -> list[float]:
        """The state of a mode after a step by the classical Runge-Kutta method."""
        state = self.modes[mode]
        one = self.rates(mode, state, time)
        two = self.rates(mode, [s + 0.5 * step * r for s, r in zip(state, one, strict=True)], time + 0.5 * step)
        three = self.rates(mode, [s + 0.5 * step * r for s, r in zip(state, two, strict=True)], time + 0.5 * step)
        four = self.rates(mode, [s + step * r for s, r in zip(state, three, strict=True)], time + step)
        rates = zip(one, two, three, four, strict=True)
        return [s + step / 6.0 * (a + 2.0 * b + 2.0 * c + d) for s, (a, b, c, d) in zip(state, rates, strict=True)]

    def show(self, time: float) -> None:
        """Set the outputs; a mode's shape is sin((2 j - 1) pi s / 2), s the height over that of the building."""
        found = []
        for height in (self.car_position, self.counterweight_position):
            share = (height + self.pit) / (self.height + self.pit)
            found.append(sum(sin((mode + 0.5) * pi * share) * self.modes[mode][0] for mode in range(2)))
        self.car_lateral_displacement, self.counterweight_lateral_displacement = -found[0], found[1]
        self.base_acceleration = self.ground(time)
