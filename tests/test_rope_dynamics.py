"""The rope in motion: frequencies, the accelerating sheave, orders of convergence, energy, and repeatability."""

from functools import cache
from itertools import pairwise, product
from math import pi, sqrt

import numpy as np
import pytest
from scipy.optimize import brentq, least_squares
from scipy.special import j0, y0

from comprope.drive.parameters import Profile
from comprope.drive.trajectory.s_curve import TrajectoryPoint, plan_s_curve
from comprope.errors import SimulationError
from comprope.rope.parameters import Sensor
from comprope.rope.simulator.cosimulation import create, interface
from comprope.rope.simulator.rope import CompensationRope

from .rope_tower import TOWER, ride, rope, way

G = TOWER.shaft.gravity
RHO = TOWER.rope.mass_per_length
SHORT = plan_s_curve(Profile(), 20.0, 26.0, 0.5)  # 2 m/s at most; all accelerations join smoothly


@cache
def ridden(
    origin: float, destination: float, until: float, changes: tuple[tuple[str, float], ...] = ()
) -> tuple[CompensationRope, np.ndarray]:
    """The rope after a trip from rest, and its coordinates every 16 ms."""
    moving, trip = rope(dict(changes)), plan_s_curve(Profile(), origin, destination, 0.5)
    moving.solve_equilibrium(origin, moving.model.shaft.height - origin)
    rows = []
    for _ in range(round(until / 0.016)):
        ride(moving, trip, 0.016)
        rows.append(moving.state.q.copy())
    return moving, np.array(rows)


def short_trip(**changes: float) -> tuple[CompensationRope, np.ndarray]:
    """The trip from 20 m to 26 m, 8 s, with values such as `solver__step` changed."""
    return ridden(20.0, 26.0, 8.0, tuple((key.replace("__", "."), value) for key, value in changes.items()))


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


# -- vibration -----------------------------------------------------------------------------------


def string_frequencies(tension: float, length: float, count: int) -> list[float]:
    """Angular frequencies of a string hung at both ends, tension T + rho g s: Bessel functions of order zero."""

    def mismatch(w: float) -> float:
        low, top = (2.0 * w / G * sqrt((tension + RHO * G * s) / RHO) for s in (0.0, length))
        return float(j0(low) * y0(top) - j0(top) * y0(low))

    grid = np.linspace(0.05, 12.0, 2400).tolist()
    brackets = [(a, b) for a, b in pairwise(grid) if mismatch(a) * mismatch(b) < 0.0]
    return [brentq(mismatch, *bracket) for bracket in brackets[:count]]


def plucked(changes: dict[str, float], until: float, height: float) -> np.ndarray:
    """Displacement at a height every 20 ms after the counterweight's end has moved aside by 10 mm in half a second."""
    moving = rope({"rope.bending_damping": 0.0, "solver.numerical_damping": 0.0} | changes)
    moving.solve_equilibrium(0.0, 50.0)
    path, rows = way(TOWER.sheave.radius, 50.0, TrajectoryPoint(0.0), TrajectoryPoint(0.0)).reshape(4, 6), []
    path[3, 3] += 0.01
    moving.step(0.5, path.ravel())
    path[:, :3] = path[:, 3:]
    for _ in range(round(until / 0.02)):
        moving.step(0.02, path.ravel())
        rows.append(moving.lateral_displacement("counterweight", height)[0])
    return np.array(rows)


def fitted_frequencies(seen: np.ndarray, guess: list[float]) -> np.ndarray:
    """Angular frequencies of the sum of sines that comes nearest to samples 20 ms apart."""
    t = 0.02 * np.arange(seen.size)

    def left_over(w: np.ndarray) -> np.ndarray:
        basis = np.column_stack([np.ones_like(t), t, *np.sin(np.outer(w, t)), *np.cos(np.outer(w, t))])
        return seen - basis @ np.linalg.lstsq(basis, seen, rcond=None)[0]

    return least_squares(left_over, guess, x_scale=0.01, diff_step=1e-6).x


