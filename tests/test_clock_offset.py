"""A delay between measured and predicted channels: its sign and size, and Sprague and Geers' errors of a shifted signal."""

import numpy as np
import pytest

from comprope_system.identification.comparison.clock_offset import delay, pooled_delay
from comprope_system.identification.comparison.error_metrics import sprague_geers
from comprope_system.identification.comparison.paired_records import Record
from comprope_system.identification.data.runs import Channel, Run
from comprope_system.measurements import Trip
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited

TIME = np.arange(0.0, 12.0, 0.02)
TRIP = Trip((jerk_limited(2.0, 6.0, 1.0, np.full(7, 1.0)),), 0.0, "profile")
RUN = Run("a.csv", "fit", {}, TIME, TRIP.position(TIME), TRIP, TRIP.mirrored(14.0), {})
LASER = Channel(column="laser", quantity="lateral_displacement", unit="mm", noise=0.3)


def swing(time: np.ndarray) -> np.ndarray:
    """A swing of 20 mm with two frequencies, from the beginning of the trip on."""
    t = np.maximum(time - 1.0, 0.0)
    return 0.02 * np.sin(2.0 * t) + 0.01 * np.sin(5.3 * t)


def record(late: float, scale: float = 1.0) -> Record:
    noise = 3e-4 * np.random.default_rng(1).normal(size=TIME.size)
    return Record(RUN, LASER, scale * swing(TIME - late) + noise, swing(TIME), 3e-4)


@pytest.mark.parametrize("late", [0.06, -0.06, 0.213, 0.0])
def test_a_channel_that_follows_late_has_a_positive_delay(late: float) -> None:
    found = delay(record(late))
    assert found is not None
    assert found[0] == pytest.approx(late, abs=max(3.0 * found[1], 2e-3))
    assert 0.0 < found[1] < 0.02


def test_delays_of_runs_are_pooled_by_their_certainty() -> None:
    found = pooled_delay([record(0.05), record(0.07)])
    assert found is not None
    assert found[0] == pytest.approx(0.06, abs=2e-3)
    assert found[1] == pytest.approx(0.01, abs=3e-3)  # the scatter of the two


def test_a_channel_that_moves_otherwise_has_no_delay() -> None:
    other = Record(RUN, LASER, swing(TIME)[::-1].copy(), swing(TIME), 3e-4)
    assert delay(other) is None
    assert delay(record(0.06, scale=0.01)) is None  # not to be seen in the noise


def test_an_offset_counts_as_magnitude() -> None:
    """About the measured mean: sum (p + c)^2 = sum p^2 + n c^2."""
    wave = np.sin(np.linspace(0.0, 2.0 * np.pi, 401)[:-1])
    found = sprague_geers(wave, wave + 1.0)
    assert found.magnitude == pytest.approx(np.sqrt(3.0) - 1.0, rel=1e-9)
    assert found.phase == pytest.approx(np.arccos(1.0 / np.sqrt(3.0)) / np.pi, rel=1e-9)
    assert found.combined == pytest.approx(np.hypot(found.magnitude, found.phase), rel=1e-12)
