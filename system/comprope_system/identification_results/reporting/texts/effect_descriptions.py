"""What each effect means, in two sentences, a drawing of it, and its parameters in words."""

from collections.abc import Mapping

from comprope.quantities import quantities
from comprope.rope.effects import INSTRUMENT, REGISTRY

from ....identification.data.runs import Channel

MEANINGS = {
    "air_drag": (
        "Air resists the lateral motion of the rope, in proportion to the square of its speed. Large oscillations "
        "decay faster than small ones."
    ),
    "shaft_airflow": (
        "Air that the car drives through the shaft flows across the rope and deflects it. The deflection grows with "
        "the square of the car's speed and vanishes at rest."
    ),
    "bending_hysteresis": (
        "The wires of the rope rub against each other when it bends, so that bending and straightening follow "
        "different paths. The rope loses energy in each bend, however slowly it runs."
    ),
    "intrinsic_curvature": "The rope keeps a bend without load, as from its reel. It hangs away from the vertical, also at rest.",
    "sheave_eccentricity": (
        "The centre of the groove is off the axle of the sheave. Sheave and rope are moved once in each revolution."
    ),
    "bearing_friction": (
        "The bearings of the sheave resist its rotation. The two sides of the rope carry different tensions while the"
        " car moves."
    ),
    "guide_friction": (
        "The guides of the sheave rub and resist its vertical motion. Small motions stick, and the sheave stops off "
        "its equilibrium."
    ),
    "sheave_damper": (
        "A damper acts on the vertical motion of the sheave. Its vertical oscillations decay faster than the model "
        "says."
    ),
    "building_sway": (
        "The building sways and moves the ends of the rope sideways, more the higher they are. The rope is excited at"
        " one frequency, whether the car moves or not."
    ),
    "attachment_offset": (
        "An end of the rope is attached beside the vertical through the side of the sheave. The rope hangs at an "
        "angle that changes with the position of the car."
    ),
    "sheave_unbalance": (
        "A mass off the axle makes the sheave heavier on one side. Once in each revolution its weight speeds the sheave "
        "up and slows it down, and at speed its centrifugal force lifts the sheave."
    ),
    "jammed_seal": (
        "A seal of the sheave's bearing sticks to the shaft and is wound up. The tensions of the two sides of the rope "
        "differ the more, the further the car has gone from its start."
    ),
    "jammed_guide": (
        "A guide of the sheave resists the more, the further the sheave is from its place. Its vertical motions are "
        "smaller and faster than the model says."
    ),
    "sticky_guide": (
        "The guides of the sheave hold until a larger force breaks them away, and then slide with less. The sheave stands still, "
        "jumps, and stands still again."
    ),
    "sloped_guide": (
        "The guides of the sheave are inclined, so that it moves sideways as it rises and falls. Both sides of the rope "
        "are shifted the same way, towards the counterweight's side or the car's, together with the height of the sheave."
    ),
    "rope_brush": (
        "A brush or damper holds the rope sideways at a height in the shaft. The rope's oscillations decay faster and are smaller"
        " there, on one side only."
    ),
    "rope_guide": (
        "A guide, bracket or wall pushes the rope aside at a height in the shaft, and the rope rubs along it. Where it "
        "stands the rope cannot swing back, on one side only."
    ),
    "encoder_scale": (
        "The signal of the car's position shows more or less than the way of the car. The sheave turns more or less than "
        "the model says, in proportion to the distance of each trip."
    ),
    "sensor_gain": (
        "A channel shows values that are too large, too small or of the wrong sign. The rope itself moves as the "
        "model says."
    ),
    "sensor_offset": "A channel shows values shifted by a constant. The rope itself moves as the model says.",
    "sensor_delay": (
        "A channel shows its values too late or too early against the position of the car. The rope itself moves as "
        "the model says."
    ),
    "sensor_height": (
        "A laser looks at the rope higher or lower than stated, or is tilted. The channel shows what the model has there, and "
        "passages of the end under car or counterweight come early or late."
    ),
    "sensor_drift": "The zero of a channel drifts during a record. The rope itself moves as the model says.",
    "adequate": (
        "With refitted plant parameters the residual is explained by measurement noise. An effect that is smaller "
        "than its detection limit may still be there."
    ),
    "unknown": (
        "Something is missing, and none of the known effects explains the residual. The residual correlations and the"
        " estimated force below indicate what kind it is."
    ),
}

