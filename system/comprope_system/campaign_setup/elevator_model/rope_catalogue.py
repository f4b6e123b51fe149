"""Mass and stiffness of a stranded steel rope from its diameter and construction, and how well they are known.

Mass m = W d^2 / 100 and metallic area A = C d^2, with m in kg/m, A in mm^2 and d in mm, and factors W and C by class of the rope
(EN 12385-4; K. Feyrer, Wire Ropes, 2nd ed. 2015, table 1.9). The axial stiffness is the rope's modulus of elasticity times A.
The bending stiffness lies between wires that slide freely, 1.1e7 to 2.2e7 N/m^2 d^4, and half of that of bonded wires, 260 to
430 times as much: between them the geometric mean is taken, which either limit exceeds by a factor of 13.
"""

import re
from dataclasses import dataclass

from comprope.errors import InputError

from ...measurements.files.raw_table import printable

CONSTRUCTION = re.compile(r"(?P<strands>\d{1,2})\s*[x×*]\s*(?P<wires>\d{1,3})(?P<words>[A-Za-z\s+-]*)", re.IGNORECASE)
CORES = {
    "fibre": ("FC", "NFC", "SFC", "FIBRE", "FIBER", "HEMP", "SISAL"),
    "steel": ("IWRC", "IWR", "PWRC", "EPIWRC", "IWSC", "WSC", "SC", "STEEL"),
}
WIRES = {7: range(5, 10), 19: range(15, 27), 36: range(27, 58)}  # in a strand, by class (EN 12385-2)
FACTORS = {  # W and C of fibre and steel core, by strands and class
    (6, 7): {"fibre": (0.345, 0.369), "steel": (0.384, 0.432)},
    (8, 7): {"fibre": (0.327, 0.335), "steel": (0.391, 0.439)},
    (6, 19): {"fibre": (0.359, 0.384), "steel": (0.400, 0.449)},
    (8, 19): {"fibre": (0.340, 0.349), "steel": (0.407, 0.457)},
    (6, 36): {"fibre": (0.367, 0.393), "steel": (0.409, 0.460)},
    (8, 36): {"fibre": (0.348, 0.357), "steel": (0.417, 0.468)},
}
MODULUS = {"fibre": 7.0e10, "steel": 9.5e10}  # Pa, of ropes at the low tension of compensation ropes
BENDING = 2.1e8  # N/m^2, geometric mean of 1.6e7 and half of 345 times that
MASS_TOLERANCE = 0.1  # data sheets differ from the rope as delivered and greased
AXIAL_TOLERANCE = 0.3  # the modulus depends on tension and age: 50 to 90 GPa with a fibre core, 70 to 120 GPa with a steel one
BENDING_TOLERANCE = 2.0  # a factor of three: the limits lie beyond two standard deviations
AXIAL_DAMPING = 2.5e-4  # s, over the axial stiffness, that of the test tower's model
BENDING_DAMPING = 5e-3  # s, over the bending stiffness, the same
ACCEPTED = "6 or 8 strands of 7 to 57 wires with the core are accepted, such as 8x19-FC (fibre core) or 6x36-IWRC (steel core)"


@dataclass(frozen=True)
class Estimate:
    """An estimated parameter: its value in the unit of the model file, one standard deviation relative to it, and its origin.

    `tolerance` None is that of every fit.
    """

    value: float
    tolerance: float | None
    origin: str


def catalogue_rope(diameter: float, construction: str) -> dict[str, Estimate]:
    """Parameters of a rope by key of the model file's `[rope]`, from its diameter [m] and a construction such as "8x19-FC".

    Raises `InputError` for a construction that has no factors here.
    """
    strands, wires, core = _class(construction)
    mass, area = FACTORS[strands, wires][core]
    d = 1e3 * diameter
    axial, bending = MODULUS[core] * area * d**2 * 1e-6, BENDING * diameter**4
    named = f"{strands}x{wires} class with {core} core"
    return {key: Estimate(float(f"{one.value:.4g}"), one.tolerance, one.origin) for key, one in {
        "mass_per_length": Estimate(mass * d**2 / 100.0, MASS_TOLERANCE, f"W = {mass:g} of the {named}, EN 12385-4"),
        "axial_stiffness": Estimate(axial, AXIAL_TOLERANCE, f"C = {area:g} of that class and {MODULUS[core] / 1e9:g} GPa"),
        "bending_stiffness": Estimate(bending, BENDING_TOLERANCE, "between wires that slide freely and wires that are bonded"),
        "axial_damping": Estimate(AXIAL_DAMPING * axial, None, "the test tower's, in proportion to the stiffness"),
        "bending_damping": Estimate(BENDING_DAMPING * bending, None, "the test tower's, in proportion to the stiffness"),
    }.items()}  # fmt: skip


def _class(construction: str) -> tuple[int, int, str]:
    """Strands, class by wires in a strand, and core, "fibre" or "steel"."""
    shown = printable(construction, 40)
    match = CONSTRUCTION.fullmatch(construction.strip())
    if match is None:
        raise InputError(f'"{shown}": {ACCEPTED}')
    strands, count = int(match["strands"]), int(match["wires"])
    wires = next((one for one, counts in WIRES.items() if count in counts), 0)
    words = match["words"].upper().replace("+", " ").replace("-", " ").strip()  # the kind of strands and the core: "S FC", "FFC"
    core = next((one for one, names in CORES.items() if words.endswith(names)), None)
    if (strands, wires) not in FACTORS or core is None:
        missing = "no core is named; " if (strands, wires) in FACTORS else ""
        raise InputError(f'"{shown}": {missing}{ACCEPTED}')
    return strands, wires, core
