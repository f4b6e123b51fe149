"""Whitened channels: noise, bins, outliers and the bins' covariance, each against its definition."""

import numpy as np
import pytest

from comprope_system.identification.data.channel_noise import ChannelNoise, is_contradicted
from comprope_system.identification.data.outliers import outliers
from comprope_system.identification.data.runs import Channel, Run
from comprope_system.identification.data.whitening import stack, whiten_channel
from comprope_system.measurements import Trip
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited

SAMPLING, REST, NOISE = 0.02, 1.0, 1e-3  # s, s, m
TIME = np.arange(0.0, 6.0, SAMPLING)
AT_REST = 51  # samples until the trip begins, both ends counted
ALL = np.ones(TIME.size, bool)
WHITE = ChannelNoise(NOISE, np.ones(1), 1.0, 0.0, NOISE)


def run() -> Run:
    trip = Trip((jerk_limited(2.0, 3.0, REST, np.full(7, 0.5)),), 0.0, "profile")
    return Run("a.csv", "fit", {}, TIME, trip.position(TIME), trip, trip.mirrored(14.0), {})


def channel(reference: str = "absolute", noise: float | None = 1.0) -> Channel:
    """A laser whose noise is stated in its unit, the millimetre."""
    return Channel(column="laser", quantity="lateral_displacement", unit="mm", reference=reference, noise=noise)


def swing(seed: int = 0, noise: float = NOISE) -> np.ndarray:
    """A swing of 20 mm from the beginning of the trip on, and white noise."""
    return np.where(TIME > REST, 0.02 * np.sin(3.0 * (TIME - REST)), 0.0) + noise * np.random.default_rng(seed).normal(
        size=TIME.size
    )


@pytest.mark.parametrize("reference", ["absolute", "rest"])
def test_the_covariance_is_of_noise_discrepancy_and_the_mean_at_rest(reference: str) -> None:
    """Bins of 50 ms hold two or three samples; the discrepancy of 0.15 noises forgets itself in half a second."""
    found = whiten_channel(run(), channel(reference), swing(), ALL, WHITE)
    assert found is not None
    bins, count = np.unique((TIME / 0.05).astype(int), return_counts=True)
    assert set(count.tolist()) == {2, 3}
    expected = (0.15 * NOISE) ** 2 * np.exp(-0.05 * np.abs(np.subtract.outer(bins, bins)) / 0.5) + np.diag(NOISE**2 / count)
    expected += np.diag(np.full(bins.size, 1e-3 * NOISE**2))
    if reference == "rest":  # the mean of 51 samples is off by noise of its own, the same in all bins
        expected = expected + NOISE**2 / AT_REST
    assert found.factor @ found.factor.T == pytest.approx(expected, rel=1e-9)
    assert (found.noise, found.discrepancy) == pytest.approx((NOISE, 0.15 * NOISE), rel=1e-12)


def test_a_channel_that_varies_much_is_allowed_a_discrepancy_in_proportion() -> None:
    """0.2 % of an rms variation of 0.7 m is more than 0.15 mm."""
    value = swing() + np.where(TIME > REST, np.sin(2.0 * np.pi * TIME), 0.0)
    found = whiten_channel(run(), channel(), value, ALL, WHITE)
    assert found is not None
    assert found.discrepancy == pytest.approx(0.002 * np.std(value), rel=1e-9)


def test_whitened_noise_is_white_with_unit_variance() -> None:
    """A hundred draws of noise, discrepancy and mean at rest: 12000 numbers whose squares average to one within 2 %."""
    random, squares = np.random.default_rng(1), []
    found = whiten_channel(run(), channel("rest"), swing(), ALL, WHITE)
    assert found is not None
    steps, drift = np.exp(-SAMPLING / 0.5), 0.15 * NOISE
    for _ in range(100):
        slow = np.zeros(TIME.size)
        slow[0] = drift * random.normal()
        for k in range(1, TIME.size):
            slow[k] = steps * slow[k - 1] + drift * np.sqrt(1.0 - steps**2) * random.normal()
        error = slow + NOISE * random.normal(size=TIME.size) - NOISE / np.sqrt(AT_REST) * random.normal()
        squares.append(np.mean(found.whiten(found.means(error)) ** 2))
    # The process is averaged within a bin of a tenth of its memory: 3 % of a share of 5 % of the variance.
    assert np.mean(squares) == pytest.approx(1.0, abs=0.03)


