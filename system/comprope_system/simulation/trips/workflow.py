"""The public function `comprope_system.simulate`: one trip of drive and rope."""

from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from comprope.drive.parameters import Drive
from comprope.drive.trajectory.reference_trajectory import first_trajectory
from comprope.errors import InputError
from comprope.rope.effects import RopeModel
from comprope.rope.model_file import load, with_changes
from comprope.rope.simulator.cosimulation import RopeSimulator
from comprope.rope.simulator.rope import CompensationRope

from ...parallel.progress import Progress, no_progress
from ...presets import model_path
from ...presets.inputs import DriveInput, ModelInput, model_name, read_drive
from ...presets.overrides import Changes, by_key
from ..building_motion.record import BuildingRecord, building_record
from ..cosim.fmu_cache import NamedFmus
from ..cosim.in_process_participant import InProcessParticipant
from ..cosim.master import Coupling
from .elevator import OWN_FMUS, Elevator, driven_elevator, in_building, prescribed_elevator, tripped
from .measured_run import MotionWishes, Run, measured_timing, read_run
from .result import SimulationResult
from .rope_shapes import FrameRecorder
from .stop import CONTROLLED, Stop, stopping_drive
from .stop_motion import buffer_contact, moving_at, stopped_motions
from .timing import Timing
from .trip_simulation import Simulated, relative_to_building
from .trip_simulation import simulate as simulate_trip

MOVING = 0.1  # m/s: faster than a car that bounces on its hoist ropes at the end of a simulation
SETTLE = 8.0  # s simulated after the trip, while the rope vibrates freely


@dataclass(frozen=True)
class CarMotion:
    """Motion of the car: by a drive between two heights, or as measured.

    `start` and `end` are heights above the bottom landing [m], by default the two terminal landings; `speed` [m/s],
    `acceleration` [m/s2] and `jerk` [m/s3] replace the drive's limits. `drive` is a parameter file or a `Drive`, by default the
    preset's own. `measured` is a CSV file with `time` and `car_position`, which the car then follows instead; `start` and `end`
    are then the heights at the start and end of the record, where its zero is another, and `exact` takes the motion as it
    is, without looking for a smooth trip. With a `stop` the trip ends in it; car and counterweight then follow its motion.
    """

    start: float | None = None
    end: float | None = None
    speed: float | None = None
    acceleration: float | None = None
    jerk: float | None = None
    drive: DriveInput | None = None
    measured: str | Path | None = None
    exact: bool = False
    stop: Stop | None = None


def simulate(
    model: ModelInput,
    motion: CarMotion | None = None,
    *,
    changes: Changes | None = None,
    duration: float | None = None,
    step: float = 0.01,
    coupling: Coupling = "two-way",
    fmu: bool | Sequence[str | Path] = False,
    progress: Progress = no_progress,
) -> SimulationResult:
    """Co-simulate drive and rope through one trip of the car.

    `model` is a model file, a preset's name or a `RopeModel`; `changes` are values by key, `{"sheave.mass": 90.0}`, also of the
    drive's tables; `duration` [s] is by default that of the trip and 8 s at rest; `step` is the communication step [s];
    `coupling` "one-way" does not apply the rope's forces to the drive. With `fmu` both models are simulated as FMUs, with the
    same results; it may name files of FMUs, which are then run instead of our own. Raises `InputError` for invalid input,
    `SimulationError` if a step does not converge.
    """
    motion = motion or CarMotion()
    fmus = None if fmu is False else NamedFmus.read(() if fmu is True else fmu)
    rope_model, drive_changes = changed_model(model, changes)
    rope_model = _with_walls(rope_model)
    names, measured = [sensor.name for sensor in rope_model.sensors], None
    if motion.measured:
        measured = _measured(motion, rope_model, names)
        own, source = by_key(changes)
        rope_model = with_changes(rope_model, measured.changes | own, source)
    elevator: AbstractContextManager[Elevator]
    if measured and not motion.stop:
        elevator = prescribed_elevator(rope_model, measured.trips, measured.lateral, fmus is None, fmus or OWN_FMUS)
        timing = measured_timing(measured, duration, step, coupling)
    else:
        moving = _stopped if motion.stop else _driven
        elevator, natural = moving(model, motion, rope_model, drive_changes, fmus)
        timing = Timing(natural if duration is None else duration, step, coupling)
    building = _moving_building(rope_model, measured, timing)
    with elevator as found:
        ready = tripped(found, motion.stop.devices, motion.stop.time) if motion.stop and found.driven else found
        ready = in_building(ready, building.motion) if building else ready
        recorder = None if fmus else FrameRecorder(partial(_rope, ready), timing.step)
        simulated = simulate_trip(ready, names, timing, partial(_advance, progress, recorder, timing.steps_before))
    remarks = _still_moving(simulated) if motion.stop else ()
    if building:
        simulated, remarks = relative_to_building(simulated, rope_model, building.motion), (*building.remarks, *remarks)
    recording = recorder.recording if recorder else None
    return SimulationResult(
        simulated.table, simulated.columns, simulated.sensors, rope_model, model_name(model), measured, recording, remarks,
        building.motion if building else None,
    )  # fmt: skip


