"""Parameters of an effect that can be moved by hand, and the values at which it is replayed for a preview."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from ..prediction.effect_hypotheses import Hypothesis
from ..prediction.parameter_point import ParameterPoint
from ..settings import PREVIEW
from .interpolation import NodeLines


@dataclass(frozen=True)
class Slider:
    """A parameter [SI] by its model key, with its nodes in order; `centre` is the number of the node at the present value.

    `others` are changes of further parameters per unit of this one: of an effect that is moved as a whole.
    """

    key: str
    nodes: tuple[float, ...]
    centre: int
    others: Mapping[str, float] = field(default_factory=dict)

    @property
    def value(self) -> float:
        """The present value."""
        return self.nodes[self.centre]

    def changes(self, value: float, effects: Mapping[str, float]) -> dict[str, float]:
        """Parameters that differ from those of `effects` where this one has another value."""
        moved = {key: effects[key] + amount * (value - self.value) for key, amount in self.others.items()}
        return {self.key: value} | moved


def moved(point: ParameterPoint, sliders: Sequence[Slider], values: Sequence[float]) -> ParameterPoint:
    """The point with the sliders at some values."""
    effects = dict(point.effects)
    for one, value in zip(sliders, values, strict=True):
        effects |= one.changes(value, point.effects)
    return replace(point, effects=effects)


def node_lines(sliders: Sequence[Slider]) -> NodeLines:
    """The nodes of the sliders."""
    return NodeLines(tuple(one.nodes for one in sliders), tuple(one.centre for one in sliders))


def sliders_of(parts: Sequence[tuple[Hypothesis, Sequence[float]]]) -> list[Slider]:
    """At most two sliders for effects with their coefficients: one for each parameter, else one for each effect as a whole.

    A parameter too small to matter has none and stays as it is.
    """
    single = [one for part, own in parts for one in _by_parameter(part, own)]
    whole = [one for part, own in parts if (one := _as_a_whole(part, own))]
    return single if 0 < len(single) <= PREVIEW.max_sliders else whole[: PREVIEW.max_sliders]


def _by_parameter(part: Hypothesis, own: Sequence[float]) -> list[Slider]:
    """A slider for each parameter of an effect; an amplitude with a phase is moved at this phase."""
    if part.polar:
        return [one for one in [_as_a_whole(part, own)] if one]
    found = []
    for direction, c in zip(part.directions, own, strict=True):
        if abs(c) >= PREVIEW.least_coefficient and len(direction.changes) == 1:
            ((key, size),) = direction.changes.items()
            found.append(Slider(key, *_nodes(part.base, size * c, size * (direction.lower if c < 0 else direction.upper))))
    return found


def _as_a_whole(part: Hypothesis, own: Sequence[float]) -> Slider | None:
    """One slider that moves all parameters of an effect in proportion; None for an effect of no size."""
    values = part.parameters(list(own))
    keys = {key for one in part.directions for key in one.changes} - {part.polar[1] if part.polar else ""}
    sizes = {key: values[key] - part.base for key in keys if values[key] != part.base}
    if not sizes:
        return None
    scale = {key: max(abs(one.changes[key]) for one in part.directions if key in one.changes) for key in sizes}
    first = max(sizes, key=lambda key: abs(sizes[key]) / scale[key])
    others = {key: size / sizes[first] for key, size in sizes.items() if key != first}
    return Slider(first, *_nodes(part.base, sizes[first], PREVIEW.reach[-1] * sizes[first]), others)


def _nodes(base: float, size: float, limit: float) -> tuple[tuple[float, ...], int]:
    """Nodes from without the effect to beyond its size, as far as the limit allows, and the number of the present one."""
    beyond = abs(PREVIEW.reach[-1] * size) <= abs(limit)
    shares, centre = (PREVIEW.reach, PREVIEW.reach.index(1.0)) if beyond else (PREVIEW.reach_at_limit, -1)
    return tuple(base + share * size for share in shares), centre % len(shares)
