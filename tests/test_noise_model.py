"""Noise models of measured channels: correlation, deviation, resolution and growth in motion, each against what was drawn."""

import numpy as np
import pytest
from scipy.signal import lfilter

from comprope_system.identification.data.channel_noise import channel_noise, spread_of_steps
from comprope_system.identification.data.noise_model import NoiseModel, bin_covariance, estimate, resolution_of
from comprope_system.identification.data.runs import Channel, Run
from comprope_system.identification.data.whitening import whiten_channel
from comprope_system.measurements import Trip
from comprope_system.measurements.motion.jerk_limited_profile import jerk_limited

SAMPLING, SIZE = 0.01, 2e-4  # s, m


def first_order(random: np.random.Generator, count: int, phi: float, size: float = 1.0) -> np.ndarray:
    """Stationary noise of one deviation, correlated by `phi` from sample to sample."""
    white = random.normal(size=count)
    white[0] /= np.sqrt(1.0 - phi**2)
    return size * np.sqrt(1.0 - phi**2) * lfilter([1.0], [1.0, -phi], white)


def run(noise, rest: float = 1.0, after: float = 2.0, swing: float = 0.02, file: str = "a.csv") -> Run:
    """A trip of 8 s between two rests, with a swing of the rope while the car moves; `noise(count)` is added."""
    time = np.arange(0.0, rest + 8.0 + after, SAMPLING)
    trip = Trip((jerk_limited(2.0, 3.0, rest, np.array([1, 1, 1, 2, 1, 1, 1.0])),), 0.0, "profile")
    inside = (time > rest) & (time < rest + 8.0)
    value = np.where(inside, swing * np.sin(3.0 * (time - rest)), 0.0) + noise(len(time))
    return Run(file, "fit", {}, time, trip.position(time), trip, trip.mirrored(14.0), {"laser": value})


def channel(noise: float | None = None, reference: str = "absolute") -> Channel:
    return Channel(column="laser", quantity="lateral_displacement", unit="mm", reference=reference, noise=noise)


def runs_of(noise, count: int = 4, **shape) -> list[Run]:
    return [run(noise, file=f"{k}.csv", **shape) for k in range(count)]


@pytest.mark.parametrize("phi", [0.0, 0.5, 0.8, 0.95])
def test_correlation_and_deviation_of_first_order_noise_are_found(phi: float) -> None:
    random = np.random.default_rng(1)
    found = estimate([first_order(random, 1000, phi) for _ in range(6)])
    correlation = found.correlation if len(found.correlation) > 1 else np.array([1.0, 0.0])
    assert correlation[1] == pytest.approx(phi, abs=0.04)
    assert found.deviation == pytest.approx(1.0, rel=0.12)


def test_a_short_rest_gives_the_deviation_without_bias() -> None:
    """Fifty samples with a correlation of 0.9: mean and slope alone take away a third of the variance."""
    random = np.random.default_rng(2)
    found = [estimate([first_order(random, 50, 0.9) for _ in range(4)]).deviation ** 2 for _ in range(40)]
    assert 0.75 < float(np.median(found)) < 1.3


def test_a_resonant_filter_is_a_model_of_higher_order() -> None:
    """A hum of 12 Hz in broad noise: the correlation is negative half a period, positive a whole one later."""
    random = np.random.default_rng(3)
    time = np.arange(1000) * SAMPLING
    records = [np.sin(2.0 * np.pi * 12.0 * time + random.uniform(0, 6)) + 0.3 * random.normal(size=1000) for _ in range(4)]
    found = estimate(records).correlation
    assert found[4] < -0.7
    assert found[8] > 0.7


