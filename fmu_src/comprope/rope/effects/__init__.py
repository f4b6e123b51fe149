"""All effects that a model may have, and the model type that takes them."""

from typing import Any

from pydantic import Field, create_model

from ...declare import Component
from ..parameters import Base
from . import air_drag, bending_hysteresis, intrinsic_curvature, rope_ends, sheave_eccentricity, sheave_guide
from .base import HOOKS, REGISTRY, Effect, acts, register

__all__ = [
    "HOOKS", "REGISTRY", "Effect", "RopeModel", "acts", "air_drag", "bending_hysteresis", "intrinsic_curvature",
    "model_type", "register", "rope_ends", "sheave_eccentricity", "sheave_guide",
]  # fmt: skip


class RopeModel(Base):
    """A rope model with effects: what a model file holds. `effects` has one optional field per effect."""

    effects: Any = None


def model_type() -> type[RopeModel]:
    """The model type with a field for every effect that is registered by now."""
    fields: dict[str, Any] = {name: (effect | None, None) for name, effect in REGISTRY.items()}
    effects = create_model("Effects", __base__=Component, **fields)
    return create_model("RopeModel", __base__=RopeModel, effects=(effects, Field(default_factory=effects)))
