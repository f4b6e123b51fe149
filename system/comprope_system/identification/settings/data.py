"""Constants of the treatment of measured data: rest and cruise, bins, noise, discrepancy, outliers."""

from dataclasses import dataclass

from .declaration import DERIVED, JUDGEMENT, setting


@dataclass(frozen=True)
class TripPhases:
    """Phases of a measured trip."""

    rest_duration: float = setting(
        0.2, "s", "least time from the start of a record that counts as rest; a mean at rest needs some samples", JUDGEMENT
    )
    cruise_speed: float = setting(0.99, "1", "share of the top speed above which the car cruises", JUDGEMENT)


@dataclass(frozen=True)
class Whitening:
    """Averaging of samples in bins, and the covariance of the bins."""

    bin_width: float = setting(0.05, "s", "least width of a bin; a tenth of the period of a 2 Hz oscillation", JUDGEMENT)
    widest_bin: float = setting(
        0.2, "s", "most width of a bin: a swing of 1 Hz keeps 94 % of its size; of a longer record bins are left out", JUDGEMENT
    )
    swing_time: float = setting(10.0, "s", "time after a motion whose bins are left out of a long record last", JUDGEMENT)
    max_bins: int = setting(500, "1", "most bins of a channel in a run; the covariance is factorised in O(bins^3)", JUDGEMENT)
    min_samples: int = setting(20, "1", "fewest usable samples of a channel in a run; with fewer it is left out", JUDGEMENT)
    discrepancy_time: float = setting(
        0.5, "s", "correlation time of the model discrepancy, and of residuals in the estimate of a clock offset", JUDGEMENT
    )
    discrepancy_share: float = setting(
        0.002, "1", "standard deviation of the discrepancy over that of the channel: error of mesh, time step and recovered trip",
        JUDGEMENT,
    )  # fmt: skip
    discrepancy_noise: float = setting(0.15, "1", "least standard deviation of the discrepancy over that of the noise", JUDGEMENT)
    white_share: float = setting(
        1e-3, "1", "variance of a bin's white part over that of a sample's noise; 5 % of that of ten white samples' mean",
        JUDGEMENT,
    )  # fmt: skip
    outlier_threshold: float = setting(
        6.0, "1", "standard deviations from the running median beyond which a sample is an outlier", JUDGEMENT
    )
    outlier_window: int = setting(11, "1", "samples of the running median", JUDGEMENT)


@dataclass(frozen=True)
class Noise:
    """Noise of a channel: as stated in the campaign, or estimated from the rests; its model, resolution and growth in motion."""

    mad_factor: float = setting(
        1.4826, "1", "standard deviation over median absolute deviation", f"{DERIVED}: normal distribution, 1 / 0.6745"
    )
    min_record: int = setting(16, "1", "fewest samples of a record at rest that is used", JUDGEMENT)
    min_rest_samples: int = setting(
        40, "1", "fewest samples at rest, over all runs, for a noise model; with fewer the noise is white and as stated",
        JUDGEMENT,
    )
    still_ratio: float = setting(
        1.2, "1", "deviation after a trip over that before the trips up to which the rope is still again", JUDGEMENT
    )
    least_trend: int = setting(30, "1", "samples of a record from which on its slope is unknown as well as its mean", JUDGEMENT)
    max_order: int = setting(12, "1", "highest order of the autoregression", JUDGEMENT)
    samples_per_coefficient: int = setting(10, "1", "fewest samples at rest for each coefficient", JUDGEMENT)
    max_reflection: float = setting(0.999, "1", "largest reflection coefficient; keeps the noise stationary", JUDGEMENT)
    refined_length: int = setting(
        300, "1", "samples of the longest record up to which coefficients are refined by restricted likelihood",
        f"{DERIVED}: the bias of a correlation by an unknown mean and slope is about 6 / samples",
    )  # fmt: skip
    max_lags: int = setting(2000, "1", "most lags of the autocorrelation", JUDGEMENT)
    negligible_correlation: float = setting(1e-4, "1", "autocorrelation that counts as none", JUDGEMENT)
    upper_limit: float = setting(0.95, "1", "confidence of the upper limit at which an unstated deviation is taken", JUDGEMENT)
    largest_upper_limit: float = setting(1.5, "1", "most by which that limit exceeds the estimate", JUDGEMENT)
    contradiction_factor: float = setting(
        1.4, "1", "ratio of estimated to stated noise that counts as a contradiction", JUDGEMENT
    )
    contradiction_width: float = setting(
        2.4, "1", "widening of that ratio by width / sqrt(independent samples)",
        f"{DERIVED}: two standard errors of an estimate from the median of differences",
    )  # fmt: skip
    quantisation_ratio: float = setting(
        0.2,
        "1",
        "estimated over stated noise below which the channel is coarsely quantised, and the stated noise holds",
        JUDGEMENT,
    )
    recurrence: int = setting(4, "1", "mean samples on each level of a signal that counts as quantised", JUDGEMENT)
    dithering: float = setting(
        2.0, "1", "resolution over deviation above which a signal at rest stays on one level, and its mean is off as a whole",
        f"{DERIVED}: the error of a mean of rounded normal samples, exp(-2 pi^2 s^2 / q^2), is 0.7 % of a step at s = q / 2",
    )  # fmt: skip
    differences: int = setting(6, "1", "order of the differences that tell vibration from the rope's motion", JUDGEMENT)
    least_factor: float = setting(1.3, "1", "least ratio of the noise in motion to that at rest that counts", JUDGEMENT)
    factor_width: float = setting(
        5.0, "1", "the same in standard errors of the ratio: sixth differences of white noise are correlated", JUDGEMENT
    )
    floor: float = setting(1e-9, "SI", "least noise where none is stated, absolute part", "keeps a constant channel finite")
    floor_share: float = setting(1e-4, "1", "the same, share of the channel's standard deviation", JUDGEMENT)


