"""Constants of predictions, hypotheses, fits and model scores."""

from dataclasses import dataclass

from .declaration import CAMPAIGNS, DERIVED, JUDGEMENT, setting


@dataclass(frozen=True)
class Replay:
    """Simulation of a measured run."""

    output_interval: float = setting(0.01, "s", "least time between outputs; channels are cubic splines in between", JUDGEMENT)
    output_steps: float = setting(2.0, "time steps", "least time between outputs, where time steps are long", JUDGEMENT)
    time_step: float = setting(
        0.005,
        "s",
        "time step of the rope",
        f"{JUDGEMENT}: error far below that of the mesh; 2 um rms at 4 ms in test_second_order_in_time",
    )
    coarsening: float = setting(2.0, "1", "factor of element length and time step in screening", JUDGEMENT)
    coarse_element: float = setting(
        0.3, "1", "longest element in screening, over the sheave's radius; a longer one does not follow the groove", JUDGEMENT
    )
    coarse_error: float = setting(
        0.25, "1", "error of the coarse mesh over what the plant's fit leaves beyond noise, up to which effects are fitted on it",
        f"{JUDGEMENT}: then it errs by half the amplitude that an effect is to explain",
    )  # fmt: skip
    height_step: float = setting(
        0.1, "m", "distance over which the slope of the rope at a sensor is differenced", f"{JUDGEMENT}: two elements"
    )
    derivative_limit: float = setting(
        1e100, "SI", "size beyond which a derivative has diverged", f"{DERIVED}: its square is still a finite number"
    )


@dataclass(frozen=True)
class Hypotheses:
    """Units and priors of the coefficients of effects and of faults of instruments; bounds of plant parameters."""

    plant_bounds: tuple[float, float] = setting(
        (-2.3, 1.4), "log of the parameter", "bounds of relative plant parameters: factors of 0.1 and 4", JUDGEMENT
    )
    amplitude_prior: float = setting(
        30.0,
        "typical values",
        "prior standard deviation of an effect's amplitude: nearly none, the score counts its cost",
        JUDGEMENT,
    )
    shape_unit: float = setting(0.2, "1", "unit of a yield curvature's coefficient, share of its value", JUDGEMENT)
    shape_lower: float = setting(0.9, "1", "largest decrease of a yield curvature, share of its value", JUDGEMENT)
    shape_prior: float = setting(5.0, "units", "prior standard deviation of a yield curvature or frequency", JUDGEMENT)
    frequency_unit: float = setting(
        0.05, "periods per run", "unit of a frequency's coefficient; its lower bound is one period per run",
        f"bound: {CAMPAIGNS}, 415",
    )  # fmt: skip
    heights: tuple[float, ...] = setting(
        (0.02, 0.06, 0.14), "shaft heights",
        "heights above the bottom landing at which brushes and guides of the rope are tried; fits move them",
        f"{JUDGEMENT}: they stand in the pit and just above it, where the rope leaves the sheave",
    )  # fmt: skip
    height_unit: float = setting(0.5, "m", "unit of a height's coefficient", f"{JUDGEMENT}: half a rope guide's length")
    gain_unit: float = setting(0.02, "1", "unit of a gain error: that of a laser sensor", JUDGEMENT)
    gain_prior: float = setting(
        100.0, "units", "prior standard deviation of a gain: a wrong sign or unit is a gain too", JUDGEMENT
    )
    delay_unit: float = setting(0.01, "s", "unit of a sensor's delay", JUDGEMENT)
    delay_prior: float = setting(10.0, "units", "prior standard deviation of a delay", JUDGEMENT)
    sensor_height_unit: float = setting(0.05, "m", "unit of an error of a sensor's height", JUDGEMENT)
    sensor_height_prior: float = setting(10.0, "units", "prior standard deviation of that error", JUDGEMENT)
    sensor_height_bound: float = setting(
        10.0, "units", "largest error of a sensor's height", f"{JUDGEMENT}: half a metre; further off it is another sensor"
    )
    drift_time: float = setting(60.0, "s", "unit of a drift: one standard deviation of the noise in this time", JUDGEMENT)
    drift_prior: float = setting(100.0, "units", "prior standard deviation of a drift", JUDGEMENT)
    offset_prior: float = setting(30.0, "noise", "prior standard deviation of an offset", JUDGEMENT)
    assumed_noise: float = setting(
        0.1, "unit of the channel", "noise in units of drift and offset where none is stated", JUDGEMENT
    )


@dataclass(frozen=True)
class Linearisation:
    """Derivatives of predictions by coefficients."""

    parameter_step: float = setting(
        1e-4, "1", "difference of a coefficient from which the derivatives of model parameters by it are taken", JUDGEMENT
    )
    effect_step: float = setting(
        1.0, "typical values", "difference of an effect's amplitude; friction does little until it has some size", JUDGEMENT
    )
    oscillation_step: float = setting(
        0.1, "typical values", "the same for an oscillating effect: near a resonance its typical value moves the rope by metres",
        f"{CAMPAIGNS}, 122",
    )  # fmt: skip


