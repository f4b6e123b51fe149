"""Units as FMI defines them: powers of SI base units."""

from collections import Counter

from ..errors import InputError

SYMBOLS: dict[str, dict[str, int]] = {
    "1": {},
    "kg": {"kg": 1},
    "m": {"m": 1},
    "s": {"s": 1},
    "K": {"K": 1},
    "rad": {"rad": 1},
    "Hz": {"s": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "W": {"kg": 1, "m": 2, "s": -3},
}

DISPLAY: dict[str, tuple[str, float]] = {
    "mm": ("m", 1e3),
    "ms": ("s", 1e3),
    "kN": ("N", 1e-3),
    "deg": ("rad", 57.29577951308232),
}


def exponents(unit: str) -> dict[str, int]:
    """Powers of the base units in a unit such as `N.s/m2`; raises `InputError` for one that is not known.

    Symbols are joined by dots, those after the slash divide, and a digit after a symbol is its power.
    """
    powers: Counter[str] = Counter()
    over, _, under = unit.partition("/")
    for part, sign in ((over, 1), *([(under, -1)] if "/" in unit else [])):
        for factor in part.split("."):
            symbol = factor.rstrip("23456789") or factor
            if symbol not in SYMBOLS:
                raise InputError(
                    f"unit {unit}: {factor!r} is not known; known are {', '.join(SYMBOLS)} and their products and powers"
                )
            times = sign * int(factor[len(symbol) :] or 1)
            for base, power in SYMBOLS[symbol].items():
                powers[base] += times * power
    return {base: power for base, power in powers.items() if power}


def display_factor(display_unit: str, unit: str) -> float:
    """Factor from a unit to a display unit; raises `InputError` if they are of different dimension."""
    base, factor = DISPLAY.get(display_unit, ("", 0.0))
    if base != unit:
        raise InputError(f"display unit {display_unit}: not one of {unit}; known are {', '.join(DISPLAY)}")
    return factor
