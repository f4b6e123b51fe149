"""What a native FMU is made of besides the functions of the FMI: variables, kernels and their memory."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ..fmi.model_interface import ModelInterface
from ..kernels.entry_source import EntrySource, Tables
from ..kernels.status import Messages


@dataclass(frozen=True)
class Component:
    """Rope or drive, with the number of its sensors and its effects.

    `name` is that of its file in `c/components` and of its kernels in `llvm_ir`, `effect_files` the sources of a user's own
    effects by path. `sources` are the entry points that C calls, by name. `sizes` says, for three numbers of columns, how many
    numbers each array has; those up to `last_of_state` make the state. `among_variables` names, for arrays that have no memory of
    their own, the variables whose values they are, `outputs` the outputs as the kernels order them. `constants` and
    `declarations` are further C for its file.
    """

    name: str
    interface: ModelInterface
    sources: Mapping[str, EntrySource]
    tables: Tables
    sizes: Mapping[int, Mapping[str, int]] = field(repr=False)
    last_of_state: str
    among_variables: Mapping[str, Sequence[str]]
    outputs: Sequence[str]
    messages: Messages
    constants: Mapping[str, int]
    declarations: str = ""
    effect_files: Mapping[str, str] = field(default_factory=dict)

    @property
    def places(self) -> dict[str, int]:
        """The value reference of each variable by name."""
        return {one.name: place for place, one in enumerate(self.interface.variables)}
