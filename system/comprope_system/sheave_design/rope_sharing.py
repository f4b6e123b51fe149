"""How ropes of unequal length and stiffness share one sheave, quasi-statically, as the car goes up and down.

All ropes turn with the sheave, which does not tilt. With the car at z the sides between ends and axle, at the depth x below the
bottom landing, are L_1 = z + x and L_2 = H - z + x long, for every rope. Rope i of the natural lengths n_1, n_2 pulls with

    N = max(0, EA_i (L - n) / L - rho g L / 2)      (small strain; half of the side's own weight hangs below its middle)

at the sheave, which is in balance: sum (N_1 + N_2) = M g, sum (N_1 - N_2) = 0 (free bearing). The turn of the sheave moves the
same length of every rope to the other side; a rope slides in its groove where N_1 / N_2 would pass e^(mu pi) or its inverse. At
first the ropes hang with N_1 = N_2. Equal ropes share equally; for ropes of equal EA, none slack and before any travel, that is

    N_i = N - EA (d_i - mean of d) / (L_1 + L_2)

for excess lengths d_i. Left out: tilt, inertia, bending, and what the rope on the sheave stretches.
"""

from dataclasses import dataclass
from math import exp, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, root

from comprope.errors import InputError, SimulationError
from comprope.rope.effects import RopeModel

Floats = NDArray[np.float64]

STEP = 0.01  # of the shaft's height, between the positions of the car
LARGEST_EXCESS = 1.0  # m of a rope's length
STIFFNESSES = (0.2, 5.0)  # ratios that are accepted
DEEPEST = 0.05  # of a side's length, by which ropes may stretch
BALANCED = 1e-6  # of the sheave's weight
REACH = 0.5  # m, depth or turn from one position of the car to the next, beyond the car's own way


@dataclass(frozen=True)
class RopeSet:
    """Ropes of one sheave: excess of each one's natural length over that of the model [m], and its EA over the model's."""

    excess: tuple[float, ...]
    stiffness: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        """Raises `InputError` with all values that are not accepted."""
        wrong = [f"rope_lengths: {one:g} m; -1 to 1 m is accepted" for one in self.excess if not abs(one) <= LARGEST_EXCESS]
        low, high = STIFFNESSES
        wrong += [f"rope_stiffness: {one:g}; {low:g} to {high:g} is accepted" for one in self.stiffness if not low <= one <= high]
        if not 2 <= len(self.excess) <= 50:
            wrong.append(f"rope_lengths: {len(self.excess)} ropes; 2 to 50 are accepted")
        if self.stiffness and len(self.stiffness) != len(self.excess):
            wrong.append(f"rope_stiffness: {len(self.stiffness)} values for {len(self.excess)} ropes; one for each is accepted")
        if wrong:
            raise InputError("\n".join(wrong))


@dataclass(frozen=True)
class RopeSharing:
    """Share of each rope in the sheave's weight (positions, ropes) with the car at `cars` [m], on the last way up and down.

    `depths` (positions,) [m] is the axle below the bottom landing; `pulls` (positions, side, ropes) [N] what each rope pulls with
    at the sheave on both sides, and `slip` (ropes,) [m] how far each one slides in its groove on that way.
    """

    cars: Floats
    depths: Floats
    pulls: Floats
    slip: Floats

    def to_json(self) -> dict[str, Any]:
        """Least and largest share of each rope in the sheave's weight, its largest pull [N] on one side, and its slip [m]."""
        shares, largest = self.shares, self.pulls.max(axis=(0, 1))
        return {
            "ropes": [
                {"least": float(low), "largest": float(high), "largest_pull": float(pull), "slip": float(slip)}
                for low, high, pull, slip in zip(shares.min(axis=0), shares.max(axis=0), largest, self.slip, strict=True)
            ],
            "cars": self.cars.tolist(), "shares": shares.tolist(),
        }  # fmt: skip

    @property
    def shares(self) -> Floats:
        """Share of each rope in the sheave's weight (positions, ropes)."""
        carried = self.pulls.sum(axis=1)
        return np.asarray(carried / carried.sum(axis=1, keepdims=True))


def share_sheave(model: RopeModel, ropes: RopeSet) -> RopeSharing:
    """How the ropes share the sheave's weight on a way of the car from the middle to the top, the bottom and back to the top.

    The sheave has the model's mass for one rope times their number. Raises `InputError` where no depth of the axle carries it.
    """
    balance = _Balance(model, ropes)
    height, count = model.shaft.height, round(1.0 / STEP)
    up = np.linspace(0.0, height, count + 1)
    balance.hang(0.5 * height)
    for car in up[up > 0.5 * height]:
        balance.move(float(car))
    cars, depths, pulls, slid = np.concatenate([up[-2::-1], up[1:]]), list[float](), list[Floats](), balance.slid.copy()
    for car in cars:
        balance.move(float(car))
        depths.append(balance.depth)
        pulls.append(balance.pulls)
    return RopeSharing(cars, np.array(depths), np.array(pulls), balance.slid - slid)


