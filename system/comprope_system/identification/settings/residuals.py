"""Constants of the analysis of residuals: correlation with coordinates, and input estimation."""

from dataclasses import dataclass

from .declaration import DERIVED, JUDGEMENT, setting


@dataclass(frozen=True)
class Correlation:
    """Correlation of the residual with coordinates."""

    profile_bins: int = setting(30, "1", "bins of a profile over a coordinate", JUDGEMENT)
    frequencies: tuple[float, float, float] = setting(
        (0.05, 8.0, 0.01), "Hz", "first, last and distance of frequencies", JUDGEMENT
    )
    orders: tuple[float, float, float] = setting(
        (0.5, 6.01, 0.02), "periods per turn", "first, last and distance of orders of the sheave's rotation", JUDGEMENT
    )
    min_periods: float = setting(1.5, "1", "fewest periods of a sinusoid in a record", JUDGEMENT)
    min_samples: int = setting(50, "1", "fewest samples of a channel in a run", JUDGEMENT)
    max_samples: int = setting(600, "1", "about the most samples of a channel in a run; more cost time only", JUDGEMENT)
    min_residual: float = setting(1.5, "noise", "rms below which a channel's residual is noise and is left out", JUDGEMENT)
    min_share: float = setting(0.3, "1", "explained share of the mean square above which a correlation is reported", JUDGEMENT)


@dataclass(frozen=True)
class ForceLocations:
    """Locations of an unknown force, and the expansion of its time history in cubic B-splines."""

    height_bands: int = setting(3, "1", "bands of height on each side in which a lateral force may act", JUDGEMENT)
    min_spacing: float = setting(0.3, "s", "least distance of splines", JUDGEMENT)
    max_splines: int = setting(40, "1", "about the most splines of a run", JUDGEMENT)
    tied_splines: int = setting(
        3,
        "1",
        "first splines that share a coefficient: a force that has acted before the record",
        f"{DERIVED}: support of a cubic B-spline",
    )
    group_size: int = setting(60, "1", "most directions of one tangent-linear run; limits its memory", JUDGEMENT)


@dataclass(frozen=True)
class Deconvolution:
    """Regularisation of the force's time history and its cross-validation."""

    smoothness: tuple[float, ...] = setting(
        (0.5, 1.0, 2.0, 4.0), "splines", "correlation lengths among which the evidence chooses", JUDGEMENT
    )
    log_size: tuple[float, float] = setting(
        (-4.0, 6.0),
        "log10 of variance",
        "range in which the evidence chooses the prior variance, over that of the noise",
        JUDGEMENT,
    )
    size_tolerance: float = setting(0.1, "log10 of variance", "tolerance of that choice", JUDGEMENT)
    folds: int = setting(5, "1", "folds of the cross-validation", JUDGEMENT)
    fold_duration: float = setting(1.0, "s", "time that one channel is left out at once", JUDGEMENT)


@dataclass(frozen=True)
class ForceReport:
    """Report of the estimated force."""

    sampling_interval: float = setting(0.1, "s", "time between reported values of a force", JUDGEMENT)
    min_sinusoid_share: float = setting(
        0.6, "1", "share above which a sinusoid is reported; any smooth history resembles one somewhat", JUDGEMENT
    )
    largest_size: float = setting(1e3, "1", "largest accepted size of a proposed effect over the estimated one", JUDGEMENT)
    comment_width: int = setting(110, "characters", "width of the comment in the file of a proposed effect", JUDGEMENT)
    max_waves: int = setting(100, "1", "most periods over the shaft of a force that follows the car's position", JUDGEMENT)
    waves_step: float = setting(0.05, "1", "distance of the numbers of periods that are tried", JUDGEMENT)
    similar_share: float = setting(
        0.1, "1", "difference of explained shares below which locations are not distinguished", JUDGEMENT
    )


CORRELATION, FORCE_LOCATIONS = Correlation(), ForceLocations()
DECONVOLUTION, FORCE_REPORT = Deconvolution(), ForceReport()
