"""A model as pythonfmu's slave, for the model description that pythonfmu writes.

Inside an FMU the functions of `functions` take the place of pythonfmu's binary, which crashes in folders whose names have letters
outside ASCII or percent signs, without a name or a logger, and in hosts that are not Python (seen in version 0.7.0).
"""

import xml.etree.ElementTree as ET
from typing import Any

from pythonfmu import Boolean, Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Integer, Real, String

from .model_interface import ModelInterface, Variable

_FMI_TYPES = {"real": Real, "integer": Integer, "boolean": Boolean, "string": String}
_INITIAL = {"parameter": Fmi2Initial.exact, "output": Fmi2Initial.calculated, "input": None}


def pythonfmu_description(interface: ModelInterface) -> bytes:
    """The model description of a model as pythonfmu writes it; see `model_description.complete_description`."""
    slave = type(interface.name, (_Slave,), {})(instance_name="described")
    for one in interface.variables:
        slave.register_variable(_pythonfmu_variable(one), nested=False)
    return ET.tostring(slave.to_xml())


class _Slave(Fmi2Slave):
    def do_step(self, current_time: float, step_size: float) -> bool:
        """Described, not stepped."""
        raise NotImplementedError


def _pythonfmu_variable(variable: Variable) -> Any:
    return _FMI_TYPES[variable.kind](
        variable.name,
        causality=Fmi2Causality[variable.role],
        variability=Fmi2Variability[variable.variability],
        initial=_INITIAL[variable.role],
        description=variable.help,
        getter=lambda: variable.start,
    )
