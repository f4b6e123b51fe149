"""The elevator as a co-simulation: participants drive and rope, their order, connections and parameters from one model."""

from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from typing import Any

from comprope.drive.cosimulation import interface as drive_interface
from comprope.drive.parameters import Drive
from comprope.fmi.model_interface import ModelInterface
from comprope.rope.effects import RopeModel
from comprope.rope.simulator.cosimulation import interface as rope_interface

from ..building_motion.motion import BuildingMotion
from ..cosim import Connection, Participant
from ..cosim.building_ends import OUTPUTS as BUILDING
from ..cosim.building_ends import POSITIONS, BuildingEnds
from ..cosim.fmu_cache import NamedFmus
from ..cosim.fmu_participant import FmuParticipant
from ..cosim.in_process_participant import InProcessParticipant
from ..cosim.prescribed_motion import EndMotion, PrescribedMotion
from ..cosim.trip_signals import TripSignals

MOTIONS = tuple(f"{end}_{what}" for end in ("car", "counterweight") for what in ("position", "velocity", "acceleration"))
TENSIONS = ("car_end_tension", "counterweight_end_tension")
FORWARD = tuple(Connection("motion", one, "rope", one) for one in MOTIONS)
BACKWARD = tuple(Connection("rope", one, "motion", one) for one in TENSIONS)
SWAYED = (
    *(Connection("motion", one, "building", one) for one in POSITIONS),
    *(Connection("building", one, "rope", one) for one in BUILDING),
)
# The rope's inputs are the drive's outputs of the same step, velocities and accelerations included.
ROPE_INPUTS = {"inputs_at_end": True, "derivative_inputs": True}
OWN_FMUS = NamedFmus()


@dataclass(frozen=True)
class Elevator:
    """The participants in their order of stepping, and their connections.

    `driven`: by a drive, not as measured; `moving`: in a building that moves; `tripping`: its drive is tripped on the way.
    """

    participants: tuple[Participant, ...]
    connections: tuple[Connection, ...]
    driven: bool
    moving: bool = False
    tripping: bool = False


def tripped(elevator: Elevator, devices: tuple[str, ...], time: float) -> Elevator:
    """The elevator whose drive gets its inputs `devices` fully applied from a time [s] on; without any its buffers trip it."""
    signals: Participant = TripSignals("trip", devices, time)
    connections = tuple(Connection("trip", one, "motion", one) for one in devices)
    return replace(
        elevator, participants=(signals, *elevator.participants), connections=connections + elevator.connections, tripping=True
    )


def in_building(elevator: Elevator, motion: BuildingMotion) -> Elevator:
    """The elevator in a building that moves; the building steps between drive and rope."""
    *before, rope = elevator.participants
    ends: Participant = BuildingEnds("building", motion)
    return replace(elevator, participants=(*before, ends, rope), connections=elevator.connections + SWAYED, moving=True)


@contextmanager
def driven_elevator(model: RopeModel, drive: Drive, direct: bool = False, fmus: NamedFmus = OWN_FMUS) -> Iterator[Elevator]:
    """Drive and rope, as FMUs or, with `direct`, as models in this process; freed at the end."""
    with ExitStack() as stack:
        interface = drive_interface(drive)
        if direct:
            motion: Participant = InProcessParticipant("motion", interface, {})
        else:
            motion = stack.enter_context(FmuParticipant("motion", fmus.drive(), start_values(interface)))
        yield Elevator((motion, _rope(stack, model, direct, fmus)), FORWARD + BACKWARD, True)


@contextmanager
def prescribed_elevator(
    model: RopeModel,
    trips: Mapping[str, EndMotion],
    lateral: Mapping[str, EndMotion],
    direct: bool = False,
    fmus: NamedFmus = OWN_FMUS,
) -> Iterator[Elevator]:
    """The rope with prescribed motion of car and counterweight and, where given, of its ends sideways; see `PrescribedMotion`."""
    sideways = tuple(f"{end}_lateral_displacement" for end in lateral)
    connections = FORWARD + tuple(Connection("motion", one, "rope", one) for one in sideways)
    with ExitStack() as stack:
        yield Elevator((PrescribedMotion("motion", trips, lateral), _rope(stack, model, direct, fmus)), connections, False)


def start_values(interface: ModelInterface) -> dict[str, Any]:
    """Every parameter and input of a model by name: an FMU's own start values need not be the same."""
    return {one.name: one.start for role in ("parameter", "input") for one in interface.of_role(role)}


def _rope(stack: ExitStack, model: RopeModel, direct: bool, fmus: NamedFmus) -> Participant:
    interface = rope_interface(model)
    if direct:
        return InProcessParticipant("rope", interface, ROPE_INPUTS)
    path = fmus.rope(len(model.sensors), model.own_effects)
    return stack.enter_context(FmuParticipant("rope", path, start_values(interface) | ROPE_INPUTS))
