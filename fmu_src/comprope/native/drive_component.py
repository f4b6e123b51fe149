"""The drive as the native FMU needs it."""

from ..drive.kernels import checks
from ..drive.kernels.arguments import TABLES, Inputs, Outputs, Parameters
from ..drive.kernels.entry_points import SOURCES
from ..drive.kernels.parameter_vector import NAMES
from ..drive.simulator import empty_design, empty_state, empty_workspace
from ..drive.status import MESSAGES
from ..drive.variables import FLAGS, INPUTS, REAL_OUTPUTS
from ..fmi.model_interface import ModelInterface
from ..kernels.entry_source import flattened
from .component import Component

_CHECKS = ("COMPONENT_CHECKS", "STOPS", "INPUT_CHECKS", "START_CHECK", "TORQUE_CHECK", "GAIN_CHECK", "CHECKS")
_POINTS = (5, 6, 9)


def drive_component(interface: ModelInterface) -> Component:
    """The drive with the variables of its interface."""
    outputs = [name for name, *_ in (*REAL_OUTPUTS, *FLAGS)]
    return Component(
        "drive",
        interface,
        SOURCES,
        TABLES,
        {points: _sizes(points, len(outputs)) for points in _POINTS},
        "State.emergency",
        {"Parameters.p": NAMES, "Inputs.u": INPUTS},
        outputs,
        MESSAGES,
        {name: getattr(checks, name) for name in _CHECKS},
    )


def _sizes(points: int, outputs: int) -> dict[str, int]:
    """How many numbers each array has."""
    nothing = [0.0] * 0
    among = (Parameters(nothing), Inputs(nothing), Outputs([0.0] * outputs))  # type: ignore[arg-type]
    fields = flattened(empty_state(), empty_design(points), empty_workspace(), *among)
    return {name: len(fields[name]) for name in TABLES.arrays}