_ROPE = (
    '<path d="M42 16h36v26H42zM148 10h24v32h-24z" fill="var(--pale)" stroke="var(--soft)"/>'
    '<circle cx="110" cy="170" r="46" fill="var(--pale)" stroke="var(--soft)"/>'
    '<circle cx="110" cy="170" r="5" fill="var(--soft)"/>'
    '<path d="M60 42V170A50 50 0 0 0 160 170V42" stroke-width="4"/>'
)
_SENSOR = '<path d="M6 102L18 110L6 118Z" fill="var(--measured)" stroke="none"/><path d="M18 110H58" stroke-dasharray="4 3"/>'
_WAVE = '<path d="M80 82Q92 52 104 82T128 82T142 82" stroke="var(--soft)"/>'
# Drawn over the rope and its sheave, in a frame of 220 by 240; what is drawn is the effect, in another colour.
_DETAILS = {
    "air_drag": '<path d="M60 46Q94 106 60 166"/><path class="arrow" d="M120 90H88"/><path class="arrow" d="M120 106H88"/>'
    '<path class="arrow" d="M120 122H88"/>',
    "shaft_airflow": "".join(
        f'<path class="arrow" d="M{x} {y}H{x + way}"/>' for x, way in ((50, -32), (170, 32)) for y in (70, 94, 118, 142)
    ),
    "bending_hysteresis": '<path d="M84 86H138M111 52V118" stroke="var(--soft)"/>'
    '<path d="M88 114C90 76 112 90 134 58C132 96 110 82 88 114Z"/><path d="M60 150A50 50 0 0 0 74 206" stroke-width="7"/>',
    "intrinsic_curvature": '<path d="M60 44Q30 108 60 168"/><path d="M160 44Q190 108 160 168"/>',
    "sheave_eccentricity": '<circle cx="119" cy="163" r="46"/><circle cx="119" cy="163" r="3"/><path d="M110 170L119 163"/>'
    '<path class="arrow" d="M136 222A58 58 0 0 0 164 192"/>',
    "bearing_friction": '<circle cx="110" cy="170" r="12" stroke-width="5" stroke-dasharray="5 3"/>'
    '<path class="arrow" d="M84 170A26 26 0 0 1 110 144"/><path class="arrow" d="M136 170A26 26 0 0 1 110 196"/>',
    "guide_friction": '<path d="M96 128V214M124 128V214" stroke-width="4"/><path class="arrow" d="M84 190V158"/>'
    '<path class="arrow" d="M136 158V190"/>',
    "sheave_damper": '<path d="M110 175V204M99 204H121M94 196V214H126V196M110 214V232M92 232H128" stroke-width="3"/>',
    "building_sway": '<path class="both" d="M30 6H90"/><path class="both" d="M130 6H190"/><path d="M60 44Q84 106 60 168"/>'
    '<path d="M160 44Q184 106 160 168"/>',
    "attachment_offset": '<path d="M60 30V168" stroke="var(--soft)" stroke-dasharray="4 4"/>'
    '<path d="M32 42L60 168"/><path class="both" d="M32 58H60"/>',
    "sheave_unbalance": '<circle cx="132" cy="192" r="12" fill="var(--measured)"/><path d="M110 170L124 184"/>'
    '<path class="arrow" d="M136 222A58 58 0 0 0 164 192"/>',
    "jammed_seal": '<circle cx="110" cy="170" r="14" stroke-width="5"/>'
    '<path d="M110 170m24 0a24 24 0 1 1 -24 -24a32 32 0 0 1 32 32a38 38 0 0 1 -38 38"/>',
    "jammed_guide": '<path d="M96 128V214M124 128V214" stroke-width="4"/>'
    '<path d="M110 175V184L102 188L118 194L102 200L118 206L102 212L110 216V226M98 228H122" stroke-width="3"/>',
    "sticky_guide": '<path d="M96 128V214M124 128V214" stroke-width="4"/><path d="M84 86H138" stroke="var(--soft)"/>'
    '<path d="M84 86V56Q88 72 104 72H138"/>',
    "sloped_guide": '<path d="M84 124L108 224M112 120L136 220" stroke-width="4"/><path class="both" d="M70 116H128"/>',
    "rope_brush": '<path d="M196 96V124M196 98H162M196 106H162M196 114H162M196 122H162"/>',
    "rope_guide": '<path d="M148 86V134" stroke-width="8"/><path d="M160 44Q148 76 153 110T160 168"/>',
    "encoder_scale": '<path d="M20 42V160M14 42H26M14 62H26M14 84H26M14 108H26M14 134H26M14 160H26"/>'
    '<path class="both" d="M32 44V158"/>',
    "sensor_gain": f'{_SENSOR}{_WAVE}<path d="M80 82Q92 18 104 82T128 82T142 82"/>',
    "sensor_offset": f'{_SENSOR}{_WAVE}<path d="M80 64Q92 34 104 64T128 64T142 64"/>',
    "sensor_delay": f'{_SENSOR}{_WAVE}<path d="M89 82Q101 52 113 82T137 82"/>',
    "sensor_height": f'{_SENSOR}<path d="M18 110L58 84" /><path class="arrow" d="M30 110V92"/>',
    "sensor_drift": f'{_SENSOR}<path d="M82 96H140" stroke="var(--soft)"/><path d="M82 96L140 62"/>',
    "adequate": '<path d="M88 84L104 100L136 66" stroke="var(--good)" stroke-width="6"/>',
    "unknown": '<path d="M98 68A13 13 0 1 1 116 80Q110 84 110 94M110 104V105" stroke-width="5"/>',
}


