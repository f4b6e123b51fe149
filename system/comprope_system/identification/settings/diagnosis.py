"""Constants of the diagnosis: screening, candidate fits, verdict, proposed experiments."""

from dataclasses import dataclass

from .declaration import CAMPAIGNS, DERIVED, JUDGEMENT, setting


@dataclass(frozen=True)
class Frequencies:
    """Frequencies that are tried for oscillating effects."""

    sway_lowest: float = setting(
        0.05,
        "Hz",
        "lowest frequency of the scan over building sway",
        f"{JUDGEMENT}: natural frequency of a building about 46 Hz m / height",
    )
    sway_highest: float = setting(1.5, "Hz", "highest frequency of that scan", f"{JUDGEMENT}: the same, for buildings from 30 m")
    sway_spacing: float = setting(0.5, "periods per run", "distance of its frequencies", f"{DERIVED}: half the width of a peak")
    sway_count: int = setting(3, "1", "peaks of that scan that are screened", JUDGEMENT)
    sway_cutoff: float = setting(1e-9, "1", "relative singular value below which a response is left out", "rounding")
    peak_lowest: float = setting(0.05, "Hz", "lowest frequency of the residual's spectrum", JUDGEMENT)
    peak_highest: float = setting(3.0, "Hz", "highest frequency of that spectrum", JUDGEMENT)
    peak_grid: int = setting(600, "1", "number of its frequencies", JUDGEMENT)
    peak_count: int = setting(3, "1", "its peaks that are screened", JUDGEMENT)
    min_samples: int = setting(100, "1", "fewest samples of a channel that enters it", JUDGEMENT)
    max_samples: int = setting(800, "1", "most samples of a channel that enter it; more cost time only", JUDGEMENT)


@dataclass(frozen=True)
class Screening:
    """Linear screening of hypotheses."""

    masses: tuple[float, ...] = setting(
        (-0.2, -0.1, 0.1, 0.2), "log of the mass", "masses of the rope at which it is repeated", f"{CAMPAIGNS}, office28"
    )
    indistinguishable: float = setting(
        0.7, "1", "cosine between responses, plant projected out, above which two effects are indistinguishable",
        "trials with twin effects: drag and dry friction had 0.82",
    )  # fmt: skip
    sizes: tuple[float, ...] = setting(
        (3.0, 10.0), "typical values", "sizes at which effects are screened besides the least", JUDGEMENT
    )
    delays: tuple[float, ...] = setting(
        (-0.2, -0.1, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6), "s", "delays at which instruments are screened",
        f"{DERIVED}: a delay is fitted from a quarter period off; the rope's shortest period is about half a second",
    )  # fmt: skip
    close_fit: float = setting(
        5.0, "1", "reduced chi-square of the plant's fit below which screening uses its derivatives only", JUDGEMENT
    )


@dataclass(frozen=True)
class Candidates:
    """Which effects are fitted on the full model."""

    max_fits: int = setting(4, "1", "best effects of the screening that are fitted in any case", JUDGEMENT)
    abandon_factor: float = setting(1.2, "1", "chi-square over the best fit's above which a fit is abandoned", JUDGEMENT)
    min_share: float = setting(0.1, "1", "share of the best effect's improvement that is worth a fit", JUDGEMENT)
    min_improvement: float = setting(0.01, "1", "improvement of reduced chi-square that is worth a fit", JUDGEMENT)
    optimism: float = setting(0.5, "1", "share by which an effect may improve more than screening predicts", JUDGEMENT)
    near_factor: float = setting(1.15, "1", "chi-square over the best fit's that is near enough to be fitted", JUDGEMENT)
    pair_threshold: float = setting(
        0.85, "1", "share of the plant's chi-square that the best effect may leave if a second one is sought", JUDGEMENT
    )
    max_pairs: int = setting(2, "1", "second effects that are fitted with the first", JUDGEMENT)
    max_mass_fits: int = setting(2, "1", "effects screened at other masses that are fitted", JUDGEMENT)
    mass_improvement: float = setting(0.7, "1", "share of the best fit's chi-square that they must reach in screening", JUDGEMENT)
    close_score: float = setting(
        7.0, "1", "log score below the best one's up to which a fit is continued on the full mesh",
        f"{DERIVED}: a probability of 0.001",
    )
    explained: float = setting(
        1.1, "1", "reduced chi-square that counts as explained: below it effects are not screened at several sizes", JUDGEMENT
    )
    mass_threshold: float = setting(
        2.0, "1", "reduced chi-square of the best fit above which effects are screened at other masses", f"{CAMPAIGNS}, office28"
    )
    shape_threshold: float = setting(
        1.05, "1", "reduced chi-square of a fit below which its shape parameters are not fitted", JUDGEMENT
    )
    shape_improvement: float = setting(
        0.97, "1", "share of its chi-square that a fit must reach for its shape parameters to be kept", JUDGEMENT
    )


