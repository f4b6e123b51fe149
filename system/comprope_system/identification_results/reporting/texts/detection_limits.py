"""Effects that the data of a diagnosis could not have shown at their typical sizes."""

from comprope.quantities import quantities
from comprope.rope.effects import REGISTRY

from ....identification.diagnosis.diagnose import Candidate, Diagnosis
from ....identification.diagnosis.held_out_validation import effects_of
from .effect_descriptions import parameter_label
from .formatting import in_handy_unit, listed_words


def undetectable(found: Diagnosis) -> list[str]:
    """Effects other than the verdict's whose detection limit is above their typical size, with the limit, as texts."""
    verdict = effects_of(found.ranking[0].hypothesis) if found.verdict else []
    return [text for one in found.ranking if one.hypothesis.effect not in verdict for text in _limit_above_nominal(one)]


def detection_sentence(found: Diagnosis) -> str:
    """What an adequate model may still lack without these data showing it."""
    if unseen := undetectable(found):
        return f"These data would not have shown {listed_words(unseen)}."
    return "Each known effect would have been seen at its typical size."


def _limit_above_nominal(one: Candidate) -> list[str]:
    """The first detection limit of an effect, as text, if none of its parameters would be seen at its nominal value."""
    effect = one.hypothesis.effect
    if one.hypothesis.parts or effect not in REGISTRY:
        return []
    declared = {quantity.name: quantity for quantity in quantities(REGISTRY[effect])}
    limits = {key.split(".", 2)[2]: limit for key, limit in one.detection_limits.items()}
    sizes = {declared[name]: limit for name, limit in limits.items() if name in declared and name != "phase"}
    if not sizes or any(limit <= abs(quantity.nominal) for quantity, limit in sizes.items()):
        return []
    quantity, limit = next(iter(sizes.items()))
    (size,) = in_handy_unit(quantity.unit, limit)
    return [f"{effect.replace('_', ' ')} below {parameter_label(effect, quantity.name)} {size}"]