@pytest.mark.parametrize(
    "changes", [{}, {"rope.bending_stiffness": 0.01}, {"sheave.mass": 600.0, "rope.bending_stiffness": 0.01}]
)
def test_a_plucked_side_rings_as_a_hanging_string(changes: dict[str, float]) -> None:
    """The counterweight's side, 51.5 m between its end and the axle's height, plucked at its end."""
    hung = rope(changes)
    hung.solve_equilibrium(0.0, 50.0)
    tension = 0.5 * G * (hung.model.sheave.mass + RHO * pi * TOWER.sheave.radius)
    expected = string_frequencies(tension, 50.0 - float(hung.outputs()["sheave_displacement"]) + 1.5, 6)
    found = fitted_frequencies(plucked(changes, 30.0, 12.0), expected)
    # Bending keeps the rope's end on the sheave (EI 20: half a boundary layer of 0.18 m in 51.5 m), the sheave gives
    # way a little; a step of 4 ms lowers the third frequency by (w h)^2 / 12 = 3e-5.
    assert found[:3] == pytest.approx(expected[:3], rel=1e-3)


# -- the sheave ----------------------------------------------------------------------------------


@pytest.mark.parametrize("inertia", [9.6, 40.0])
def test_tension_jumps_across_the_accelerating_sheave(inertia: float) -> None:
    """By J w' / r, and by what accelerates the rope that lies on the sheave: rho pi r a."""
    moving = rope({"sheave.inertia": inertia, "rope.bending_damping": 0.0})
    trip, radius, jumps = plan_s_curve(Profile(speed=6.0), 5.0, 45.0, 0.0), TOWER.sheave.radius, []
    moving.solve_equilibrium(5.0, 45.0)
    while (time := float(moving.state.time[0])) < 5.0:
        ride(moving, trip, 0.02)
        car, out = trip.at(time + 0.02), moving.outputs()
        axle = float(out["sheave_displacement"]) - TOWER.shaft.pit
        up = out["car_end_tension"] - RHO * (G + car.acceleration) * (car.position - axle)
        down = out["counterweight_end_tension"] - RHO * (G - car.acceleration) * (50.0 - car.position - axle)
        if time > 3.0:
            assert car.acceleration == pytest.approx(0.8, rel=1e-12)
            jumps.append(up - down)
    expected = (inertia / radius**2 + RHO * pi * radius) * 0.8
    # Axial waves of some 2 N cross the sheave; their mean over 2 s stays below half a newton.
    assert np.mean(jumps) == pytest.approx(expected, abs=0.6)


def test_bending_damping_drags_in_proportion() -> None:
    """Winding bends and unbends the rope: a drag of some c_B v / (r^2 lambda) on top of what accelerates the sheave."""
    lost = [short_trip(rope__bending_damping=one)[0].energies()["bending_damping"] for one in (0.05, 0.1)]
    # Proportional but for its effect on the boundary layer itself.
    assert lost[1] / lost[0] == pytest.approx(2.0, rel=0.05)
    speed = np.array([SHORT.at(t).velocity for t in np.arange(0.0, 8.0, 0.01).tolist()])
    layer = sqrt(TOWER.rope.bending_stiffness / (0.5 * G * TOWER.sheave.mass))
    estimate = 0.1 * np.sum(speed**2) * 0.01 / (TOWER.sheave.radius**2 * layer)
    # The rope leaves the groove with a rounded curvature, not the exponential's corner.
    assert lost[1] == pytest.approx(estimate, rel=0.25)


def test_sheave_turns_with_the_rope() -> None:
    """Car up, sheave positive, by travel over radius; the groove gives by 0.1 mm of 0.4 m, and drag makes the rope creep."""
    moving, rows = ridden(0.0, 50.0, 26.0)
    assert rows[-1, -1] == pytest.approx(50.0 / TOWER.sheave.radius, rel=1e-3)
    assert moving.outputs()["sheave_angular_velocity"] == pytest.approx(0.0, abs=0.01)


def test_down_trip_mirrors_the_up_trip() -> None:
    n = ridden(0.0, 50.0, 26.0)[0].n
    up, down = ridden(0.0, 50.0, 26.0)[1], ridden(50.0, 0.0, 26.0)[1]
    mirrored = np.concatenate(
        [down[:, :n][:, ::-1], down[:, n : n + 1], -down[:, n + 1 : 2 * n + 1][:, ::-1], -down[:, -1:]], axis=1
    )
    # Rounding of 1e-16 in sums that run in another order round the sheave, through 6500 steps.
    assert np.abs(mirrored - up).max() < 1e-9


# -- convergence ---------------------------------------------------------------------------------


