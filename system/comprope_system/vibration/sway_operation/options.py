"""Options of `comprope_system.sway`."""

from dataclasses import dataclass

from comprope.errors import InputError

from .parked_response import Sway

LIMITS = {  # least, largest, unit
    "amplitude": (1e-4, 5.0, " m"), "period": (0.2, 60.0, " s"), "floors": (2, 200, ""), "limit": (1e-4, 20.0, " m"),
    "duration": (1.0, 7200.0, " s"), "damping": (0.0, 0.5, ""), "positions": (2, 400, ""), "periods": (2, 400, ""),
    "verify": (0, 20, ""), "spread": (0.0, 0.5, ""),
}  # fmt: skip


@dataclass(frozen=True)
class SwayOptions:
    """Sway of the building, and what is asked of the rope in it.

    `amplitude` [m] at the top landing and `duration` [s]; `damping` ratio of the rope's modes; floors are listed at which the
    swing exceeds `limit` [m], with the building's `period` [s] for periods within `spread` of it. The map has so many car
    `positions` and `periods`; `verify` cells of it, the largest ones first, are simulated with the full model. `brackets` are
    pairs of height and outward distance from the vertical through the sheave's side [m]; trips through the whole shaft at
    `speeds` [m/s] are simulated in the building's `period`.
    """

    amplitude: float = 0.05
    period: float | None = None
    limit: float = 0.2
    floors: int = 11
    duration: float = 120.0
    damping: float = 0.005
    spread: float = 0.1
    positions: int = 31
    periods: int = 48
    verify: int = 2
    brackets: tuple[tuple[float, float], ...] = ()
    speeds: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        """Raises `InputError` with all values that are not accepted."""
        wrong = [
            f"{name} = {value:g}{unit}: {low:g} to {high:g}{unit} is accepted"
            for name, (low, high, unit) in LIMITS.items()
            if (value := getattr(self, name)) is not None and not low <= value <= high
        ]
        wrong += [
            f"brackets: {distance:g} m at {height:g} m; a distance of 0.01 to 20 m at -20 to 1000 m is accepted"
            for height, distance in self.brackets
            if not (0.01 <= distance <= 20.0 and -20.0 <= height <= 1000.0)
        ]
        wrong += [f"speeds: {one:g} m/s; 0.1 to 25 m/s is accepted" for one in self.speeds if not 0.1 <= one <= 25.0]
        if self.speeds and self.period is None:
            wrong.append("speeds: accepted with the period of the building")
        if wrong:
            raise InputError("\n".join(wrong))

    @property
    def sway(self) -> Sway:
        """Amplitude, duration and damping."""
        return Sway(self.amplitude, self.duration, self.damping)
