"""Constants of the comparison with measurements, of messages about data quality, of model updating, and of previews."""

from dataclasses import dataclass

from .declaration import JUDGEMENT, setting


@dataclass(frozen=True)
class Comparison:
    """Error measures."""

    rounding: float = setting(
        1e-12, "1", "variation over the largest value up to which a channel does not move", "rounding in the conversion of units"
    )
    position_bins: int = setting(10, "1", "bins of the car's position over the height of the shaft", JUDGEMENT)
    frequency_bands: tuple[float, ...] = setting(
        (0.0, 0.2, 0.5, 1.0, 2.0, 5.0, float("inf")), "Hz", "limits of frequency bands", JUDGEMENT
    )
    orders: tuple[float, float, float] = setting(
        (0.2, 6.01, 0.05), "periods per turn", "first, last and distance of orders of the sheave's rotation", JUDGEMENT
    )
    min_turns: float = setting(1.5, "1", "turns of the sheave that an order spectrum needs", JUDGEMENT)
    min_samples: int = setting(20, "1", "samples that any measure needs", JUDGEMENT)
    adequate: float = setting(1.2, "1", "reduced chi-square below which noise explains the residual", JUDGEMENT)
    chance: float = setting(
        4.0, "standard deviations", "of the reduced chi-square of one phase of a trip above that limit, which noise may reach",
        "1 in 30 000 for each phase of each channel",
    )  # fmt: skip


@dataclass(frozen=True)
class PairedRecords:
    """Measured and simulated channel side by side."""

    min_samples: int = setting(30, "1", "samples that a message about a channel needs", JUDGEMENT)
    min_variation: float = setting(3.0, "noise", "standard deviation that a channel needs for its gain or delay", JUDGEMENT)


@dataclass(frozen=True)
class ClockOffset:
    """Delay that all channels have in common against the car's position."""

    max_offset: float = setting(1.0, "s", "largest offset that is searched", JUDGEMENT)
    min_offset: float = setting(0.012, "s", "least offset that is reported", JUDGEMENT)
    model_uncertainty: float = setting(0.01, "s", "shift of a channel by errors of the model alone", JUDGEMENT)
    min_correlation: float = setting(0.85, "1", "correlation at the best shift that a delay needs", JUDGEMENT)


@dataclass(frozen=True)
class DataQuality:
    """Messages about channels and runs."""

    min_correlation: float = setting(0.7, "1", "correlation with the model that a message about sign or unit needs", JUDGEMENT)


@dataclass(frozen=True)
class ModelUpdating:
    """Stepwise selection of effects."""

    max_effects: int = setting(4, "1", "most effects that `comprope improve` adds", JUDGEMENT)


@dataclass(frozen=True)
class Preview:
    """Previews of effects, interpolated between replays."""

    reach: tuple[float, ...] = setting(
        (0.0, 0.5, 1.0, 1.5), "present size", "nodes at which an effect is replayed",
        "benchmarks/preview.py: within half a point of NRMSE",
    )
    reach_at_limit: tuple[float, ...] = setting(
        (0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0), "present size", "nodes of a parameter that may not be larger", JUDGEMENT
    )
    max_sliders: int = setting(2, "1", "most parameters that are moved at once", "the mixed part is known for two")
    least_coefficient: float = setting(0.05, "typical size", "size below which a parameter stays as it is", JUDGEMENT)
    max_rivals: int = setting(2, "1", "rivals of the verdict with a preview", "size of the page")
    rival_factor: float = setting(4.0, "1", "chi-square over the least, up to which a fit is a rival", "twice the residual")


COMPARISON, PAIRED_RECORDS, CLOCK_OFFSET = Comparison(), PairedRecords(), ClockOffset()
DATA_QUALITY, MODEL_UPDATING, PREVIEW = DataQuality(), ModelUpdating(), Preview()
