"""Declaration of components: unit, range, default and description of each of their quantities.

Model files, FMU variables, help texts, tables in the documentation and the bounds of fits are all
read from these declarations.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel, ConfigDict, Field
from pydantic_core import PydanticUndefined


class Component(BaseModel):
    """A frozen set of quantities; unknown keys, missing keys and impossible values are rejected."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


@dataclass(frozen=True)
class Quantity:
    """One declared number of a component.

    `off` is the neutral value, with which the component has no influence; None if that is the default.
    """

    name: str
    unit: str
    help: str
    minimum: float
    maximum: float
    default: float | None
    nominal: float
    off: float | None

    @property
    def neutral(self) -> float:
        """The value this quantity has in a model that does not mention its component."""
        chosen = self.off if self.off is not None else self.default
        return self.minimum if chosen is None else chosen


def quantity(
    unit: str,
    help: str,
    minimum: float,
    maximum: float,
    *,
    default: float | None = None,
    nominal: float | None = None,
    off: float | None = None,
) -> Any:
    """A field of a `Component`: a number in `unit` between `minimum` and `maximum`, both accepted."""
    extra: dict[str, Any] = {"unit": unit, "nominal": nominal, "off": off}
    return Field(
        PydanticUndefined if default is None else default,
        ge=minimum,
        le=maximum,
        description=help,
        json_schema_extra=extra,
    )


def quantities(component: type[BaseModel]) -> Iterator[Quantity]:
    """The declared numbers of a component, in the order of declaration."""
    for name, field in component.model_fields.items():
        extra = field.json_schema_extra
        if not isinstance(extra, dict) or "unit" not in extra:
            continue
        minimum, maximum = (_bound(field.metadata, key) for key in ("ge", "le"))
        default = None if field.is_required() else field.default
        nominal = extra["nominal"] or default or max(abs(minimum), abs(maximum)) ** 0.5
        yield Quantity(name, extra["unit"], field.description, minimum, maximum, default, nominal, extra["off"])  # type: ignore[arg-type]


def _bound(metadata: list[Any], key: str) -> float:
    return float(next(getattr(item, key) for item in metadata if hasattr(item, key)))