@pytest.mark.parametrize("damping", [0.0, 0.15])
def test_second_order_in_time(damping: float) -> None:
    steps = (0.008, 0.004, 0.002, 0.001, 0.0005)
    runs = [short_trip(solver__step=h, solver__numerical_damping=damping) for h in steps]
    n = runs[0][0].n
    for part in (slice(n + 1, 2 * n + 1), slice(n, n + 1), slice(2 * n + 1, None)):  # lateral, sheave's height, its angle
        errors = [rms(a[1][:, part] - b[1][:, part]) for a, b in pairwise(runs)]
        order = np.polyfit(np.log(steps[:-1]), np.log(errors), 1)[0]
        # The iteration's tolerance of 1e-8 m and slip that grips and lets go move the fit a little.
        assert order == pytest.approx(2.0, abs=0.2)
    lateral = slice(n + 1, 2 * n + 1)
    assert rms(runs[1][1][:, lateral] - runs[-1][1][:, lateral]) < 1e-5  # the default step: within 10 um


def test_at_least_second_order_in_space() -> None:
    def readings(element: float) -> np.ndarray:
        moving, rows = short_trip(rope__element_length=element)
        seen = []
        for row in rows:
            moving.state.q[:] = row
            seen.append([moving.lateral_displacement("counterweight", 10.0)[0], row[moving.n]])
        return np.array(seen)

    elements, finest = (0.08, 0.04, 0.02), readings(0.01)
    errors = [[rms(one) for one in (readings(element) - finest).T] for element in elements]
    orders = np.polyfit(np.log(elements), np.log(errors), 1)[0]
    # Bending and contact are of fourth order where the rope is smooth and of second where it leaves the groove.
    assert np.all(orders > 1.8)
    assert errors[1][0] < 2e-5  # 4 cm: below 0.02 mm


# -- energy --------------------------------------------------------------------------------------


def exchanged(moving: CompensationRope) -> float:
    """Energy that went to and fro: what weight and ends gave or took, and all that was lost [J]."""
    return sum(abs(value) for name, value in moving.energies().items() if name not in ("kinetic", "sheave"))


def test_energy_balances_over_a_whole_trip() -> None:
    moving = ridden(0.0, 50.0, 26.0)[0]
    assert moving.energies()["bending_damping"] > 100.0
    # Second order in the step: 3e-5 at the default step.
    assert abs(moving.energy_residual) < 1e-4 * exchanged(moving)


def test_energy_residual_falls_with_the_step() -> None:
    coarse, middle = (abs(short_trip(solver__step=h)[0].energy_residual) for h in (0.008, 0.002))
    # Second order would be 16. The iteration's tolerance, 1e-8 m of an element of 1.6e8 N/m at the driven ends, leaves 10 mJ.
    assert middle < 0.5 * coarse
    assert coarse < 1e-5 * exchanged(short_trip(solver__step=0.008)[0])


# -- repeatability -------------------------------------------------------------------------------


def test_restart_from_bytes_is_bit_for_bit() -> None:
    def go(moving: CompensationRope, steps: int) -> bytes:
        for _ in range(steps):
            ride(moving, SHORT, 0.013)
        return moving.state.to_bytes()

    hysteresis = {"effects.bending_hysteresis.friction_moment": 1.0, "effects.bending_hysteresis.yield_curvature": 0.1}
    moving, other = rope(hysteresis), rope(hysteresis)
    moving.solve_equilibrium(20.0, 30.0)
    saved = go(moving, 100)
    expected = go(moving, 100)
    other.solve_equilibrium(3.0, 47.0)
    other.state.from_bytes(saved)
    assert go(other, 100) == expected


def test_settling_again_forgets_the_past() -> None:
    moving, fresh = rope(), rope()
    moving.solve_equilibrium(20.0, 30.0)
    for _ in range(50):
        ride(moving, SHORT, 0.02)
    for one in (moving, fresh):
        one.solve_equilibrium(20.0, 30.0)
    assert moving.state.to_bytes() == fresh.state.to_bytes()


SENSORS = tuple(Sensor(name=f"cw_{k}", side="counterweight", height=height) for k, height in enumerate((0.5, 10.0)))


