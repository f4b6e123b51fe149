"""The public function `comprope_system.modes`: natural periods and shapes of the rope at rest."""

from comprope.errors import InputError
from comprope.rope.simulator.rope import CompensationRope

from ...presets.inputs import ModelInput, model_name, read_model
from ...presets.overrides import Changes
from .linearisation import linearise
from .modes import modes as natural_modes
from .result import ModesResult
from .sheave_resonance import sheave_resonances


def modes(model: ModelInput, car_position: float = 0.0, count: int = 10, *, changes: Changes | None = None) -> ModesResult:
    """Natural periods and shapes of the rope about its static equilibrium.

    `model` is a model file, a preset's name or a `RopeModel`; `car_position` is the car's height above the bottom landing [m],
    `count` the number of modes, slowest first; `changes` are values by key, `{"sheave.mass": 90.0}`. Raises `InputError` for
    bad input, `SimulationError` where no static equilibrium is found.
    """
    changed = read_model(model, changes)
    if not 0.0 <= car_position <= changed.shaft.height:
        raise InputError(f"car_position = {car_position:g} m: 0 to shaft.height = {changed.shaft.height:g} m is accepted")
    if count < 1:
        raise InputError(f"count = {count}: a whole number from 1 is accepted")
    found = natural_modes(changed, car_position, count)
    rope = CompensationRope(changed)
    rope.solve_equilibrium(car_position, changed.shaft.height - car_position)
    resonances = sheave_resonances(rope, linearise(rope))
    return ModesResult(found.car, found.heights, found.modes, changed, model_name(model), resonances)