def _measured(motion: CarMotion, model: RopeModel, sensors: Sequence[str]) -> Run:
    """The measured run that the car follows; raises `InputError` for options that concern the drive."""
    unused = [name for name in ("speed", "acceleration", "jerk", "drive", "stop") if getattr(motion, name) is not None]
    if unused:
        raise InputError(f"{', '.join(unused)}: not accepted with a measured motion, which has no drive")
    wishes = MotionWishes("exact" if motion.exact else None, motion.start, motion.end)
    return read_run(Path(str(motion.measured)), model.shaft.height, sensors, wishes)


def _moving_building(model: RopeModel, measured: Run | None, timing: Timing) -> BuildingRecord | None:
    """The motion of the model's building, if it moves; raises `InputError` for a record that does not fit the simulation."""
    building = building_record(model)
    if building and measured and measured.lateral:
        raise InputError("building: not accepted with a run in which lateral displacements of the rope's ends are measured")
    if building is None:
        return None
    building.require_duration(timing.begin + timing.duration)
    return building


def _with_walls(model: RopeModel) -> RopeModel:
    """The model whose walls and guides move with its building, if it has one, unless the file says how far they do."""
    if model.building is None or "walls_follow" in model.shaft.model_fields_set:
        return model
    return with_changes(model, {"shaft.walls_follow": 1.0})


def _advance(progress: Progress, recorder: FrameRecorder | None, before: int, count: int, total: int) -> None:
    """Report progress of a communication step, and record the shape of the rope if available, after a run-up of some steps."""
    progress("simulating", count, total)
    if recorder and count >= before:
        recorder(count - before, total - before)


def _rope(elevator: Elevator) -> CompensationRope:
    """The rope of an elevator that is stepped in this process."""
    rope = elevator.participants[-1]
    if not isinstance(rope, InProcessParticipant) or not isinstance(rope.simulator, RopeSimulator):
        raise TypeError("an FMU does not show the rope's shape")
    return rope.simulator.rope


def changed_model(model: ModelInput, changes: Changes | None) -> tuple[RopeModel, dict[str, dict[str, Any]]]:
    """The model with its changes, and the changes that concern the drive, by table and key."""
    own, drive = {}, dict[str, dict[str, Any]]()
    wanted, source = by_key(changes)
    for key, value in wanted.items():
        table, _, name = key.partition(".")
        if table in Drive.model_fields and table not in RopeModel.model_fields:
            drive.setdefault(table, {})[name] = value
        else:
            own[key] = value
    loaded = model if isinstance(model, RopeModel) else load(model_path(model))
    return with_changes(loaded, own, source), drive


def _driven(
    model: ModelInput, motion: CarMotion, rope_model: RopeModel, changes: dict[str, dict[str, Any]], fmus: NamedFmus | None
) -> tuple[AbstractContextManager[Elevator], float]:
    """The elevator with its drive for the requested trip in the shaft of the model, and the simulated time [s]."""
    drive = _drive(model, motion, rope_model, changes)
    return driven_elevator(rope_model, drive, fmus is None, fmus or OWN_FMUS), first_trajectory(drive).end_time + SETTLE


def _drive(model: ModelInput, motion: CarMotion, rope_model: RopeModel, changes: dict[str, dict[str, Any]]) -> Drive:
    """The drive with the requested trip in the shaft of the model."""
    height = rope_model.shaft.height
    limits = {"speed": motion.speed, "acceleration": motion.acceleration, "jerk": motion.jerk}
    trip = {
        "start_position": 0.0 if motion.start is None else motion.start,
        "destination": height if motion.end is None else motion.end,
    }
    asked: dict[str, dict[str, Any]] = {
        "shaft": {"height": height, "gravity": rope_model.shaft.gravity},
        "profile": {name: value for name, value in limits.items() if value is not None},
        "trip": trip,
    }
    merged = {table: asked.get(table, {}) | changes.get(table, {}) for table in {*asked, *changes}}
    return read_drive(motion.drive, model, merged)


def _stopped(
    model: ModelInput, motion: CarMotion, rope_model: RopeModel, changes: dict[str, dict[str, Any]], fmus: NamedFmus | None
) -> tuple[AbstractContextManager[Elevator], float]:
    """The elevator that is stopped on its way, and the simulated time [s]."""
    stop, height, direct = motion.stop or Stop(), rope_model.shaft.height, fmus is None
    drive = stopping_drive(_drive(model, motion, rope_model, changes), stop)
    trip = first_trajectory(drive)
    if stop.buffer:
        return driven_elevator(rope_model, drive, direct, fmus or OWN_FMUS), buffer_contact(trip, height) + SETTLE
    at = moving_at(trip, stop)
    if stop.devices:
        slowing = abs(at.velocity) / CONTROLLED
        return driven_elevator(rope_model, drive, direct, fmus or OWN_FMUS), stop.time + slowing + SETTLE
    motions = stopped_motions(trip, stop, height, rope_model.shaft.gravity)
    elevator = prescribed_elevator(rope_model, motions, {}, direct, fmus or OWN_FMUS)
    return elevator, max(one.end for one in motions.values()) + SETTLE


def _still_moving(simulated: Simulated) -> tuple[str, ...]:
    """A remark where the car has not come to rest."""
    speed, time = float(simulated.table["car_velocity"].iloc[-1]), float(simulated.table["time"].iloc[-1])
    return (f"the car still moves at {speed:.2f} m/s at {time:g} s",) if abs(speed) > MOVING else ()
