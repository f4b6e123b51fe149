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
from .scheduled_plant import scheduled_plant
from .servo_control import design_servo
from .state import DriveState
from .trajectory.reference_trajectory import reference_trajectory
from .trajectory.s_curve import TrajectoryPoint, plan_s_curve

TENSIONS = ("car_end_tension", "counterweight_end_tension")
_FORCE, _COMPENSATION = 8, slice(9, 11)  # indices of the constant inputs in the vector of states and inputs
_SAME_TIME = 1e-6  # times closer than this fraction of a sample period are equal: importers accumulate steps


class DriveSimulator:
    """Simulator of one drive, initially at rest; inputs and outputs as in `cosimulation.interface`."""

    def __init__(self, drive: Drive, inputs: Mapping[str, Any], start_time: float) -> None:
        """Equilibrium at `start_time` [s], the motor holding car and counterweight against the tensions in `inputs`."""
        self._drive, self._start_time, self._start_position = drive, start_time, drive.trip.start_position
        self._controller, self._plant = design_servo(drive), scheduled_plant(drive)
        first = plan_s_curve(drive.profile, self._start_position, drive.trip.destination, drive.trip.start_time)
        point, forces = self._plant.operating_point(self._start_position), compensation_forces(drive, inputs)
        self._state = DriveState(0, point, 0.0, 0.0, inputs["destination"], forces, first, np.zeros(11))
        self._trajectory = reference_trajectory(drive, first)
        self._set_force_limits()

    def step(self, time: float, dt: float, inputs: Mapping[str, Any]) -> None:
        """Advance from `time` to `time + dt` [s] with inputs held.

        The equilibrium at the start is that with the first tensions that are not zero: not every importer propagates tensions
        during initialization, and no rope is without. Raises `InputError` for a destination outside the shaft, a
        tension that is not finite or a motor too weak to hold the car, `SimulationError` when it cannot keep it in the shaft.
        """
        found = input_problems(self._drive, inputs)
        if found:
            raise InputError("; ".join(found))
        state, period = self._state, self._drive.servo.sample_period
        forces = compensation_forces(self._drive, inputs)
        if state.rest_forces == (0.0, 0.0) != forces:
            self._settle(inputs)
        state.vector[_COMPENSATION] = forces[0] - state.rest_forces[0], forces[1] - state.rest_forces[1]
        end, same = time + dt - self._start_time, _SAME_TIME * period
        while end - (state.periods * period + state.elapsed) > same:
            if state.elapsed == 0.0:
                self._run_controller(inputs["destination"])
            self._advance_plant(end - state.periods * period, same)

    def outputs(self) -> dict[str, Any]:
        """All outputs by name at the current time."""
        state, vector, time = self._state, self._state.vector, self._now()
        reference, rates = self._trajectory.at(time), self._plant.rate_matrices[state.operating_point] @ vector
        return {
            "car_position": self._start_position + float(vector[X_C]),
            "car_velocity": float(vector[V_C]),
            "car_acceleration": float(rates[V_C]),
            "counterweight_position": self._drive.shaft.height - self._start_position + float(vector[X_W]),
            "counterweight_velocity": float(vector[V_W]),
            "counterweight_acceleration": float(rates[V_W]),
            "encoder_position": self._start_position + float(vector[S]),
            "motor_torque": self._drive.plant.sheave_radius * (self._holding_force + float(vector[_FORCE])),
            "reference_position": reference.position,
            "reference_velocity": reference.velocity,
            "reference_acceleration": reference.acceleration,
            "moving": self._trajectory.start_time <= time < self._trajectory.end_time,
            "trip_finished": time >= self._trajectory.end_time,
        }

    def get_state(self) -> bytes:
        """The complete state, for a bitwise equal restart in any process."""
        return self._state.to_bytes()

    def set_state(self, state: bytes) -> None:
        """Restore a state of `get_state` of a simulator with the same parameters and start time."""
        self._state = DriveState.from_bytes(state)
        self._trajectory = reference_trajectory(self._drive, self._state.s_curve)
        self._set_force_limits()

    def _settle(self, inputs: Mapping[str, Any]) -> None:
        """Take the tensions for those of the equilibrium at the start."""
        if problems := torque_problems(self._drive, inputs):
            raise InputError("; ".join(problems))
        self._state.rest_forces = compensation_forces(self._drive, inputs)
        self._set_force_limits()

    def _now(self) -> float:
        state = self._state
        return self._start_time + (state.periods * self._drive.servo.sample_period + state.elapsed)

    def _set_force_limits(self) -> None:
        """Compute the force at the rim [N] that holds the hoist at rest, and the remaining range up to the torque limit."""
        self._holding_force = holding_force(self._drive, self._start_position, *self._state.rest_forces)
        limit = self._drive.servo.torque_limit / self._drive.plant.sheave_radius
        self._limits = -limit - self._holding_force, limit - self._holding_force

    def _run_controller(self, destination: float) -> None:
        """One sample of the controller: accept a call, read the encoder, set the torque."""
        state, vector, time = self._state, self._state.vector, self._now()
        if time >= self._trajectory.end_time and destination != state.called:
            state.s_curve = plan_s_curve(self._drive.profile, state.s_curve.destination, destination, time)
            state.called = destination
            self._trajectory = reference_trajectory(self._drive, state.s_curve)
        position, velocity = float(vector[S]), float(vector[V_S])
        self._require_in_shaft(self._start_position + position, time)
        state.operating_point = self._plant.operating_point(self._start_position + position)
        at = self._trajectory.at(time)
        reference = TrajectoryPoint(at.position - self._start_position, at.velocity, at.acceleration)
        vector[_FORCE], state.integral = self._controller.force(state.integral, reference, position, velocity, self._limits)

    def _advance_plant(self, until: float, same: float) -> None:
        """Integrate the hoist to `until` [s] after the last sample or to the next sample, whichever is first."""
        state, period = self._state, self._drive.servo.sample_period
        whole = until > period - same
        if whole and state.elapsed == 0.0:
            self._plant.advance_period(state.operating_point, state.vector)
        else:
            self._plant.advance(state.operating_point, state.vector, (period if whole else until) - state.elapsed)
        state.periods += whole
        state.elapsed = 0.0 if whole else until

    def _require_in_shaft(self, position: float, time: float) -> None:
        height, spare = self._drive.shaft.height, 0.5 * self._drive.plant.headroom
        if not -spare <= position <= height + spare:
            raise SimulationError(
                f"car at {position:.6g} m at t = {time:.6g} s has left the shaft of 0 to {height:g} m: "
                f"servo.torque_limit = {self._drive.servo.torque_limit:g} N.m is too small for this trip and load"
            )


def compensation_forces(drive: Drive, inputs: Mapping[str, Any]) -> tuple[float, float]:
    """Forces of all compensation ropes on car and counterweight [N], down positive."""
    car, counterweight = (drive.rope.count * inputs[name] for name in TENSIONS)
    return car, counterweight


def torque_problems(drive: Drive, inputs: Mapping[str, Any]) -> list[str]:
    """A sentence if the motor is too weak to hold the car initially."""
    force = holding_force(drive, drive.trip.start_position, *compensation_forces(drive, inputs))
    needed, limit = abs(force) * drive.plant.sheave_radius, drive.servo.torque_limit
    if limit > needed:
        return []
    return [f"servo.torque_limit = {limit} N.m: more than the {needed:.6g} N.m that hold the car initially is accepted"]


def input_problems(drive: Drive, inputs: Mapping[str, Any]) -> list[str]:
    """One sentence for each invalid input."""
    destination, height = inputs["destination"], drive.shaft.height
    found = [f"{name} = {inputs[name]} N: a finite number is accepted" for name in TENSIONS if not math.isfinite(inputs[name])]
    if not 0.0 <= destination <= height:
        found.append(f"destination = {destination} m: 0 to shaft.height = {height:g} m is accepted")
    return found
