"""Parameters of a rope model, each declared once."""

from typing import Literal

from pydantic import Field, field_validator, model_validator

from ...quantities import Component, quantity
from .building import Building

DEFAULT_STEP = 0.004


class Shaft(Component):
    """The building; heights count from the bottom landing, up positive."""

    height: float = quantity("m", "travel from bottom to top landing", 1.0, 1000.0, nominal=50.0)
    pit: float = quantity("m", "sheave axle below the rope's end at the bottom landing, as built", 0.3, 20.0, nominal=1.5)
    gravity: float = quantity("m/s2", "acceleration of gravity", 1.0, 30.0, default=9.81)
    walls_follow: float = quantity(
        "1", "share of the lateral motion of the rope's ends, in proportion to the height above the axle, by which walls, "
        "brushes and guides move: 1 in a building that moves", 0.0, 1.0, default=0.0,
    )  # fmt: skip


class Rope(Component):
    """One equivalent rope; forces are per rope."""

    mass_per_length: float = quantity("kg/m", "mass per length", 0.05, 20.0, nominal=1.2)
    diameter: float = quantity("m", "outer diameter", 0.002, 0.1, nominal=0.018)
    axial_stiffness: float = quantity("N", "axial stiffness EA", 1e4, 1e9, nominal=8e6)
    bending_stiffness: float = quantity("N.m2", "bending stiffness EI", 0.0, 2000.0, nominal=20.0)
    axial_damping: float = quantity("N.s", "axial force per strain rate", 0.0, 1e6, nominal=2e3)
    bending_damping: float = quantity("N.m2.s", "bending moment per curvature rate", 0.0, 100.0, nominal=0.1)
    external_damping: float = quantity(
        "N.s/m2", "drag force per length and velocity, all directions", 0.0, 100.0, default=0.0, nominal=0.1
    )
    element_length: float = quantity(
        "m", "length of one element; adjusted so that whole elements give the rope's length", 0.005, 1.0, default=0.05
    )
    compression_ratio: float = quantity(
        "1", "axial stiffness in compression over that in tension; 1 for a rod that does not buckle", 1e-4, 1.0, default=1e-3
    )


class Sheave(Component):
    """Compensation sheave, free to move vertically and to rotate; `ropes` ropes carry equal shares of its mass and inertia.

    Forces, and torques and dampers of effects, are those of one rope. With `ropes` = 1 mass and inertia are one rope's share.
    """

    mass: float = quantity("kg", "mass", 0.1, 20000.0, nominal=120.0)
    radius: float = quantity("m", "radius to the rope's centre line", 0.05, 3.0, nominal=0.4)
    inertia: float = quantity("kg.m2", "moment of inertia about the axle", 1e-4, 1e5, nominal=10.0)
    limit_switch: float = quantity(
        "m", "travel of the axle, up or down from where it is built, at which its limit switch trips", 1e-3, 100.0, default=100.0
    )
    ropes: float = quantity("1", "ropes that share mass and inertia; forces are those of one rope", 1.0, 50.0, default=1.0)

    @field_validator("ropes")
    @classmethod
    def _whole(cls, ropes: float) -> float:
        if ropes != round(ropes):
            raise ValueError(f"{ropes:g} ropes; a whole number is accepted")
        return ropes

    @property
    def mass_per_rope(self) -> float:
        """Mass that one rope carries [kg]."""
        return self.mass / self.ropes

    @property
    def inertia_per_rope(self) -> float:
        """Moment of inertia that one rope turns [kg m2]."""
        return self.inertia / self.ropes


class Contact(Component):
    """Rope on groove, per metre of rope, so that the mesh does not change the physics."""

    stiffness: float = quantity("N/m2", "normal force per length and penetration", 1e4, 1e10, nominal=1.2e7)
    damping: float = quantity("N.s/m2", "normal force per length and penetration rate", 0.0, 1e7, nominal=8e3)
    friction_coefficient: float = quantity("1", "Coulomb friction of rope on groove", 0.0, 2.0, nominal=0.3)
    slip_velocity: float = quantity(
        "m/s", "slip velocity at which friction reaches 71 % of Coulomb's (regularisation)", 1e-4, 1.0, nominal=0.02
    )


class Solver(Component):
    """Time integration; the defaults are suitable for complete trips."""

    step: float = quantity("s", "largest time step", 1e-5, 0.02, default=DEFAULT_STEP)
    numerical_damping: float = quantity(
        "1", "HHT alpha: damping of high-frequency vibration; 0 is the paper's Newmark-beta rule", 0.0, 1.0 / 3.0, default=0.15
    )


class Sensor(Component):
    """A displacement sensor fixed in the shaft."""

    name: str = Field(pattern=r"^[A-Za-z][A-Za-z0-9_]*$", description="name of the sensor: letters, digits and underscores")
    side: Literal["car", "counterweight"] = Field(description="side of the rope on which it measures")
    height: float = quantity("m", "height above the bottom landing; negative in the pit", -20.0, 1000.0, nominal=10.0)


class Base(Component):
    """A rope model without effects: the parameters of the paper's eq. (1) and (2)."""

    shaft: Shaft
    rope: Rope
    sheave: Sheave
    contact: Contact
    solver: Solver = Solver()
    sensors: tuple[Sensor, ...] = ()
    building: Building | None = None

    @property
    def rope_length(self) -> float:
        """Natural length of the rope [m], which puts the axle `pit` below the bottom landing when unstretched."""
        return 2.0 * self.shaft.pit + self.shaft.height + 3.141592653589793 * self.sheave.radius

    @model_validator(mode="after")
    def _sensible(self) -> "Base":
        if self.rope.element_length > 0.5 * self.sheave.radius:
            raise ValueError(
                f"rope.element_length = {self.rope.element_length} m is too coarse for the sheave; "
                f"at most half of sheave.radius = {self.sheave.radius} m is accepted"
            )
        names = [sensor.name for sensor in self.sensors]
        if len(set(names)) < len(names):
            raise ValueError("sensors: each name may be given once")
        return self
