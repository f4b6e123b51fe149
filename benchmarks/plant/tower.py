"""What the plant is: one record of numbers, all effects off unless given."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
GRAVITY = 9.81
ELEMENT = 0.01


class Tower(NamedTuple):
    """A tower in SI units, by default that of 50 m. x points down from the bottom landing, y from the car's side to the other."""

    height: float = 50.0
    pit: float = 1.5
    mass_per_length: float = 1.2
    diameter: float = 0.018
    EA: float = 8.0e6
    EI: float = 20.0
    axial_damping: float = 2.0e3
    bending_damping: float = 0.1
    sheave_mass: float = 120.0
    radius: float = 0.4
    inertia: float = 9.6
    contact_stiffness: float = 1.2e7
    contact_damping: float = 8.0e3
    friction: float = 0.3
    slip_velocity: float = 0.02
    element: float = ELEMENT  # made to divide the rope's length when the rope is laid out
    # the rope's own effects
    drag: float = 0.0  # drag coefficient
    air_density: float = 1.2
    crossflow: float = 0.0  # outward air velocity over the car's
    dahl_moment: float = 0.0
    dahl_curvature: float = 0.1
    set_curvature: float = 0.0
    # the sheave's
    eccentricity: float = 0.0
    eccentric_phase: float = 0.0
    crept: float = 0.0  # rad, how far the sheave, at its full mass, has crept towards its stable place while the car stood
    bearing_coulomb: float = 0.0
    bearing_viscous: float = 0.0
    guide_coulomb: float = 0.0
    guide_damping: float = 0.0
    breakaway: float = 0.0  # Stribeck: static friction beyond Coulomb's, gone above `stribeck_velocity`
    stribeck_velocity: float = 2e-3
    unbalance: float = 0.0  # kg m
    unbalance_phase: float = 0.0
    seal_stiffness: float = 0.0  # N m / rad
    guide_slope: float = 0.0  # sideways per downward motion of the sheave
    # what touches the rope in the shaft: side -1 car, +1 counterweight; heights from the bottom landing
    brush_side: float = 1.0
    brush_height: float = 5.0
    brush_stiffness: float = 0.0  # N/m, spread over 0.2 m, about the vertical through the sheave's side
    brush_damping: float = 0.0
    wall_side: float = 1.0
    wall_height: float = 5.0
    wall_distance: float = 0.0  # outward; the rope may not come further in
    wall_stiffness: float = 0.0  # N/m2 over 1 m of height
    wall_friction: float = 0.0

    @property
    def rope_length(self) -> float:
        """Natural length [m]."""
        return 2.0 * self.pit + self.height + math.pi * self.radius

    def with_sheave(self, share: float) -> "Tower":
        """The tower with a share of the sheave's mass and inertia; a lighter sheave has crept less."""
        mass = share * self.sheave_mass
        phase = self.eccentric_phase + self.crept * mass / self.sheave_mass * math.sin(self.eccentric_phase)
        return self._replace(sheave_mass=mass, inertia=share * self.inertia, eccentric_phase=phase)

    def discretised(self) -> tuple["Tower", int]:
        """The tower with an element that divides the rope's length, and the number of nodes."""
        count = round(self.rope_length / self.element)
        return self._replace(element=self.rope_length / count), count + 1