def test_the_covariance_of_bins_is_that_of_means_of_samples() -> None:
    random = np.random.default_rng(4)
    model = NoiseModel(np.array([0.8, -0.3]), 1.0, 100)
    bin_of = np.repeat(np.arange(8), 3)
    bin_of[[4, 10, 11]] = -1
    scale = random.uniform(1.0, 2.0, len(bin_of))
    lags = np.abs(np.subtract.outer(np.arange(len(bin_of)), np.arange(len(bin_of))))
    correlation = np.zeros(len(bin_of))
    correlation[: len(model.correlation)] = model.correlation[: len(bin_of)]
    samples = scale[:, None] * correlation[lags] * scale
    mean = np.array([(bin_of == k) / np.sum(bin_of == k) for k in range(8)])
    assert bin_covariance(bin_of, scale, model.correlation) == pytest.approx(mean @ samples @ mean.T, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(("phi", "stated"), [(0.0, None), (0.8, None), (0.8, 0.2), (0.95, 0.2), (0.5, None)])
@pytest.mark.parametrize("rest", [0.5, 3.0])
def test_whitened_noise_has_unit_variance(phi: float, stated: float | None, rest: float) -> None:
    """What the car's rests teach whitens the noise of the whole record, slow and fast parts of it alike."""
    random, whole, slow = np.random.default_rng(5), [], []
    for _ in range(12):
        runs = runs_of(lambda count: first_order(random, count, phi, SIZE), rest=rest, swing=0.0)
        noise = channel_noise(channel(stated), runs)
        for one in runs:
            found = whiten_channel(one, channel(stated), one.values["laser"], np.ones(len(one.time), bool), noise)
            assert found is not None
            white = found.whiten(found.data)
            whole.append(np.mean(white**2))
            slow.append(np.mean(white.reshape(-1)[: len(white) // 10 * 10].reshape(-1, 10).mean(axis=1) ** 2) * 10)
    # An upper limit and the allowance for a discrepancy make it less than one, by more where little is known.
    assert 0.55 < np.mean(whole) < 1.1
    assert 0.35 < np.mean(slow) < 1.25


def test_a_stated_deviation_is_the_total_one_and_holds_unless_contradicted() -> None:
    random = np.random.default_rng(6)
    runs = runs_of(lambda count: first_order(random, count, 0.8, SIZE), rest=3.0)
    as_stated = channel_noise(channel(0.22), runs)
    assert as_stated.deviation == 0.22e-3
    assert as_stated.correlation[1] == pytest.approx(0.8, abs=0.06)
    for wrong in (0.05, 0.6):
        assert channel_noise(channel(wrong), runs).deviation == pytest.approx(SIZE, rel=0.4)
    assert channel_noise(channel(4.0), runs).deviation == 4.0e-3  # a twentieth may be coarse digits


def test_an_unstated_deviation_is_taken_at_the_upper_limit_of_its_estimate() -> None:
    random = np.random.default_rng(7)
    drawn = (runs_of(lambda count: first_order(random, count, 0.8, SIZE), rest=1.0) for _ in range(100))
    above = [channel_noise(channel(), runs).deviation for runs in drawn]
    assert np.mean(np.array(above) > SIZE) > 0.8
    assert np.median(above) < 1.5 * SIZE


def test_a_coarse_resolution_is_noise_of_a_twelfth_of_its_square() -> None:
    random = np.random.default_rng(8)
    quantised = runs_of(lambda count: 1e-6 * random.normal(size=count))
    for one in quantised:
        one.values["laser"][:] = np.round(one.values["laser"] / 5e-4) * 5e-4
    found = channel_noise(channel(), quantised)
    assert found.resolution == pytest.approx(5e-4)
    assert found.deviation == pytest.approx(5e-4 / 12**0.5, rel=0.15)
    # At rest the signal stays on one level: its mean is off by up to half a step, however many samples there are.
    assert found.mean_variance(1000) == pytest.approx((5e-4) ** 2 / 12.0)


def test_the_resolution_of_a_fine_signal_is_nought() -> None:
    assert resolution_of(np.random.default_rng(9).normal(size=500)) == 0.0
    assert resolution_of(np.full(500, 3.0)) == 0.0


@pytest.mark.parametrize(("factor", "expected"), [(1.0, 1.0), (4.0, 4.0)])
@pytest.mark.parametrize("phi", [0.0, 0.8])
def test_vibration_is_told_from_the_motion_of_the_rope(factor: float, expected: float, phi: float) -> None:
    random = np.random.default_rng(10)
    runs = runs_of(lambda count: first_order(random, count, phi, SIZE))
    for one in runs:
        extra = np.sqrt(factor**2 - 1.0) * first_order(random, len(one.time), phi, SIZE)
        one.values["laser"][one.moving] += extra[one.moving]
    found = channel_noise(channel(), runs)
    assert found.motion_factor == pytest.approx(expected, rel=0.25)


def test_a_swing_of_the_rope_is_no_noise() -> None:
    """2 Hz and 80 mm, with noise of 0.02 mm: four thousand times as much."""
    random = np.random.default_rng(11)
    runs = runs_of(lambda count: 2e-5 * random.normal(size=count))
    for one in runs:
        one.values["laser"][one.moving] += 0.08 * np.sin(2.0 * np.pi * 2.0 * one.time[one.moving])
    found = channel_noise(channel(), runs)
    assert found.motion_factor == 1.0
    assert found.deviation == pytest.approx(2e-5, rel=0.2)


def test_a_swing_after_the_stop_is_no_rest() -> None:
    """The later half of the record after the stop, two seconds, is longer than the rest before the trip: it would count."""
    random = np.random.default_rng(12)
    runs = runs_of(lambda count: SIZE * random.normal(size=count), after=4.0)
    for one in runs:
        late = one.time > one.trip.rest_after
        one.values["laser"][late] += 0.01 * np.sin(4.0 * one.time[late])
    assert channel_noise(channel(), runs).deviation == pytest.approx(SIZE, rel=0.2)


def test_outliers_and_heavy_tails_do_not_hide_what_a_channel_shows() -> None:
    random = np.random.default_rng(13)
    runs = runs_of(lambda count: SIZE * random.standard_t(3, size=count) / 3**0.5)
    for one in runs:
        one.values["laser"][::37] += 0.5
    assert channel_noise(channel(), runs).deviation == pytest.approx(SIZE, rel=0.35)


def test_without_a_rest_noise_is_white_and_as_stated_or_from_the_steps_of_the_run() -> None:
    random = np.random.default_rng(14)
    # Twenty samples before the trip and twenty after it, of which the later ten are too few for a record.
    runs = runs_of(lambda count: SIZE * random.normal(size=count), count=1, rest=0.2, after=0.2)
    for stated in (0.3, 0.03):  # a longer rest would contradict the second
        found = channel_noise(channel(stated), runs)
        assert (found.deviation, found.motion_factor, len(found.correlation)) == (pytest.approx(1e-3 * stated, rel=1e-15), 1.0, 1)
        assert np.isnan(found.at_rest)
    # The differences of the whole run, 840 samples, give the noise to some 10 %, whatever the rope does meanwhile.
    assert channel_noise(channel(), runs).deviation == pytest.approx(SIZE, rel=0.2)


def test_the_spread_of_steps_is_the_deviation_of_white_noise() -> None:
    noise = np.random.default_rng(2).normal(size=20000)
    # A median of 2e4 steps is known to 1 %; neither a drift nor outliers count.
    assert spread_of_steps(noise) == pytest.approx(1.0, abs=0.03)
    drifting = noise + 0.01 * np.arange(20000)
    drifting[::100] += 50.0
    assert spread_of_steps(drifting) == pytest.approx(1.0, abs=0.05)


def test_a_drift_at_rest_is_no_noise() -> None:
    random = np.random.default_rng(15)
    runs = runs_of(lambda count: SIZE * random.normal(size=count) + 1e-4 * np.arange(count), swing=0.0)
    assert channel_noise(channel(0.2), runs).deviation == 0.2e-3
    assert channel_noise(channel(), runs).deviation == pytest.approx(SIZE, rel=0.2)
