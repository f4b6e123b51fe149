"""All effects that a model may have, and the model type that takes them."""

from functools import cache
from typing import Any

from pydantic import Field, create_model

from ...declare import Component
from ..parameters import Base
from . import air_drag, bending_hysteresis, intrinsic_curvature, rope_ends, sheave_eccentricity, sheave_guide
from .base import HOOKS, REGISTRY, Effect, acts, register

__all__ = [
    "HOOKS", "INSTRUMENT", "REGISTRY", "Effect", "RopeModel", "acts", "air_drag", "bending_hysteresis", "intrinsic_curvature",
    "model_type", "register", "rope_ends", "sheave_eccentricity", "sheave_guide",
]  # fmt: skip

# What instruments do to what they show: one value per channel. No part of the rope, so the kernels know nothing of it.
INSTRUMENT = {
    "sensor_gain": "what a channel shows over what is there, by the channel's column",
    "sensor_offset": "what a channel shows when there is nothing, in SI units, by the channel's column",
    "sensor_delay": "how late a channel shows it [s], by the channel's column",
}


class RopeModel(Base):
    """A rope model with effects: what a model file holds. `effects` has one optional field per effect."""

    effects: Any = None

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled as plain tables, since the type itself is made at run time."""
        return restored, (self.model_dump(exclude_none=True),)


def restored(table: dict[str, Any]) -> RopeModel:
    """The model of a table."""
    return model_type().model_validate(table)


def model_type() -> type[RopeModel]:
    """The model type with a field for every effect that is registered by now."""
    return _type_with(tuple(REGISTRY.items()))


@cache
def _type_with(registered: tuple[tuple[str, type[Effect]], ...]) -> type[RopeModel]:
    """One type for one set of effects, so that models read apart can be equal."""
    fields: dict[str, Any] = {name: (effect | None, None) for name, effect in registered}
    fields |= {name: (dict[str, float] | None, Field(None, description=help)) for name, help in INSTRUMENT.items()}
    effects = create_model("Effects", __base__=Component, **fields)
    return create_model("RopeModel", __base__=RopeModel, effects=(effects, Field(default_factory=effects)))