@cache
def communicated(steps: tuple[float, ...], derivatives: bool) -> np.ndarray:
    """Displacements and the sheave's height every 0.1 s of the short trip, as an engine gives them that is told positions."""
    model = TOWER.model_copy(update={"sensors": SENSORS})
    face = interface(model)
    parameters = {one.name: one.start for one in face.of_role("parameter")} | {
        "derivative_inputs": derivatives,
        "inputs_at_end": True,
    }
    inputs = {one.name: one.start for one in face.of_role("input")} | {"car_position": 20.0, "counterweight_position": 30.0}
    engine, rows, done, k = create(parameters, inputs, 0.0), [], 0, 0
    while done < 80000:  # tenths of a millisecond
        size = round(1e4 * steps[k % len(steps)])
        at = SHORT.at(1e-4 * (done + size))
        inputs |= {"car_position": at.position, "car_velocity": at.velocity, "car_acceleration": at.acceleration}
        inputs |= {"counterweight_position": 50.0 - at.position, "counterweight_velocity": -at.velocity}
        inputs["counterweight_acceleration"] = -at.acceleration
        engine.step(1e-4 * done, 1e-4 * size, inputs)
        done, k = done + size, k + 1
        if done % 1000 == 0:
            out = engine.outputs()
            rows.append([out["lateral_displacement[1]"], out["lateral_displacement[2]"], out["sheave_displacement"]])
    return np.array(rows)


UNEVEN = (0.003, 0.007, 0.0125, 0.0175, 0.01, 0.02, 0.005, 0.025)  # 0.1 s in all


FINEST = ((0.001,), True)  # what the others are compared with


@pytest.mark.parametrize(
    ("steps", "derivatives"),
    [one for one in product([(0.001,), (0.005,), (0.02,), UNEVEN], [False, True]) if one != FINEST],
)
def test_result_does_not_depend_on_the_communication_step(steps: tuple[float, ...], derivatives: bool) -> None:
    """Whether the engine is told positions only, or velocities and accelerations too."""
    difference = communicated(steps, derivatives) - communicated(*FINEST)
    # Time steps of 1 ms against 4 ms make 3 um; the rest is how a quintic crosses a jump of the jerk.
    assert np.sqrt(np.mean(difference[:, :2] ** 2, axis=0)).max() < 1e-5
    assert np.abs(difference[:, 2]).max() < 3e-6


# -- robustness ----------------------------------------------------------------------------------


@pytest.mark.parametrize("trip", [(0.0, 50.0), (50.0, 0.0), (20.0, 26.0)])
def test_a_normal_trip_never_halves_a_step(trip: tuple[float, float]) -> None:
    moving, rows = ridden(*trip, 26.0)
    assert moving.count["halved"] == 0
    assert moving.count["newton"] < 4 * moving.count["steps"]
    assert np.all(np.isfinite(rows))


def test_a_fast_trip_never_halves_a_step() -> None:
    """At 9 m/s a step winds a good part of an element on, which the start of the iteration must foresee."""
    moving, fast = rope({"shaft.height": 80.0}), Profile(speed=9.0, acceleration=3.0, jerk=3.0)
    trip = plan_s_curve(fast, 0.0, 80.0, 0.1)
    moving.solve_equilibrium(0.0, 80.0)
    for _ in range(round(trip.end_time / 0.02)):
        ride(moving, trip, 0.02)
    assert moving.count["halved"] == 0
    assert moving.count["newton"] < 4 * moving.count["steps"]


@pytest.mark.parametrize("weight", [0.1, 0.3])
def test_a_light_sheave_survives_the_trip(weight: float) -> None:
    moving, rows = ridden(0.0, 50.0, 26.0, (("sheave.mass", 120.0 * weight), ("sheave.inertia", 9.6 * weight)))
    assert np.all(np.isfinite(rows))
    assert abs(moving.energy_residual) < 1e-4 * exchanged(moving)


@pytest.mark.parametrize("damping", [0.0, 0.15])
@pytest.mark.parametrize("jump", [0.1, 1.0, 5.0, -1.0])
def test_a_violent_input_is_survived_or_refused_never_nan(jump: float, damping: float) -> None:
    """The car jumps within a millisecond; the rope then hangs still, or says what went wrong and where."""
    moving = rope({"solver.numerical_damping": damping})
    moving.solve_equilibrium(5.0, 45.0)
    path = way(TOWER.sheave.radius, 50.0, TrajectoryPoint(5.0), TrajectoryPoint(5.0)).reshape(4, 6)
    path[0, 3] -= jump
    try:
        moving.step(0.001, path.ravel())
        path[:, :3] = path[:, 3:]
        for _ in range(25):
            moving.step(0.02, path.ravel())
    except SimulationError as error:
        assert "did not converge" in str(error)
    state = moving.state
    assert all(np.all(np.isfinite(one)) for one in (state.q, state.v, state.a, state.f, state.energy))
    assert np.all(np.isfinite(list(moving.outputs().values())))