class _Balance:
    """Natural lengths of all ropes on both sides, and the sheave's depth, as the car moves."""

    def __init__(self, model: RopeModel, ropes: RopeSet) -> None:
        shaft, rope = model.shaft, model.rope
        self._height, self._weight = shaft.height, model.sheave.mass_per_rope * len(ropes.excess) * shaft.gravity
        self._EA = rope.axial_stiffness * np.array(ropes.stiffness or (1.0,) * len(ropes.excess))
        self._hanging = rope.mass_per_length * shaft.gravity
        self._natural = 2.0 * shaft.pit + shaft.height + np.array(ropes.excess)
        self._limit, self._pit = exp(model.contact.friction_coefficient * pi), shaft.pit
        self._sides = np.zeros((2, len(ropes.excess)))  # natural lengths
        self._car, self.depth, self.slid = 0.0, shaft.pit, np.zeros(len(ropes.excess))
        self.pulls = np.zeros_like(self._sides)

    def hang(self, car: float) -> None:
        """Hang all ropes with equal pulls on both sides."""
        whole = self._height + 2.0 * self._pit

        def pull(depth: float) -> Floats:
            first, second = self._lengths(car, depth)
            own = 0.5 * self._hanging * (first**2 + second**2) / (first + second)
            return np.maximum(self._EA * (1.0 - self._natural / (first + second)) - own, 0.0)

        least, most = self._pit - 0.5 * LARGEST_EXCESS, self._pit + 0.5 * LARGEST_EXCESS + DEEPEST * whole
        if 2.0 * pull(most).sum() < self._weight:
            raise InputError(
                f"rope_lengths: stretched by {100.0 * DEEPEST:g} % the ropes do not carry the sheave's {self._weight:.0f} N"
            )
        self._car, self.depth = car, float(brentq(lambda at: 2.0 * pull(at).sum() - self._weight, least, most, xtol=1e-12))
        lengths, found = self._lengths(car, self.depth), pull(self.depth)
        for side, length in enumerate(lengths):
            self._sides[side] = length * (1.0 - (found + 0.5 * self._hanging * length) / self._EA)
        spare = self._natural - self._sides.sum(axis=0)  # of slack ropes
        self._sides += 0.5 * spare
        self.pulls = np.array([found, found])

    def move(self, car: float) -> None:
        """Move the car to a height [m]: find depth and turn of the sheave at which it is in balance."""

        def unbalance(unknown: Floats) -> Floats:
            pulls, _ = self._pulls(car, unknown[0], unknown[1])
            return np.array([pulls.sum() - self._weight, pulls[0].sum() - pulls[1].sum()]) / self._weight

        found = root(unbalance, [self.depth, car - self._car], tol=1e-13)
        self.depth, turned = found.x if np.abs(found.fun).max() < BALANCED else self._bracketed(car)
        self.pulls, slides = self._pulls(car, self.depth, turned)
        self._sides += np.array([turned + slides, -turned - slides])
        self._car, self.slid = car, self.slid + np.abs(slides)

    def _bracketed(self, car: float) -> tuple[float, float]:
        """Depth and turn [m] of the balance where ropes go slack or slide: a root in a root, as both rise steadily."""

        def turn(depth: float) -> float:
            def torque(turned: float) -> float:
                pulls, _ = self._pulls(car, depth, turned)
                return float(pulls[0].sum() - pulls[1].sum())

            low, high = car - self._car - REACH, car - self._car + REACH
            return float(brentq(torque, low, high, xtol=1e-11)) if torque(low) * torque(high) < 0.0 else car - self._car

        def weight(depth: float) -> float:
            return float(self._pulls(car, depth, turn(depth))[0].sum()) - self._weight

        low, high = self.depth - REACH, self.depth + REACH
        if weight(low) * weight(high) > 0.0:
            raise SimulationError(f"rope_lengths: no balance of the sheave was found with the car at {car:.1f} m")
        depth = float(brentq(weight, low, high, xtol=1e-12))
        return depth, turn(depth)

    def _lengths(self, car: float, depth: float) -> tuple[float, float]:
        return car + depth, self._height - car + depth

    def _pulls(self, car: float, depth: float, turned: float) -> tuple[Floats, Floats]:
        """Pulls (side, ropes) [N] after a turn [m], and what slides to the first side to keep within friction (ropes,) [m]."""
        lengths = np.array(self._lengths(car, depth))[:, None]
        natural = self._sides + np.array([[turned], [-turned]])
        soft = self._EA / lengths
        raw = soft * (lengths - natural) - 0.5 * self._hanging * lengths
        slides = _slides(raw, soft, self._limit) - _slides(raw[::-1], soft[::-1], self._limit)
        return np.maximum(raw + soft * np.array([-slides, slides]), 0.0), slides


def _slides(raw: Floats, soft: Floats, limit: float) -> Floats:
    """Length (ropes,) [m] that slides to the first side, where it is pulled more than `limit` times as hard as the other one."""
    first, second = np.maximum(raw, 0.0)
    taut = (raw[0] - limit * raw[1]) / (soft[0] + limit * soft[1])  # both taut afterwards
    alone = raw[0] / soft[0]  # the second remains slack
    needed = np.where(raw[1] + soft[1] * alone <= 0.0, alone, taut)
    return np.where(first > limit * second, np.maximum(needed, 0.0), 0.0)
