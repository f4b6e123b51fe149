"""Forces, energies and powers of a rope on its sheave, written out anew with numpy from the equations in docs/theory.md.

The kernels sweep along the rope with workspaces and tangents; here every quantity is an array over nodes or elements, so that a
slip in one of the two does not repeat itself in the other. Effects are not part of it.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from comprope.rope.parameters import Base

SLACK_STRAIN = 1e-5  # over which a rope that is pushed loses its stiffness
SOFT = np.polynomial.Polynomial([1.0, -1.0]) ** 2 * np.polynomial.Polynomial([1.0, 2.0])
POINTS, FADE = 8, 1e-4  # quadrature points of a contact piece; penetration over which contact damping fades in [m]


@dataclass(frozen=True)
class ReferenceRope:
    """A rope at positions q and velocities v, each (2, n + 1) with x down, y towards the counterweight, the sheave last."""

    model: Base
    element: float
    q: np.ndarray
    v: np.ndarray

    @property
    def nodes(self) -> int:
        return self.q.shape[1] - 1

    # -- elements --------------------------------------------------------------------------------

    @cached_property
    def step(self) -> np.ndarray:
        return np.diff(self.q[:, :-1], axis=1)

    @cached_property
    def length(self) -> np.ndarray:
        return np.hypot(*self.step)

    @cached_property
    def tangent(self) -> np.ndarray:
        return self.step / self.length

    @cached_property
    def normal(self) -> np.ndarray:
        return np.array([-self.tangent[1], self.tangent[0]])

    @cached_property
    def stretching(self) -> np.ndarray:
        """Rate of each element's length [m/s]."""
        return (self.tangent * np.diff(self.v[:, :-1], axis=1)).sum(0)

    @cached_property
    def elastic(self) -> np.ndarray:
        """Tension without its damping."""
        return self.carried(self.model.rope.axial_stiffness * (self.length / self.element - 1.0))

    @cached_property
    def tension(self) -> np.ndarray:
        rope = self.model.rope
        strain, rate = self.length / self.element - 1.0, self.stretching / self.element
        return self.carried(rope.axial_stiffness * strain + rope.axial_damping * rate)

    def carried(self, rod: np.ndarray) -> np.ndarray:
        """What a rope carries where a rod carries `rod`: its slope falls from 1 to r over X_s as (1 - z)^2 (1 + 2 z)."""
        r, most = self.model.rope.compression_ratio, SLACK_STRAIN * self.model.rope.axial_stiffness
        z = np.maximum(-rod / most, 0.0)
        soft = SOFT.integ()(np.minimum(z, 1.0))
        return np.where(rod >= 0.0, rod, -most * (r * z + (1.0 - r) * soft))

    # -- bending of the inner nodes --------------------------------------------------------------

    @cached_property
    def curvature(self) -> np.ndarray:
        return np.diff(np.unwrap(np.arctan2(self.tangent[1], self.tangent[0]))) / self.element

    @cached_property
    def curving(self) -> np.ndarray:
        """Rate of the curvature [1/(m s)]."""
        spin = (self.normal * np.diff(self.v[:, :-1], axis=1)).sum(0) / self.length
        return np.diff(spin) / self.element

    @cached_property
    def element_force(self) -> np.ndarray:
        """Force (2, n - 1) of each element: tension along it, and shear from the difference of the moments at its nodes."""
        rope = self.model.rope
        moment = np.zeros(self.nodes)
        moment[1:-1] = rope.bending_stiffness * self.curvature + rope.bending_damping * self.curving
        return self.tension * self.tangent - np.diff(moment) / self.length * self.normal

    # -- contact ---------------------------------------------------------------------------------

    @cached_property
    def contact(self) -> tuple[np.ndarray, dict[str, float]]:
        """Contact forces (2, n + 1), and powers and energy by name; pieces are quadratic B-splines of three nodes."""
        law, radius = self.model.contact, self.model.sheave.radius
        held = radius - self.element**2 / (12.0 * radius)
        xi = (np.arange(POINTS) + 0.5) / POINTS - 0.5
        shape = np.array([0.5 * (0.5 - xi) ** 2, 0.75 - xi**2, 0.5 * (0.5 + xi) ** 2])
        triples = np.stack([np.arange(k, self.nodes - 2 + k) for k in range(3)])
        place, velocity = (
            np.einsum("cki,kg->cig", array[:, triples], shape) - np.array([array[0, -1], 0.0])[:, None, None]
            for array in (self.q, self.v)
        )
        distance = np.hypot(*place)
        out = place / distance
        along = np.array([-out[1], out[0]])
        depth, rate = np.maximum(held - distance, 0.0), -(out * velocity).sum(0)
        slip = (along * velocity).sum(0) + self.v[1, -1] * held
        elastic = law.stiffness * depth
        pressure = np.where(depth > 0.0, np.maximum(elastic + law.damping * depth / (depth + FADE) * rate, 0.0), 0.0)
        grip = law.friction_coefficient * slip / np.hypot(slip, law.slip_velocity)
        share = self.element / POINTS
        force = share * pressure * (out - grip * along)
        found = np.zeros((2, self.nodes + 1))
        for k in range(3):
            np.add.at(found, (slice(None), triples[k]), (force * shape[k]).sum(2))
        found[0, -1] = -force[0].sum()
        found[1, -1] = -(share * pressure * grip * held).sum()
        sums = {
            "contact": 0.5 * share * law.stiffness * (depth**2).sum(),
            "contact_damping": share * ((pressure - elastic) * rate)[depth > 0.0].sum(),
            "friction": share * (pressure * grip * slip).sum(),
        }
        return found, sums

    # -- the whole -------------------------------------------------------------------------------

    @cached_property
    def masses(self) -> np.ndarray:
        """Masses (2, n + 1) [kg]: half an element's at the ends; the sheave's inertia for its angle."""
        rope, sheave = self.model.rope, self.model.sheave
        node = np.full(self.nodes, rope.mass_per_length * self.element)
        node[[0, -1]] *= 0.5
        return np.array([[*node, sheave.mass], [*node, sheave.inertia]])

    @cached_property
    def weights(self) -> np.ndarray:
        return np.vstack([self.masses[0] * self.model.shaft.gravity, np.zeros(self.nodes + 1)])

    @cached_property
    def forces(self) -> np.ndarray:
        """Right-hand sides (2, n + 1) of the equations of motion."""
        found = self.weights + self.contact[0]
        found[:, : self.nodes - 1] += self.element_force
        found[:, 1 : self.nodes] -= self.element_force
        found[:, 1 : self.nodes - 1] -= self.model.rope.external_damping * self.element * self.v[:, 1 : self.nodes - 1]
        return found

    def stored(self) -> dict[str, float]:
        """Stored energies [J]; the weight's is zero at the bottom landing."""
        rope, moving = self.model.rope, 0.5 * self.masses * self.v**2
        return {
            "kinetic": float(moving[:, :-1].sum()),
            "gravity": float(-(self.weights * self.q).sum()),
            "tension": float(self.stretched().sum() * self.element),
            "bending": float(0.5 * rope.bending_stiffness * (self.curvature**2).sum() * self.element),
            "contact": float(self.contact[1]["contact"]),
            "sheave": float(moving[:, -1].sum()),
        }

    def stretched(self) -> np.ndarray:
        """Elastic energy per length of each element [J/m], the integral of its force over its strain."""
        stiffness, r = self.model.rope.axial_stiffness, self.model.rope.compression_ratio
        most, rod = SLACK_STRAIN * stiffness, stiffness * (self.length / self.element - 1.0)
        z = np.maximum(-rod / most, 0.0)
        soft = SOFT.integ().integ()(np.minimum(z, 1.0)) + 0.5 * np.maximum(z - 1.0, 0.0)
        return np.where(rod >= 0.0, 0.5 * rod**2 / stiffness, most * SLACK_STRAIN * (0.5 * r * z**2 + (1.0 - r) * soft))

    def losses(self) -> dict[str, float]:
        """What each damping takes out [W]."""
        rope = self.model.rope
        return {
            "axial_damping": float(((self.tension - self.elastic) * self.stretching).sum()),
            "bending_damping": float(rope.bending_damping * (self.curving**2).sum() * self.element),
            "external_damping": float(rope.external_damping * self.element * (self.v[:, 1 : self.nodes - 1] ** 2).sum()),
            "contact_damping": float(self.contact[1]["contact_damping"]),
            "friction": float(self.contact[1]["friction"]),
        }

    def holders(self, acceleration: np.ndarray) -> np.ndarray:
        """Forces (2, 2) that car and counterweight exert on the rope's ends, which accelerate with (2, n + 1)."""
        ends = [0, self.nodes - 1]
        return (self.masses * acceleration - self.forces)[:, ends]