@dataclass(frozen=True)
class GaussNewton:
    """Iteration of a nonlinear fit."""

    min_gain: float = setting(
        2.0, "1", "gain of the log score below which the iteration ends: chi-square may still fall by 4, of a large one by 2 %",
        f"{JUDGEMENT}: verdicts differ by 7; stick and slip make chi-square rough on that scale",
    )  # fmt: skip
    max_iterations: int = setting(40, "1", "most iterations", JUDGEMENT)
    min_gain_ratio: float = setting(
        0.5, "1", "actual over predicted decrease below which derivatives are computed anew instead of updated", JUDGEMENT
    )
    trusted_iteration: int = setting(
        3, "1", "iteration from which the linear prediction of the final chi-square may end a fit; friction is far from linear",
        JUDGEMENT,
    )  # fmt: skip
    hopeless_factor: float = setting(
        6.0, "1", "factor by which the prediction must exceed the limit to end a fit earlier", JUDGEMENT
    )
    far_from_data: float = setting(
        5.0, "1", "reduced chi-square above which a fit of the plant alone is only evaluated on the full mesh", JUDGEMENT
    )
    step_fractions: tuple[float, ...] = setting((1.0, 0.3, 0.1, 0.03), "1", "shares of a step that are tried in turn", JUDGEMENT)


@dataclass(frozen=True)
class InitialGuess:
    """Start of a fit."""

    size_factors: tuple[float, float] = setting((2.5, 0.4), "1", "factors of the effect's amplitudes that are tried", JUDGEMENT)
    linearity: float = setting(
        0.15, "1", "error of the chi-square predicted by screening, share of what the effect explains or leaves, "
        "below which its coefficients are the initial guess", JUDGEMENT,
    )  # fmt: skip
    max_size_steps: int = setting(3, "1", "most repetitions of a factor that has improved the chi-square", JUDGEMENT)


@dataclass(frozen=True)
class MassSearch:
    """Grid search over the rope's mass."""

    reach: float = setting(0.24, "log of the mass", "largest deviation from the data sheet", JUDGEMENT)
    spacing: float = setting(
        0.04,
        "log of the mass",
        "distance of grid points",
        f"{DERIVED}: 20 oscillations shift by 2.5 rad, less than half a period",
    )
    min_gain: float = setting(
        10.0, "1", "log score that another mass must gain by linear prediction: a tenth of a large chi-square, 20 near the noise",
        f"{JUDGEMENT}: half of it would decide a verdict",
    )  # fmt: skip


@dataclass(frozen=True)
class Score:
    """Model score: log likelihood of independent samples, less penalties."""

    effective_samples: float = setting(
        200.0, "1", "independent samples that a model's discrepancy counts as; it is the same in thousands of samples",
        "intervals and probabilities: benchmarks/score_campaigns.py --add",
    )  # fmt: skip
    parameter_penalty: float = setting(
        2.5, "1", "penalty for each parameter of an effect", f"{DERIVED}: about log(effective_samples) / 2, as BIC"
    )
    run_phase_penalty: float = setting(1.0, "1", "penalty for the phase of each run", JUDGEMENT)
    model_error: float = setting(
        0.005, "1", "share of the noise's chi-square that errors of mesh, time step, recovered trip and noise model leave",
        "nearly twice what absent effects explained at most in eight campaigns with nothing hidden (benchmarks/RESULTS.md)",
    )  # fmt: skip
    noise_limit: float = setting(
        1.1, "1", "largest reduced chi-square that may be noise alone", f"{DERIVED}: stated noise is right to 5 %"
    )
    prior_degrees: float = setting(
        4.0, "1", "degrees of freedom of Student's t for plant parameters: data sheets may be wrong by more than usual",
        f"{CAMPAIGNS}, 618",
    )  # fmt: skip


@dataclass(frozen=True)
class Estimates:
    """Parameter estimates."""

    confidence_quantile: float = setting(
        1.96, "standard errors", "half width of a 95 % interval", f"{DERIVED}: normal distribution"
    )
    strong_correlation: float = setting(
        0.95, "1", "correlation of two estimates above which it is reported",
        f"{DERIVED}: with the other one known, the standard error would be less than a third",
    )  # fmt: skip
    run_phase_prior: float = setting(1.0, "rad", "prior standard deviation of a run's phase about the common one", JUDGEMENT)


REPLAY, HYPOTHESES, LINEARISATION, GAUSS_NEWTON = Replay(), Hypotheses(), Linearisation(), GaussNewton()
INITIAL_GUESS, MASS_SEARCH, SCORE, ESTIMATES = InitialGuess(), MassSearch(), Score(), Estimates()
