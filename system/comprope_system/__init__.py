"""Lateral vibration of elevator compensation ropes, for scripts and notebooks: simulate, compare, diagnose, improve, tune.

    import comprope_system

    result = comprope_system.compare("campaign")
    print(result.summary())
    result.save_html("compare.html")

Each function returns one result object with its fields, `summary()`, `to_json()`, `to_dataframe()` and `save_html(path)`; in a
notebook it shows a short table. Functions print nothing and write nothing. Bad input raises `comprope.errors.InputError`, a
computation that fails `comprope.errors.SimulationError`. Modules are imported when a function is used first.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .campaign_setup.workflow import new
    from .identification_results.workflow import add, check, compare, diagnose, improve
    from .sheave_design.workflow import BuildingSway, DesignOptions, RopeSet, design
    from .simulation.building_motion.workflow import RecordOptions, building
    from .simulation.fmu_export.workflow import fmu
    from .simulation.trips.workflow import CarMotion, Stop, simulate
    from .tuning.workflow import TuningOptions, tune
    from .vibration.modal.workflow import modes
    from .vibration.sway_operation.workflow import SwayOptions, sway

__all__ = [
    "BuildingSway", "CarMotion", "DesignOptions", "RecordOptions", "RopeSet", "Stop", "SwayOptions", "TuningOptions",
    "add", "building", "check", "compare", "design", "diagnose", "fmu", "improve", "modes", "new", "simulate", "sway", "tune",
]  # fmt: skip
_MODULES = {
    "simulation.building_motion": ("RecordOptions", "building"),
    "campaign_setup": ("new",),
    "simulation.fmu_export": ("fmu",),
    "identification_results": ("add", "check", "compare", "diagnose", "improve"),
    "vibration.modal": ("modes",),
    "sheave_design": ("BuildingSway", "DesignOptions", "RopeSet", "design"),
    "simulation.trips": ("CarMotion", "Stop", "simulate"),
    "vibration.sway_operation": ("SwayOptions", "sway"),
    "tuning": ("TuningOptions", "tune"),
}


def __getattr__(name: str) -> Any:
    for package, names in _MODULES.items():
        if name in names:
            value = getattr(import_module(f"{__name__}.{package}.workflow"), name)
            globals()[name] = value
            return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
