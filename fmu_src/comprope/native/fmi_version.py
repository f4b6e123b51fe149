"""What differs between FMUs for different versions of the FMI standard; they share the binaries."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ..fmi.model_interface import ModelInterface


@dataclass(frozen=True)
class FmiVersion:
    """A version of FMI.

    `ending` is added to the FMU's name. `model_description(interface, version, identity)` writes the model description,
    `binary_files(name, binaries)` gives the binaries of some targets by path, and `icon_files(interface)` the files of the icon
    and the terminals.
    """

    version: str
    ending: str
    model_description: Callable[[ModelInterface, str, str], bytes]
    binary_files: Callable[[str, Mapping[str, bytes]], dict[str, bytes]]
    icon_files: Callable[[ModelInterface], dict[str, bytes]]
