"""All effects that a model may have, and the model type that takes them."""

from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any

from pydantic import Field, create_model

from ...quantities import Component
from ..parameters import Base

# isort: off
# The order of these modules is that of the effects in the parameter vector and among the FMU's variables, whose value
# references hosts keep: a new effect comes last.
from .shaft import air_drag
from . import bending_hysteresis, intrinsic_curvature, end_displacement
from .sheave import sheave_eccentricity, sheave_friction, end_stops, tie_down
from .shaft import shaft_walls
from .sheave import sheave_unbalance, jammed, sticky_guide
from .shaft import rope_guides
from . import encoder_scale
from .sheave import sloped_guide
# isort: on

from . import user_effects
from .base import HOOKS, INSTRUMENT, REGISTRY, Effect, acts, register

__all__ = [
    "HOOKS", "INSTRUMENT", "REGISTRY", "Effect", "RopeModel", "acts", "air_drag", "bending_hysteresis", "encoder_scale",
    "end_displacement", "end_stops", "intrinsic_curvature", "jammed", "model_type", "names_of", "register",
    "rope_guides", "shaft_walls", "sheave_eccentricity", "sheave_friction", "sheave_unbalance", "sloped_guide", "sticky_guide",
    "tie_down", "user_effects",
]  # fmt: skip

class RopeModel(Base):
    """A rope model with effects: what a model file holds. `effects` has one optional field per effect."""

    effects: Any = None
    own_effects: tuple[str, ...] = Field(
        (), description='a list of Python files with effects of your own, relative to the model file, such as ["rail_joints.py"]'
    )

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled as plain tables, since the type is created at run time; user-defined effects include their source."""
        return restored, (self.model_dump(exclude_none=True), {path: user_effects.FILES[path].text for path in self.own_effects})


def restored(table: dict[str, Any], sources: Mapping[str, str]) -> RopeModel:
    """The model of a table with user-defined effects by file and source; consent was given before pickling."""
    for path, text in sources.items():
        user_effects.run_source(path, text)
    return model_type(table["own_effects"]).model_validate(table)


def model_type(files: Iterable[str] = ()) -> type[RopeModel]:
    """The model type with a field for every built-in effect and every effect of these files, which must be registered."""
    names = {name for path in files for name in user_effects.FILES[path].effects}
    return _type_with(tuple(one for one in REGISTRY.items() if not one[1].source or one[0] in names))


def names_of(model: Base) -> tuple[str, ...]:
    """Names of the effects that a model may have: built-in ones and those of its own files."""
    fields = getattr(type(getattr(model, "effects", None)), "model_fields", {})
    return tuple(name for name, effect in REGISTRY.items() if not effect.source or name in fields)


@cache
def _type_with(registered: tuple[tuple[str, type[Effect]], ...]) -> type[RopeModel]:
    """One type for each set of effects, so that models read separately can be equal."""
    fields: dict[str, Any] = {name: (effect | None, None) for name, effect in registered}
    fields |= {name: (dict[str, float] | None, Field(None, description=help)) for name, help in INSTRUMENT.items()}
    effects = create_model("Effects", __base__=Component, **fields)
    return create_model("RopeModel", __base__=RopeModel, effects=(effects, Field(default_factory=effects)))
