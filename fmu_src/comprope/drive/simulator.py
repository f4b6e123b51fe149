"""Time simulation of the drive: sampled controller and exactly discretised hoist.

The controller samples at start + count * period, independently of the communication step. Between samples the motor torque
is constant and the hoist is integrated exactly, so that communication steps only determine when inputs are read.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..errors import InputError, SimulationError
from .hoist_dynamics import V_C, V_S, V_W, X_C, X_W, S, holding_force
from .parameters import Drive
from .scheduled_plant import cells
from .servo_control import design
from .state import Memory
from .trajectory.reference_trajectory import reference_trajectory
from .trajectory.s_curve import TrajectoryPoint, plan_s_curve

TENSIONS = ("car_end_tension", "counterweight_end_tension")
_FORCE, _PULLS = 8, slice(9, 11)  # indices of the constant inputs in the full vector
_SAME_TIME = 1e-6  # times closer than this fraction of a sample period are equal: importers accumulate steps


class DriveSimulator:
    """Simulator of one drive, initially at rest; inputs and outputs as in `cosimulation.interface`."""

    def __init__(self, drive: Drive, inputs: Mapping[str, Any], start_time: float) -> None:
        """Equilibrium at `start_time` [s], the motor holding car and counterweight against the tensions in `inputs`."""
        self._drive, self._start, self._home = drive, start_time, drive.trip.start_position
        self._law, self._cells = design(drive), cells(drive)
        trip = plan_s_curve(drive.profile, self._home, drive.trip.destination, drive.trip.start_time)
        pulls, heard = compensation_pulls(drive, inputs), inputs["destination"]
        self._memory = Memory(0, self._cells.at(self._home), 0.0, 0.0, heard, pulls, trip, np.zeros(11))
        self._course = reference_trajectory(drive, trip)
        self._hold()

    def step(self, time: float, dt: float, inputs: Mapping[str, Any]) -> None:
        """Advance from `time` to `time + dt` [s] with inputs held.

        Raises `InputError` for a destination outside the shaft or a tension that is not finite, `SimulationError`
        when the motor is too weak to keep the car in the shaft.
        """
        found = input_problems(self._drive, inputs)
        if found:
            raise InputError("; ".join(found))
        memory, period = self._memory, self._drive.servo.sample_period
        pulls = compensation_pulls(self._drive, inputs)
        memory.full[_PULLS] = pulls[0] - memory.pulls[0], pulls[1] - memory.pulls[1]
        end, same = time + dt - self._start, _SAME_TIME * period
        while end - (memory.periods * period + memory.elapsed) > same:
            if memory.elapsed == 0.0:
                self._sample(inputs["destination"])
            self._move(end - memory.periods * period, same)

    def outputs(self) -> dict[str, Any]:
        """All outputs by name at the current time."""
        memory, full, time = self._memory, self._memory.full, self._now()
        reference, rates = self._course.at(time), self._cells.rates[memory.cell] @ full
        return {
            "car_position": self._home + float(full[X_C]),
            "car_velocity": float(full[V_C]),
            "car_acceleration": float(rates[V_C]),
            "counterweight_position": self._drive.shaft.height - self._home + float(full[X_W]),
            "counterweight_velocity": float(full[V_W]),
            "counterweight_acceleration": float(rates[V_W]),
            "encoder_position": self._home + float(full[S]),
            "motor_torque": self._drive.plant.sheave_radius * (self._holding + float(full[_FORCE])),
            "reference_position": reference.position,
            "reference_velocity": reference.velocity,
            "reference_acceleration": reference.acceleration,
            "moving": self._course.start_time <= time < self._course.end_time,
            "trip_finished": time >= self._course.end_time,
        }

    def get_state(self) -> bytes:
        """The complete state, for a bitwise equal restart in any process."""
        return self._memory.pack()

    def set_state(self, state: bytes) -> None:
        """Restore a state of `get_state` of a simulator with the same parameters and start time."""
        self._memory = Memory.unpack(state)
        self._course = reference_trajectory(self._drive, self._memory.trip)
        self._hold()

    def _now(self) -> float:
        memory = self._memory
        return self._start + (memory.periods * self._drive.servo.sample_period + memory.elapsed)

    def _hold(self) -> None:
        """Compute the force at the rim [N] that holds the hoist at rest, and the remaining range up to the torque limit."""
        self._holding = holding_force(self._drive, self._home, *self._memory.pulls)
        limit = self._drive.servo.torque_limit / self._drive.plant.sheave_radius
        self._limits = -limit - self._holding, limit - self._holding

    def _sample(self, destination: float) -> None:
        """One sample of the controller: accept a call, read the encoder, set the torque."""
        memory, full, time = self._memory, self._memory.full, self._now()
        if time >= self._course.end_time and destination != memory.heard:
            memory.trip = plan_s_curve(self._drive.profile, memory.trip.destination, destination, time)
            memory.heard = destination
            self._course = reference_trajectory(self._drive, memory.trip)
        way, velocity = float(full[S]), float(full[V_S])
        self._check_in_shaft(self._home + way, time)
        memory.cell = self._cells.at(self._home + way)
        at = self._course.at(time)
        reference = TrajectoryPoint(at.position - self._home, at.velocity, at.acceleration)
        full[_FORCE], memory.integral = self._law.force(memory.integral, reference, way, velocity, self._limits)

    def _move(self, until: float, same: float) -> None:
        """Integrate the hoist to `until` [s] after the last sample or to the next sample, whichever is first."""
        memory, period = self._memory, self._drive.servo.sample_period
        whole = until > period - same
        if whole and memory.elapsed == 0.0:
            self._cells.period(memory.cell, memory.full)
        else:
            self._cells.part(memory.cell, memory.full, (period if whole else until) - memory.elapsed)
        memory.periods += whole
        memory.elapsed = 0.0 if whole else until

    def _check_in_shaft(self, position: float, time: float) -> None:
        height, spare = self._drive.shaft.height, 0.5 * self._drive.plant.headroom
        if not -spare <= position <= height + spare:
            raise SimulationError(
                f"car at {position:.6g} m at t = {time:.6g} s has left the shaft of 0 to {height:g} m: "
                f"servo.torque_limit = {self._drive.servo.torque_limit:g} N.m is too small for this trip and load"
            )


def compensation_pulls(drive: Drive, inputs: Mapping[str, Any]) -> tuple[float, float]:
    """Pulls of all compensation ropes on car and counterweight [N]."""
    car, counterweight = (drive.rope.count * inputs[name] for name in TENSIONS)
    return car, counterweight


def input_problems(drive: Drive, inputs: Mapping[str, Any]) -> list[str]:
    """One sentence for each invalid input."""
    destination, height = inputs["destination"], drive.shaft.height
    found = [f"{name} = {inputs[name]} N: a finite number is accepted" for name in TENSIONS if not math.isfinite(inputs[name])]
    if not 0.0 <= destination <= height:
        found.append(f"destination = {destination} m: 0 to shaft.height = {height:g} m is accepted")
    return found