def meaning(effect: str) -> str:
    """What an effect means; of an effect of the user, what its file says."""
    if effect in MEANINGS:
        return MEANINGS[effect]
    own = (REGISTRY[effect].__doc__ or "").strip().split("\n\n")[0] if effect in REGISTRY else INSTRUMENT.get(effect, "")
    return " ".join(own.split())


def drawing(effect: str) -> str:
    """An SVG of an effect, in the colours of the page; of an effect of the user, of the rope and its sheave alone."""
    tip = '<path d="M0 0L8 4L0 8Z" fill="var(--measured)" stroke="none"/>'
    marker = 'viewBox="0 0 8 8" refX="6" refY="4" markerWidth="5" markerHeight="5"'
    defined = f'<defs><marker id="tip" orient="auto-start-reverse" {marker}>{tip}</marker></defs>'
    name = effect.replace("_", " ")
    return (
        f'<svg class="drawing" viewBox="0 0 220 240" role="img" aria-label="Drawing: {name}">{defined}'
        f'<g fill="none" stroke="var(--ink)" stroke-width="1.5">{_ROPE}</g>'
        f'<g fill="none" stroke="var(--measured)" stroke-width="2.5" stroke-linecap="round">{_DETAILS.get(effect, "")}</g></svg>'
    )


def parameter_label(effect: str, name: str) -> str:
    """A parameter of an effect in words; that of a fault of an instrument names its channel."""
    if effect not in REGISTRY:
        return f"{effect.removeprefix('sensor_')} of {name}"
    return name.replace("_", " ").replace("coulomb", "Coulomb")


def parameter_unit(channels: Mapping[str, Channel], effect: str, name: str) -> str:
    """The SI unit of a parameter of an effect; that of a fault of an instrument depends on its channel."""
    if effect in REGISTRY:
        return next(one.unit for one in quantities(REGISTRY[effect]) if one.name == name)
    quantity = channels[name].quantity
    shown = {"sheave_angular_velocity": "rad/s"}.get(quantity, "m" if "displacement" in quantity else "N")
    return {"sensor_gain": "1", "sensor_delay": "s", "sensor_drift": f"{shown}/s", "sensor_height": "m"}.get(effect, shown)