@dataclass(frozen=True)
class Plausibility:
    """What `comprope check` says about channels before any simulation."""

    min_samples: int = setting(20, "1", "fewest samples of a channel that is judged", JUDGEMENT)
    min_rolling: float = setting(0.2, "rad/s", "least angular velocity of the sheave that tells sign, unit and delay", JUDGEMENT)
    min_correlation: float = setting(
        0.9, "1", "correlation with the rolling speed from which on sign, unit and delay are told", JUDGEMENT
    )
    swapped: float = setting(0.98, "1", "correlation from which on another channel is the angular velocity", JUDGEMENT)
    gain: float = setting(1.3, "1", "ratio to the rolling speed, or its inverse, from which on a unit is wrong", JUDGEMENT)
    delay: float = setting(0.06, "s", "delay against the car that is told; the sheave follows within less", JUDGEMENT)
    max_delay: float = setting(2.0, "s", "largest delay that is looked for", JUDGEMENT)
    delay_samples: int = setting(5000, "1", "samples that determine a delay; a longer record is thinned to them", JUDGEMENT)
    delay_step: float = setting(0.01, "s", "resolution of the delay", JUDGEMENT)
    turning_at_rest: float = setting(
        0.02, "1", "angular velocity of a sheave at rest, as a share of its largest, that is told", JUDGEMENT
    )
    min_gaps: float = setting(
        0.03, "1", "share of missing samples, and of others, that tells where a sensor sees the rope", JUDGEMENT
    )
    poor_view: float = setting(
        0.85, "1", "share of samples that agree with what a sensor can see, below which it is doubted", JUDGEMENT
    )
    good_view: float = setting(0.95, "1", "the same share above which another arrangement is believed", JUDGEMENT)
    succession: float = setting(43200.0, "s", "longest time between two runs that are told to follow each other", JUDGEMENT)
    elsewhere: float = setting(0.5, "m", "distance between the end of a run and the start of the next that is told", JUDGEMENT)
    fewest_runs: int = setting(2, "1", "runs that begin at one height from which on this is told", JUDGEMENT)
    same_start: float = setting(0.005, "m", "distance of the starts from the bottom landing up to which it is told", JUDGEMENT)
    lateral: float = setting(1.5, "m", "lateral displacement that no shaft has room for", JUDGEMENT)
    axle: float = setting(0.5, "m", "displacement of the sheave that no guide has room for, in a pit that is smaller", JUDGEMENT)
    tension: float = setting(1.5, "1", "ratio of a tension at rest to the weight, or its inverse, that is told", JUDGEMENT)
    alike_noise: float = setting(2.0, "1", "ratio up to which the noise of lasers is that of one kind of instrument", JUDGEMENT)
    alike_motion: float = setting(6.0, "1", "ratio up to which the rope's motion differs from one laser to the others", JUDGEMENT)
    motion_percentile: float = setting(99.0, "%", "percentile of distances from the median that is a motion's size", JUDGEMENT)
    enough_lasers: int = setting(3, "1", "lasers from which on the median of all is that of those that agree", JUDGEMENT)
    noise: float = setting(5.0, "1", "ratio of noise at rest to the stated one, or its inverse, that is told", JUDGEMENT)


TRIP_PHASES, WHITENING, NOISE, PLAUSIBILITY = TripPhases(), Whitening(), Noise(), Plausibility()
