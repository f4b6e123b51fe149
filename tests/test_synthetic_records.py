"""Synthetic records of buildings: their spectra are those of the formulas, and simulations replay them."""

from pathlib import Path

import numpy as np
import pytest
from scipy.signal import welch
from typer.testing import CliRunner

import comprope_system
from comprope.errors import InputError
from comprope_system import cli
from comprope_system.simulation.building_motion.modal_building import ModalBuilding
from comprope_system.simulation.building_motion.random_series import random_lines
from comprope_system.simulation.building_motion.spectra import ground_acceleration, wind_force
from comprope_system.simulation.building_motion.synthetic_record import STEP, envelope

LONG = 3600.0  # s, so that the estimate of a spectrum is one
BANDS = ((0.02, 0.1), (0.1, 0.3), (0.3, 1.0), (1.0, 3.0))  # Hz


def in_bands(frequency: np.ndarray, density: np.ndarray) -> np.ndarray:
    """Share of the variance in each of BANDS."""
    found = np.array([np.sum(density[(frequency >= low) & (frequency < high)]) for low, high in BANDS])
    return found / found.sum()


@pytest.mark.parametrize(
    "spectrum", [lambda f: ground_acceleration(f, 4.0), lambda f: wind_force(f, 25.0, 2000.0)], ids=["earthquake", "wind"]
)
def test_a_random_series_has_the_spectrum_of_its_formula(spectrum) -> None:
    """Variance and shares of bands, by Welch's estimate."""
    lines = random_lines(spectrum, LONG, STEP, np.random.default_rng(3))
    series = lines.series()
    assert np.var(series) == pytest.approx(np.sum(spectrum(lines.frequencies)) * lines.frequencies[0], rel=1e-3)
    frequency, found = welch(series, 1.0 / STEP, nperseg=8192)
    expected = in_bands(frequency[1:], spectrum(frequency[1:]))
    assert in_bands(frequency[1:], found[1:]) == pytest.approx(expected, rel=0.15, abs=0.01)


def test_derivatives_of_a_series_and_of_the_envelope_are_those_of_differences() -> None:
    """So that the ground's acceleration is that of its displacement."""
    lines = random_lines(lambda f: ground_acceleration(f, 4.0), 60.0, STEP, np.random.default_rng(1))
    slow = lines.filtered(lambda f: np.asarray(np.exp(-f) / (1.0 + f**4), complex))
    for values, rate in ((slow.series(), slow.series(1)), (slow.series(1), slow.series(2))):
        assert np.gradient(values, STEP)[5:-5] == pytest.approx(rate[5:-5], abs=0.02 * np.abs(rate).max())
    value, first, second = envelope(lines.times, 10.0, 20.0)
    assert np.gradient(value, STEP)[2:-2] == pytest.approx(first[2:-2], abs=1e-3)
    inside = (np.abs(lines.times - 10.0) > 0.1) & (np.abs(lines.times - 40.0) > 0.1)  # the joints
    assert np.gradient(first, STEP)[inside][2:-2] == pytest.approx(second[inside][2:-2], abs=2e-3)


def test_a_mode_on_shaking_ground_swings_as_its_receptance_says() -> None:
    """After the transient of a harmonic motion has died away."""
    building, frequency = ModalBuilding((2.0, 2.0 / 3.0), 0.05), 0.4
    times = np.arange(0.0, 80.0, STEP)
    found = building.ground_response(0, np.sin(2.0 * np.pi * frequency * times), STEP)
    expected = building.participation(0) * np.abs(building.receptance(0, np.array([frequency]))[0])
    assert np.abs(found[-1000:]).max() == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("kind", ["earthquake", "wind"])
def test_a_record_is_replayed_and_equal_seeds_give_equal_records(kind: str, tmp_path: Path) -> None:
    """The command writes record and model; the simulation of that model sways."""
    record, model = tmp_path / "r.csv", tmp_path / "m.toml"
    arguments = ["building", kind, "tower50", "--duration", "30", "--seed", "5", "--set", "rope.element_length=0.1"]
    told = CliRunner().invoke(cli.app, [*arguments, "--out", str(record), "--model", str(model)])
    assert told.exit_code == 0, told.output
    again = comprope_system.building("tower50", kind, duration=30.0, seed=5)  # type: ignore[arg-type]
    again.to_csv(tmp_path / "again.csv")
    assert (tmp_path / "again.csv").read_bytes() == record.read_bytes()
    other = comprope_system.building("tower50", kind, duration=30.0, seed=6)  # type: ignore[arg-type]
    assert not other.to_dataframe().equals(again.to_dataframe())
    trip = comprope_system.simulate(model, comprope_system.CarMotion(10.0, 12.0), duration=6.0)
    assert trip.table["car_lateral_displacement"].abs().max() > 1e-4
    assert (trip.table["base_acceleration"].abs().max() > 1e-3) == (kind == "earthquake")


def test_bad_values_are_told_all_at_once() -> None:
    """One line each."""
    with pytest.raises(InputError) as refused:
        comprope_system.building("tower50", "flood", peak=-1.0, duration=1.0, seed=-3)  # type: ignore[arg-type]
    lines = str(refused.value).splitlines()
    assert lines[0] == "kind = flood: earthquake or wind is accepted"
    assert len(lines) == 4
    with pytest.raises(InputError, match="top = 30 m: from the top landing, at 50 m, to 1200 m is accepted"):
        comprope_system.building("tower50", top=30.0)
