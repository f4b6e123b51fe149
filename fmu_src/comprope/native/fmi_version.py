"""What the FMU for one version of the FMI standard has of its own; the binaries serve all versions."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ..fmi.model_interface import ModelInterface


@dataclass(frozen=True)
class Standard:
    """A version of FMI.

    `ending` is added to the FMU's name. `description(interface, version, identity)` writes the model description,
    `placed(name, binaries)` gives the binaries of some targets their paths, and `icons()` are the files of the icon.
    """

    version: str
    ending: str
    description: Callable[[ModelInterface, str, str], bytes]
    placed: Callable[[str, Mapping[str, bytes]], dict[str, bytes]]
    icons: Callable[[], dict[str, bytes]]