@dataclass(frozen=True)
class Verdict:
    """Hypothesis of an unknown effect, and what is reported beside the verdict."""

    unknown_share: float = setting(
        0.04, "1", "share of the excess chi-square that an unknown effect is assumed to leave", JUDGEMENT
    )
    unknown_penalty: float = setting(10.0, "1", "complexity penalty of an unknown effect", JUDGEMENT)
    unknown_chi_square: float = setting(
        1.06, "1", "largest reduced chi-square that it is assumed to leave", "elevator of the tests, correct effect with 1.08"
    )
    unknown_prior_cost: float = setting(5.0, "1", "largest prior cost of the plant that it is charged with", JUDGEMENT)
    incomplete_chi_square: float = setting(
        1.5, "1", "reduced chi-square of the verdict's fit above which more may be missing, as is then reported", JUDGEMENT
    )
    overestimated_chi_square: float = setting(
        0.4, "1", "reduced chi-square below which the noise is reported as overestimated",
        f"{DERIVED}: an unstated deviation is taken at most 1.5 times too large (Noise.largest_upper_limit), 1 / 1.5^2 = 0.44",
    )  # fmt: skip
    likely_probability: float = setting(
        0.02, "1", "probability above which an effect indistinguishable from the verdict is reported", JUDGEMENT
    )
    detection_margin: float = setting(
        7.0, "1", "log score above that of an adequate model, of an effect at its detection limit",
        f"{DERIVED}: a probability of 0.999, so that noise seldom hides it",
    )  # fmt: skip
    implausible_deviation: float = setting(
        4.0, "prior standard deviations", "deviation of a plant parameter that is reported as implausible", JUDGEMENT
    )


@dataclass(frozen=True)
class Experiments:
    """Runs that are proposed for measurement."""

    weights: tuple[float, ...] = setting((0.5, 1.0, 1.5), "sheave masses", "weights of the sheave that are tried", JUDGEMENT)
    distances: tuple[float, ...] = setting((0.9, 0.4), "shaft heights", "distances that are tried", JUDGEMENT)
    speeds: tuple[float, ...] = setting((1.0, 0.6), "1", "speeds that are tried, over the largest one measured", JUDGEMENT)
    rest_before: float = setting(2.0, "s", "rest before a proposed trip", JUDGEMENT)
    rest_after: float = setting(6.0, "s", "record after it", JUDGEMENT)
    sampling_interval: float = setting(0.02, "s", "sampling of its predictions", JUDGEMENT)
    acceleration_share: float = setting(
        0.6,
        "1",
        "speed^2 / (acceleration distance): largest value, so that the car reaches its speed",
        f"{DERIVED}: 1 / 1.5 less a margin",
    )
    conclusive_probability: float = setting(0.95, "1", "probability of a verdict above which no run is proposed", JUDGEMENT)


FREQUENCIES, SCREENING, CANDIDATES, VERDICT, EXPERIMENTS = Frequencies(), Screening(), Candidates(), Verdict(), Experiments()