def test_bins_are_means_of_good_samples_only() -> None:
    value, visible = swing(), ALL.copy()
    value[100] += 0.5  # an outlier
    value[150], visible[200] = np.nan, False
    found = whiten_channel(run(), channel(), value, visible, WHITE)
    assert found is not None
    left_out = [100, 150, 200]
    assert np.flatnonzero(found.bin_of < 0).tolist() == left_out
    index = (TIME / 0.05).astype(int)
    for k in (100, 150, 200, 250):
        mates = [j for j in np.flatnonzero(index == index[k]) if j not in left_out]
        assert found.data[found.bin_of[mates[0]]] == pytest.approx(np.mean(value[mates]), rel=1e-12)
        assert found.count[found.bin_of[mates[0]]] == len(mates)
    assert found.means(np.ones(TIME.size)) == pytest.approx(np.ones(found.count.size), rel=1e-12)
    whole = stack([found, found], {("a.csv", "laser"): value})
    assert whole == pytest.approx(np.tile(found.whiten(found.data), 2), rel=1e-9)


def test_a_channel_of_less_than_twenty_samples_is_left_out() -> None:
    few = np.where(np.arange(TIME.size) < 19, swing(), np.nan)
    assert whiten_channel(run(), channel(), few, ALL, WHITE) is None
    enough = np.where(np.arange(TIME.size) < 20, swing(), np.nan)
    assert whiten_channel(run(), channel(), enough, ALL, WHITE) is not None


@pytest.mark.parametrize(
    ("seen", "expected"), [(1.5, False), (1.7, True), (0.65, False), (0.62, True), (0.25, True), (0.15, False)]
)
def test_what_contradicts_a_stated_noise(seen: float, expected: bool) -> None:
    """With 400 samples: factors of 1.4 (1 + 2.4 / 20) = 1.568 either way, and less than a fifth may be coarse digits."""
    assert is_contradicted(1.0, seen, 400) is expected


def test_outliers_are_six_deviations_from_the_running_median() -> None:
    value = np.zeros(101)
    value[[20, 50, 80]] = 5.9, 6.1, -6.1
    assert np.flatnonzero(outliers(value, 1.0)).tolist() == [50, 80]
    ramp = 10.0 * np.arange(101.0)
    assert not outliers(ramp, 1.0)[5:-5].any()  # a steady motion is none


def test_a_prediction_that_is_out_of_view_too_early_is_held_where_it_was_last_seen() -> None:
    """As zeros, samples that were measured while the model's end has passed already would be off by the whole displacement."""
    one, value = whiten_channel(run(), channel(), swing(), ALL, WHITE), swing(noise=0.0)
    assert one is not None
    gone = np.where(TIME < 5.7, value, np.nan)
    assert np.array_equal(one.means(gone)[:-8], one.means(value)[:-8])
    assert one.means(gone)[-1] == pytest.approx(value[TIME < 5.7][-1], rel=1e-12)
    assert abs(one.means(gone)[-1]) > 0.01
    assert not one.means(np.full(TIME.size, np.nan)).any()


def test_a_swing_in_a_long_record_is_not_averaged_away() -> None:
    time = np.arange(0.0, 1800.0, 0.05)
    trip = Trip((jerk_limited(2.0, 40.0, 600.0, np.array([1.0, 2.0, 1.0, 14.0, 1.0, 2.0, 1.0])),), 0.0, "profile")
    long = Run("a.csv", "fit", {}, time, trip.position(time), trip, trip.mirrored(50.0), {})
    swinging = (time > 600.0) & (time < 630.0)
    value = np.where(swinging, 0.02 * np.sin(2.0 * np.pi * time), 0.0) + NOISE * np.random.default_rng(1).normal(size=time.size)
    found = whiten_channel(long, channel(), value, np.ones(time.size, bool), WHITE)
    assert found is not None and len(found.count) <= 500
    inside = np.unique(found.bin_of[swinging & (found.bin_of >= 0)])
    assert len(inside) == pytest.approx(150, abs=2)
    assert np.std(found.data[inside]) == pytest.approx(0.02 * 0.5**0.5, rel=0.1)
