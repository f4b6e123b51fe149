"""The public function `comprope_system.building`: a synthetic record of a model's building."""

from comprope.errors import InputError

from ...presets.inputs import ModelInput, model_name, read_model
from ...presets.overrides import Changes
from .result import BuildingResult
from .synthetic_record import Kind, RecordOptions, synthetic_record

ELLIS = 46.0  # Hz m: first natural frequency of a building times its height: B. Ellis, Proc. ICE 69, 1980
HIGHEST = 1200.0  # m, of a building
PEAKS = {"earthquake": 0.3, "wind": 0.05}  # m/s2 of the ground, m of the top

__all__ = ["RecordOptions", "building"]


def building(
    model: ModelInput,
    kind: Kind = "earthquake",
    *,
    top: float | None = None,
    changes: Changes | None = None,
    options: RecordOptions | None = None,
    **others: float,
) -> BuildingResult:
    """Make a synthetic record of the building around a model's shaft, in a long-period earthquake or in wind.

    The building stands on the height of the sheave's axle and reaches to `top` [m] above the bottom landing, by default the top
    landing. `others` are fields of `RecordOptions`, by default a `period` of height / 46 Hz m and a `peak` of 0.3 m/s2 of the
    ground or 0.05 m of the top. Raises `InputError` for bad input.
    """
    given = read_model(model, changes)
    high, base = given.shaft.height if top is None else top, -given.shaft.pit
    if not given.shaft.height <= high <= HIGHEST:
        raise InputError(f"top = {high:g} m: from the top landing, at {given.shaft.height:g} m, to {HIGHEST:g} m is accepted")
    if options is None:
        usual = {"period": (high - base) / ELLIS, "peak": PEAKS.get(kind, 1.0)}
        options = RecordOptions(kind, **(usual | others))  # type: ignore[arg-type]
    return BuildingResult(model_name(model), given, options, synthetic_record(options, base, high))
