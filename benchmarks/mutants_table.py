"""The mutants: for each a text in the sources, what replaces it, and the tests of which at least one must fail then.

A mutant's `place` is a file or a folder below the repository's root, in which its original text must be found exactly once,
within `function` where one is named, so that the table follows the sources or says that it does not.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Mutant:
    """One fault: `original` becomes `replacement`; names are `area.fault`."""

    name: str
    place: str
    original: str
    replacement: str
    tests: tuple[str, ...]
    function: str = ""

    @property
    def area(self) -> str:
        """The part of the program that it is in."""
        return self.name.partition(".")[0]

    @property
    def in_kernels(self) -> bool:
        """Whether it is in kernels, whose tests run without a compiler."""
        return self.place.startswith((ROPE, DRIVE))


ROPE, DRIVE, FMI = "fmu_src/comprope/rope", "fmu_src/comprope/drive", "fmu_src/comprope/fmi"
MECHANICS, INTEGRATION, EFFECTS = f"{ROPE}/mechanics", f"{ROPE}/integration", f"{ROPE}/effects"
SENSITIVITY, LINALG, SIMULATOR = f"{ROPE}/sensitivity", f"{ROPE}/linalg", f"{ROPE}/simulator"
IDENTIFICATION, MEASUREMENTS = "system/comprope_system/identification", "system/comprope_system/measurements"
CHANNEL_NOISE, NOISE_MODEL = f"{IDENTIFICATION}/data/channel_noise.py", f"{IDENTIFICATION}/data/noise_model.py"
WHITENING, SCORE = f"{IDENTIFICATION}/data/whitening.py", f"{IDENTIFICATION}/estimation/model_score.py"
LEAST_SQUARES, METRICS = f"{IDENTIFICATION}/estimation/weighted_least_squares.py", f"{IDENTIFICATION}/comparison"
SWEEP, INSTANCE, VALIDATION = "system/comprope_system/parallel/sweep.py", f"{FMI}/instance.py", f"{FMI}/validation.py"

FORCES = "test_time_step.py::test_forces_are_those_of_the_equations"
STEP = "test_time_step.py::test_a_step_follows_newmark_s_rule_and_balances_as_hilber_hughes_and_taylor_have_it"
STORED = "test_time_step.py::test_stored_energies_and_losses_are_those_of_the_motion"
WORK = "test_time_step.py::test_the_ends_do_the_work_of_their_holders_and_the_energy_balances"
SIDEWAYS = "test_time_step.py::test_ends_that_move_sideways_do_the_work_of_their_lateral_forces"
STEPS = "test_time_step.py::test_a_communication_step_has_as_many_time_steps_as_its_length_and_speed_ask_for"
BY_POSITION, BY_VELOCITY = "test_rope_kernels.py::test_tangent_by_position", "test_rope_kernels.py::test_tangent_by_velocity"
ELIMINATION = "test_rope_kernels.py::test_elimination_from_both_ends_equals_a_dense_solve"
CONTACT = "test_effect_forces.py::test_the_contact_stores_and_loses_what_it_takes"
FORMULA, RESTS = (f"test_effect_forces.py::test_{name}" for name in (
    "effect_pushes_as_its_formula_says", "a_rope_hung_with_an_effect_stays_at_rest"))  # fmt: skip
ECCENTRIC = "test_effect_forces.py::test_an_eccentric_groove_lifts_the_axle_and_shifts_the_rope_towards_its_centre"
ENDS = "test_effect_forces.py::test_effect_moves_the_ends_as_its_formula_says"
DERIVATIVES = "test_sensitivity_step.py::test_derivatives_are_those_of_whole_runs"
OUTPUTS, UNITS, CONSENT = "test_rope_outputs.py", "test_units_of_measurements.py", "test_consent.py"
NOISY = "test_noise_model.py"
WHITE, SCORES, CLOCK = "test_whitening.py", "test_model_score.py", "test_clock_offset.py"
DESIGN = "test_drive_design.py"
SERVO, DRIVEN, COURSE, TRIP = (f"test_drive_{name}.py" for name in ("servo", "simulator", "reference_trajectory", "s_curve"))
STARTS = "test_fmi_initialization.py"
FMI_RUN, FMI_INSTANCE, SWEEPS = "test_fmi_without_fmu.py", "test_fmi_instance.py", "test_sweep.py"


def mutants(area: str, place: str, *rows: tuple[str, ...]) -> list[Mutant]:
    """Mutants of a place from rows of name, original, replacement, test, and the function if the text is not unique."""
    return [Mutant(f"{area}.{row[0]}", place, row[1], row[2], (row[3],), *row[4:]) for row in rows]


MUTANTS = [
    *mutants(
        "mechanics", MECHANICS,
        ("strain_sign", "p[EA] * (L - l)", "p[EA] * (l - L)", FORCES),
        ("axial_damping_sign", "+ p[CA] * (tx * vx", "- p[CA] * (tx * vx", FORCES),
        ("bending_damping_dropped", " + p[CB] * w[BEND_RATE * m + i]", "", FORCES),
        ("spin_sum", "w[SPIN * m + i] - w[SPIN * m + i - 1]", "w[SPIN * m + i] + w[SPIN * m + i - 1]", FORCES),
        ("shear_of_sum", "w[MOMENT * m + e] - w[MOMENT * m + e + 1]", "w[MOMENT * m + e] + w[MOMENT * m + e + 1]", FORCES),
        ("shear_direction", "- w[SHEAR * m + e] * w[TY * m + e]", "+ w[SHEAR * m + e] * w[TY * m + e]", FORCES),
        ("end_of_whole_weight", "f[0] = w[FX * m] + 0.5 * weight", "f[0] = w[FX * m] + weight", FORCES),
        ("other_end_weightless", "f[n - 1] = -w[FX * m + n - 2] + 0.5 * weight", "f[n - 1] = -w[FX * m + n - 2]", FORCES),
        ("external_damping_one_way", " - drag * v[m + i]", "", FORCES),
        ("angle_series", "3.0 / 40.0", "1.0 / 40.0", "test_rope_kernels.py::test_angle_of_a_sine"),
        ("weight_of_sheave_dropped", "f[n] = p[M] * p[G]", "f[n] = 0.0", FORCES),
        ("geometric_stiffness_sign", "along * tx * tx + across * ty * ty", "along * tx * tx - across * ty * ty", BY_POSITION),
        ("bending_tangent_without_damping", " + cc * p[CB]", "", BY_VELOCITY),
        ("bending_tangent_without_effects", "(p[EI] + w[STIFF * m + i])", "p[EI]",
         "test_rope_kernels.py::test_effect_keeps_the_tangent_right"),
        ("mass_of_node_without_length", "return p[RHO] * p[ELEMENT]", "return p[RHO]", STEP),
    ),
    *mutants(
        "contact", MECHANICS,
        ("radius_of_pitch", "(12.0 * p[R])", "(24.0 * p[R])", FORCES),
        ("damping_at_first_touch", "c * depth / (depth + fade)", "c",
         "test_rope_kernels.py::test_contact_pushes_but_never_pulls"),
        ("suction", "if force <= 0.0:", "if force <= -1e300:", "test_rope_kernels.py::test_contact_pushes_but_never_pulls"),
        ("regularisation", "return p[MU] * slip * root,", "return p[MU] * slip / abs(slip + 1e-300),",
         "test_rope_kernels.py::test_friction_opposes_slip_and_is_bounded"),
        ("slip_of_spin", "nx * vy - ny * vx + spin * radius", "nx * vy - ny * vx - spin * radius", FORCES),
        ("friction_direction", "(nx + grip * ny)", "(nx - grip * ny)", FORCES),
        ("arm_of_eccentric_groove", "lx, ly = gx + radius * ny, gy", "lx, ly = radius * ny, gy", CONTACT),
        ("groove_at_rest", "v[n] + spin * gx", "v[n] - spin * gx", CONTACT),
        ("torque_sign", "f[m + n] -= turn", "f[m + n] += turn", FORCES),
        ("lift_sign", "contact[FORCE_X] -= ", "contact[FORCE_X] += ", OUTPUTS),
        ("elastic_energy_doubled", "0.5 * length * p[K]", "length * p[K]", STORED),
        ("damping_loss_with_elastic_part", "(P - p[K] * depth) * rate", "P * rate", STORED),
        ("friction_loss_of_spin", "length * P * grip * slip", "length * P * grip * spin", STORED),
        ("spline_weights", "0.75 - xi * xi", "0.75 - 0.5 * xi * xi", FORCES),
        ("tangent_without_slip", "P * grip_slip * s_t", "0.0", BY_VELOCITY),
    ),
    *mutants(
        "energy", f"{MECHANICS}/energy.py",
        ("whole_mass_of_ends", "share = 0.5 if", "share = 1.0 if", STORED),
        ("weight_of_sheave_dropped", " - p[M] * p[G] * q[n]", "", STORED),
        ("strain_energy_doubled", "0.5 * p[EA] / l", "p[EA] / l", STORED),
        ("bending_energy_doubled", "0.5 * p[EI] * l", "p[EI] * l", STORED),
        ("bending_loss_per_length", "p[CB] * l * bending", "p[CB] / l * bending", STORED),
        ("drag_loss_one_way", "drag += v[i] * v[i] + v[m + i] * v[m + i]", "drag += v[i] * v[i]", STORED),
        ("counterweight_s_holder_of_the_car", "half * a[n - 1] - f[n - 1]", "half * a[n - 1] - f[0]", WORK),
        ("lateral_work_dropped", "(q[m + n - 1] - q0[m + n - 1])", "0.0", SIDEWAYS),
        ("work_of_the_old_force", "0.5 * (P0[2] + P[2])", "P0[2]", WORK),
        ("losses_of_the_old_power", "0.5 * h * (P0[END_FORCES + k] + P[END_FORCES + k])", "h * P0[END_FORCES + k]", STORED),
    ),
    *mutants(
        "ends", MECHANICS,
        ("quintic_coefficient", "6.0 * rise - 3.0 * climb + 0.5 * bow", "6.0 * rise - 3.0 * climb - 0.5 * bow",
         "test_rope_kernels.py::test_ends_follow_a_motion_of_fifth_order_exactly"),
        ("acceleration_over_one_dt", "a / (dt * dt)", "a / dt",
         "test_rope_kernels.py::test_ends_follow_a_motion_of_fifth_order_exactly"),
        ("ends_swapped", "((0, 0), (1, m), (2, n - 1), (3, m + n - 1))", "((2, 0), (1, m), (0, n - 1), (3, m + n - 1))",
         "test_time_step.py::test_the_ends_are_where_their_path_ends"),
    ),
    *mutants(
        "sensors", f"{MECHANICS}/sensors.py",
        ("cubic_coefficient", "2.0 * a - 5.0 * b", "2.0 * a - 4.0 * b",
         "test_rope_kernels.py::test_sensor_reads_a_quadratic_exactly_and_a_cubic_closely"),
        ("bisection_the_wrong_way", "falling = values[i] > values[i + 1]", "falling = values[i] < values[i + 1]",
         "test_rope_kernels.py::test_sensor_reads_a_quadratic_exactly_and_a_cubic_closely"),
        ("maximum_below_the_axle", "q[i] <= q[n] and", "q[i] >= q[n] and", OUTPUTS),
        ("depth_of_the_axle", "best, depth = side * q[m + i], q[i]", "best, depth = side * q[m + i], q[n]", OUTPUTS),
    ),
    *mutants(
        "effects", EFFECTS,
        ("drag_doubled", "push = -k * abs(u) * u", "push = -2.0 * k * abs(u) * u", FORMULA),
        ("wind_of_the_falling_car", "copysign(1.0, y) * -v[0]", "copysign(1.0, y) * v[0]", FORMULA),
        ("coulomb_not_regularised_to_scale", "sqrt(v * v + v0 * v0)", "sqrt(v * v + v0)", FORMULA),
        ("bearing_without_viscous_part", " + p[VISCOUS] * spin", "", FORMULA),
        ("guide_of_the_sheave_s_spin", "sign(v[n], LIFT0)[0]", "sign(v[2 * n + 1], LIFT0)[0]", FORMULA),
        ("damper_pushes", "f[n] -= p[DAMPER] * v[n]", "f[n] += p[DAMPER] * v[n]", FORMULA),
        ("slip_grows_instead_of_fading", "exp(-abs(change) / yielding)", "exp(abs(change) / yielding)", FORMULA),
        ("slip_begins_full", "h0[SLIP * m + i] = 0.0", "h0[SLIP * m + i] = 1.0", RESTS),
        ("own_curvature_of_the_other_sign", "w[MOMENT * m + i] -= own", "w[MOMENT * m + i] += own", FORMULA),
        ("eccentric_phase_of_the_other_sign", "angle + p[PHASE]", "angle - p[PHASE]", ECCENTRIC),
        ("sway_from_the_landing", "(p[PIT] - q[i]) * per_metre", "-q[i] * per_metre", ENDS),
        ("offset_inward", "q[n + 1] -= p[CAR]", "q[n + 1] += p[CAR]", ENDS),
        ("sway_s_velocity_dropped", " + share * rate * c", "",
         "test_rope_kernels.py::test_effect_moves_the_ends_with_consistent_velocity_and_acceleration"),
        ("power_of_the_drag", "power += push * (nx * v[i] + ny * v[m + i])", "power += push * u",
         "test_rope_kernels.py::test_drag_in_a_wind_states_its_power_on_the_rope_and_not_that_by_the_air"),
    ),
    *mutants(
        "linalg", LINALG,
        ("elimination_sign", "A[DXY * m + j] -= exx * axy + eyx * ayy", "A[DXY * m + j] += exx * axy + eyx * ayy", ELIMINATION),
        ("substitution_of_one_neighbour", "- (L[9 * m + i] * kx + L[10 * m + i] * ky)",
         "- (L[9 * m + i] * jx + L[10 * m + i] * jy)", ELIMINATION),
        ("border_of_the_sheave", "determinant = a * d - b * c", "determinant = a * d + b * c", ELIMINATION),
        ("row_of_the_border", "r[m + n] -= B[ROW * size + 2 * k + 1] * value", "r[m + n] -= B[ROW * size + 2 * k] * value",
         ELIMINATION),
    ),
    *mutants(
        "integration", INTEGRATION,
        ("predictor_of_whole_acceleration", "0.5 * h * a0[i]", "h * a0[i]", STEP),
        ("beta_of_no_damping", "change = beta * h * h * r[i]", "change = 0.25 * h * h * r[i]", STEP),
        ("gamma_of_no_damping", "v[i] += gamma * h * r[i]", "v[i] += 0.5 * h * r[i]", STEP),
        ("old_force_forgotten", "r[i] = (1.0 - alpha) * f[i] + alpha * f0[i]",
         "r[i] = (1.0 - alpha) * f[i] + alpha * f[i]", STEP),
        ("kept_force_of_the_sheave", "(p[J] * a[m + n] - alpha * f0[m + n])", "(p[J] * a[m + n] + alpha * f0[m + n])", STEP),
        ("inertia_of_the_sheave", "alpha * f0[m + n] - p[J] * a[m + n]", "alpha * f0[m + n] - p[M] * a[m + n]", STEP),
        ("acceleration_carried_without_its_velocity", "v[c + i] += gamma * h * change", "v[c + i] += 0.0 * h * change", STEP),
        ("tolerance", "TOLERANCE = 1e-8", "TOLERANCE = 1e-5", STEP),
        ("ends_behind_by_a_step", "s = (k + done + size) / steps", "s = (k + done) / steps",
         "test_time_step.py::test_the_ends_are_where_their_path_ends"),
        ("car_alone_counts", "return max(fastest, abs(path[counterweight])", "return max(fastest, 0.0 * abs(path[counterweight])",
         STEPS),
        ("travel_of_a_whole_element", "= 0.6  # of an element", "= 1.2  # of an element", STEPS),
        ("one_step_more_by_rounding", "ceil(share * (1.0 - 1e-9))", "ceil(share)", STEPS),
        ("counterweight_inward", "SIGNS = (-1.0, -1.0, -1.0, 1.0)", "SIGNS = (-1.0, -1.0, -1.0, -1.0)",
         "test_rope_kernels.py::test_paths_join_smoothly_and_reach_a_steady_motion"),
        ("curvature_of_the_parabola", "2.0 * bow", "bow", "test_rope_kernels.py::test_parabola_through_uneven_samples",
         "parabola"),
        ("target_without_half", "0.5 * ahead * a", "ahead * a",
         "test_rope_kernels.py::test_paths_join_smoothly_and_reach_a_steady_motion"),
        ("reach_without_the_sheave", "- lowest >= p[R]", "- lowest >= 0.0",
         "test_time_step.py::test_ends_too_far_apart_to_reach_are_refused"),
        ("chords", "(48.0 * p[R] * p[R])", "(96.0 * p[R] * p[R])",
         "test_time_step.py::test_elements_make_up_for_the_chords_at_the_sheave"),
        ("history_not_begun", "all_begin(n, p,", "(lambda *_: None)(n, p,", RESTS),
        ("equilibrium_with_the_sheave_s_torque", "r[m + n] = 0.0", "pass", ECCENTRIC, "equilibrium_residual"),
    ),
    *mutants(
        "starts", INTEGRATION,
        ("any_start", "abs(lifted) <= LARGEST_LIFT", "abs(lifted) <= 20.0 * LARGEST_LIFT",
         f"{STARTS}::test_a_start_that_does_not_fit_the_shaft_is_refused"),
        ("any_jump", "FASTEST_END * since + LARGEST_JUMP", "1e9", f"{STARTS}::test_a_motion_too_fast_for_an_elevator_is_refused"),
        ("acceleration_of_any_size", " + abs(a) * (t + dt - time)", "",
         f"{STARTS}::test_a_motion_too_fast_for_an_elevator_is_refused"),
        ("no_step_put_off", "if duration < SHORTEST_STEP:", "if False:",
         f"{STARTS}::test_outputs_are_continuous_in_the_length_of_a_step"),
        ("time_put_off_is_lost", "duration = dt + past[DEFERRED]", "duration = dt",
         f"{STARTS}::test_many_short_steps_take_the_rope_as_far_as_a_long_one"),
        ("no_horizon", "horizon = max(duration, SHORTEST_HORIZON)", "horizon = duration",
         f"{STARTS}::test_a_position_off_by_a_micrometre_does_not_shake_a_short_step"),
    ),
    *mutants(
        "outputs", f"{INTEGRATION}/outputs.py",
        ("end_tensions_swapped", "-P[0], -P[2]", "-P[2], -P[0]", OUTPUTS),
        ("end_tension_of_the_lateral_force", "-P[0], -P[2]", "-P[0], -P[3]", OUTPUTS),
        ("sheave_force_down", "= -work.contact[FORCE_X]", "= work.contact[FORCE_X]", OUTPUTS),
        ("displacement_without_the_radius", "side * reading[0] - p[R]", "side * reading[0]", OUTPUTS),
        ("displacement_inward", "side * reading[0] - p[R]", "-side * reading[0] - p[R]", OUTPUTS),
        ("sensor_of_the_other_side", "side = 1 if", "side = -1 if", OUTPUTS),
        ("sheave_velocity_down", "p[PIT] - q[n], -v[n]", "p[PIT] - q[n], v[n]", OUTPUTS),
        ("angle_and_its_rate_swapped", "q[2 * n + 1], v[2 * n + 1]", "v[2 * n + 1], q[2 * n + 1]", OUTPUTS),
        ("maxima_swapped", "2 * k - 1", "1 - 2 * k", OUTPUTS),
        ("maximum_s_depth", "-reading[1]", "reading[1]", OUTPUTS),
        ("residual_of_the_work_s_sign", "- E[ENDS_WORK] + lost", "+ E[ENDS_WORK] + lost", OUTPUTS),
        ("residual_without_losses", "- E[ENDS_WORK] + lost", "- E[ENDS_WORK] + 0.0 * lost", OUTPUTS),
        ("counts_swapped", "state.counters[NEWTON], state.counters[HALVED]",
         "state.counters[HALVED], state.counters[NEWTON]", OUTPUTS),
        ("names_swapped", '"car_end_tension",\n    "counterweight_end_tension"',
         '"counterweight_end_tension",\n    "car_end_tension"',
         OUTPUTS),
    ),
    *mutants(
        "sensitivity", SENSITIVITY,
        ("axial_damping_of_the_motion", "(tx * bx + ty * by + spin * across)",
         "(tx * bx - ty * by + spin * across)", DERIVATIVES),
        ("stiffness_s_own_change", " + e0[e] * dea + rate * dca + w", " + rate * dca + w", DERIVATIVES),
        ("axial_damping_s_own_change", " + rate * dca + w", " + w", DERIVATIVES),
        ("moment_of_the_stiffness", " + w[CURVATURE * m + i] * dei", "", DERIVATIVES),
        ("moment_of_the_damping", " + w[BEND_RATE * m + i] * dcb", "", DERIVATIVES),
        ("geometric_stiffness", " + w[TENSION * m + e] * tilt", "", DERIVATIVES),
        ("weight_of_the_gravity", " + (p[RHO] * p[ELEMENT]) * load(dp, d + G * LANES)", "", DERIVATIVES),
        ("mass_of_the_rope", "p[ELEMENT] * load(dp, d + RHO * LANES) + p[RHO]", "p[RHO]", DERIVATIVES, "mass_derivative"),
        ("contact_stiffness_s_own_change", " + depth * load(dp, d + K * LANES)", "", DERIVATIVES),
        ("contact_damping_s_own_change", " + faded * load(dp, d + C * LANES)", "", DERIVATIVES),
        ("friction_s_own_change", " + (slip * root) * load(dp, d + MU * LANES)", "", DERIVATIVES),
        ("slip_velocity_s_sign", "return dP, dgrip - (p[MU]", "return dP, dgrip + (p[MU]", DERIVATIVES),
        ("velocity_by_the_weight_of_position", "v + by_v * r", "v + by_q * r", DERIVATIVES),
        ("inertia_of_the_sheave", "a0[m + n] * load(dp, d + J * LANES)", "0.0 * load(dp, d + J * LANES)", DERIVATIVES),
        ("old_force_s_share", "p[ALPHA] / (1.0 - taken.alpha)", "p[ALPHA]", DERIVATIVES),
        ("slope_of_the_rope_at_a_sensor", " - lean * weighted_sum", " + lean * weighted_sum", DERIVATIVES),
    ),
    *mutants(
        "sensitivity", f"{SIMULATOR}/sensitive_rope.py",
        ("end_tension_without_inertia", " - dhalf * a[i]", "", DERIVATIVES),
        ("sheave_displacement_s_sign", '"sheave_displacement": ("dq", 0, -1.0)', '"sheave_displacement": ("dq", 0, 1.0)',
         DERIVATIVES),
        ("sheave_force_s_sign", '"sheave_force": -', '"sheave_force": ', DERIVATIVES),
    ),
    *mutants(
        "units", f"{MEASUREMENTS}/units.py",
        ("rpm", '"rpm": np.pi / 30.0', '"rpm": np.pi / 60.0', UNITS),
        ("per_minute", '"1/min": np.pi / 30.0', '"1/min": 2.0 * np.pi', UNITS),
        ("deg_per_s", '"deg/s": np.pi / 180.0', '"deg/s": np.pi / 360.0', UNITS),
    ),
    *mutants(
        "units", f"{MEASUREMENTS}/runs/end_motions.py",
        ("counterweight_unmirrored", "replace(car.mirrored(height), remarks=())", "replace(car, remarks=())", UNITS),
        ("counterweight_s_column_ignored", "car.mirrored(level)", "car.mirrored(height)", UNITS),
    ),
    *mutants(
        "units", f"{MEASUREMENTS}/motion/trip.py",
        ("mirror_without_the_height", "constant(shift)", "constant(0.0)", UNITS),
        ("mirror_that_does_not", "return factor * curve(time, order)", "return curve(time, order)", UNITS),
    ),
    *mutants(
        "units", FMI,
        ("negative_powers", "times = sign * int", "times = int", f"{FMI_RUN}::test_units"),
        ("newton", '"N": {"kg": 1, "m": 1, "s": -2}', '"N": {"kg": 1, "m": 1, "s": -1}', f"{FMI_RUN}::test_units"),
        ("millimetre", '"mm": ("m", 1e3)', '"mm": ("m", 1e-3)', f"{FMI_RUN}::test_display_units_belong_to_their_unit"),
    ),
    *mutants(
        "whitening", WHITENING,
        ("mean_at_rest_certain", "covariance += noise.mean_variance(int((run.rest & np.isfinite(value)).sum()))", "pass", WHITE),
        ("memory_in_bins", "np.exp(-lag / WHITENING.discrepancy_time)",
         "np.exp(-lag / WHITENING.discrepancy_time / 2.0)", WHITE),
        ("discrepancy_squared_away", "discrepancy**2 *", "discrepancy *", WHITE),
        ("hidden_samples_counted", "np.isfinite(value) & visible", "np.isfinite(value)", WHITE),
        ("outliers_counted", "good[good] = ~outliers(value[good], noise.deviation)", "pass", WHITE),
        ("whitened_by_the_wrong_triangle", "means, lower=True)", "means, lower=False)", WHITE),
        ("noise_taken_as_white", "noise.correlation)", "np.ones(1))", NOISY),
        ("no_white_part", "WHITENING.white_share * noise.deviation**2", "0.0", WHITE),
    ),
    *mutants(
        "whitening", CHANNEL_NOISE,
        ("mean_at_rest_of_one_sample", "* inflation / max(count, 1)", "* inflation", WHITE),
        ("mean_at_rest_between_levels", "self.resolution**2 / 12.0 if held", "0.0 if held", NOISY),
        ("spread_of_a_difference", " / gain if", " if", NOISY),
        ("coarse_digits_contradict", "NOISE.quantisation_ratio * stated", "0.0 * stated", WHITE),
        ("stated_noise_in_the_column_s_unit", "(channel.noise or 0.0) * channel.scale", "(channel.noise or 0.0)", NOISY),
        ("short_rest_contradicts", "if sum(map(len, records)) < NOISE.min_rest_samples:", "if not records:",
         f"{NOISY}::test_without_a_rest_noise_is_white_and_as_stated_or_from_the_steps_of_the_run"),
        ("a_swing_after_the_stop_as_rest", "float(np.std(half)) <= still", "True",
         f"{NOISY}::test_a_swing_after_the_stop_is_no_rest"),
        ("vibration_overlooked", "return factor if factor", "return 1.0 if factor", NOISY),
        ("no_upper_limit", "return min(upper,", "return min(model.deviation,", NOISY),
    ),
    *mutants(
        "whitening", NOISE_MODEL,
        ("bins_of_one_sample", "return found / np.outer(count, count)", "return found", WHITE),
        ("lags_counted_once", "np.where((a == b) & (lag > 0), 2.0, 1.0)", "np.ones(len(a))", NOISY),
        ("reflection_of_half", "k = 2.0 * sum(", "k = 1.0 * sum(", NOISY),
        ("no_refinement", "<= NOISE.refined_length:", "<= 0:", NOISY),
        ("always_white", "if (tried :=", "if 1.0 > 2.0 and (tried :=", NOISY),
    ),
    *mutants(
        "scores", SCORE,
        ("likelihood_without_half", "-0.5 * SCORE.effective_samples * log", "-SCORE.effective_samples * log", SCORES),
        ("less_than_noise_rewarded", "max(chi_square - self.explained, 0.0)", "(chi_square - self.explained)", SCORES),
        ("model_without_error", "(1.0 + SCORE.model_error) * self.count", "self.count", SCORES),
        ("penalty_rewards", "SCORE.effective_samples) - penalty", "SCORE.effective_samples) + penalty", SCORES),
        ("any_residual_is_noise", "min([SCORE.noise_limit, *(", "min([*(", SCORES),
        ("limit_without_discrepancy", "(SCORE.effective_samples + noise.discrepancy(chi_square))",
         "SCORE.effective_samples", SCORES),
        ("alternatives_for_nothing", " + log(alternatives)", "", SCORES),
        ("run_phases_as_parameters", "len(hypothesis.directions) - phases", "len(hypothesis.directions)", SCORES),
        ("gaussian_tails", "log1p(square / SCORE.prior_degrees)", "square / SCORE.prior_degrees", SCORES),
        ("tails_of_one_less", "0.5 * (SCORE.prior_degrees + 1.0)", "0.5 * SCORE.prior_degrees", SCORES),
        ("cost_without_two", "chi_square * exp(2.0 * cost", "chi_square * exp(cost", SCORES),
    ),
    *mutants(
        "scores", LEAST_SQUARES,
        ("priors_of_the_squared_scale", "np.diag(scale**0.5 / prior)", "np.diag(scale / prior)", SCORES),
        ("start_forgotten", "residual + matrix @ start", "residual", SCORES),
        ("misfit_at_the_wrong_place", "residual - matrix @ (found - start)", "residual - matrix @ found", SCORES),
        ("prior_penalty_unscaled", "chi_square + scale * prior_penalty", "chi_square + prior_penalty", SCORES),
        ("covariance_without_priors", "curvature = np.eye(len(prior)) +", "curvature =", SCORES),
        ("bounds_swapped", '("lower", "upper")', '("upper", "lower")', SCORES),
        ("scale_below_noise", "max(1.0, chi_square", "max(0.0, chi_square", SCORES),
    ),
    *mutants(
        "metrics", METRICS,
        ("magnitude_of_one", "float(np.sqrt(pp / mm)) - 1.0", "float(np.sqrt(pp / mm))", CLOCK),
        ("own_mean_of_the_prediction", "predicted - measured.mean()", "predicted - predicted.mean()", CLOCK),
        ("error_over_the_prediction_s_variation", "np.std(measured[both])", "np.std(predicted[both])", SCORES, "channel_error"),
        ("amplitude_of_an_order", "np.sqrt(4.0 * np.maximum", "np.sqrt(2.0 * np.maximum",
         "test_compare.py::test_an_order_spectrum_finds_what_turns"),
        ("delay_s_sign", "late = step * (best - reach", "late = -step * (best - reach", CLOCK),
        ("delay_s_vertex", "0.5 * (low - high)", "0.5 * (high - low)", CLOCK),
        ("pooled_without_weights", "average(late, weights=deviation**-2.0)", "max(late)", CLOCK, "pooled_delay"),
    ),
    *mutants(
        "drive", DRIVE,
        ("anti_windup_at_every_limit", "if (force - limited) * error <= 0.0:", "if force == limited:", SERVO),
        ("no_anti_windup", "if (force - limited) * error <= 0.0:", "if True:", SERVO),
        ("no_limit", "min(max(force, low), high)", "force", SERVO),
        ("position_gain_of_the_way_s_sign", "(x - p[START_POSITION] - vector[S])", "(x - p[START_POSITION] + vector[S])",
         f"{DRIVEN}::test_the_simulator_answers_like_python_controls_closed_loop"),
        ("feedforward_dropped", "ahead = design.gains[FEEDFORWARD] * a", "ahead = 0.0",
         f"{DRIVEN}::test_the_simulator_answers_like_python_controls_closed_loop"),
        ("damping_halved", "2.0 * drive.servo.speed_damping", "drive.servo.speed_damping", SERVO),
        ("integral_gain_of_the_bandwidth", "bandwidth**2 * mass", "bandwidth * mass", SERVO),
        ("feedforward_of_the_car_alone", "servo.acceleration_feedforward * moving_mass(drive)",
         "servo.acceleration_feedforward * drive.plant.car_mass",
         f"{DRIVEN}::test_car_follows_within_millimetres"),
        ("tension_of_running_rope", "car_strain_rate - _row(V_S, weight / 2.0)",
         "car_strain_rate + _row(V_S, weight / 2.0)",
         f"{SERVO}::test_a_steady_trip_shifts_the_weight_of_the_rope_that_runs_over"),
        ("damping_of_one_side", "n_w = _row(T_W, 1.0) + drive.plant.rope_damping * counterweight_strain_rate",
         "n_w = _row(T_W, 1.0)", SERVO),
        ("ropes_pull_the_other_way", "+ car_pull - counterweight_pull", "- car_pull + counterweight_pull", SERVO),
        ("one_compensation_rope", "servo[REST_CAR], servo[REST_COUNTERWEIGHT] = p[ROPES] * u[CAR_TENSION],",
         "servo[REST_CAR], servo[REST_COUNTERWEIGHT] = u[CAR_TENSION],",
         f"{DRIVEN}::test_holding_torque_counts_every_compensation_rope"),
        ("counterweight_of_the_car_s_height", "p[HEIGHT] - start + vector[X_W]", "start + vector[X_W]",
         f"{DRIVEN}::test_nothing_moves_before_the_trip"),
        ("taylor_without_its_factor", "R[w + k] / term", "R[w + k]",
         f"{DESIGN}::test_the_exponential_is_scipys"),
        ("boundary_at_the_next_point", "0.5 * (following + position)", "following",
         f"{DESIGN}::test_gains_operating_points_and_sampled_matrices_are_those_of_python_control"),
        ("tustin_without_its_half", "0.5 * p[SAMPLE_PERIOD] * integral", "p[SAMPLE_PERIOD] * integral",
         f"{DESIGN}::test_the_largest_pole_is_that_of_python_control"),
        ("growth_unweighted", "logarithm += weight * log(size)", "logarithm += log(size)",
         f"{DESIGN}::test_the_spectral_radius_is_that_of_the_eigenvalues"),
        ("margin_of_the_other_side", "min(1.0 / gains[gains < 1.0]", "min(gains[gains < 1.0]",
         f"{SERVO}::test_gain_margins_are_where_stability_ends"),
        ("way_of_the_ramp", "return j * t * t * t / 6.0", "return j * t * t * t / 3.0", TRIP),
        ("shaper_of_a_whole_period", "0.5 * period / root", "period / root", COURSE),
        ("last_share_of_the_shaper", "(1.0 + tolerance) * (fall * fall)", "(1.0 + tolerance) * fall", COURSE),
        ("smoothed_velocity", "(x - x0) / S", "(x + x0) / S", COURSE),
        ("period_of_the_trip_s_start", "abs(origin + destination - height)", "abs(2.0 * origin - height)", COURSE),
    ),
    *mutants(
        "sweep", SWEEP,
        ("source_not_in_the_key", "_source(task.__module__), ", "", SWEEPS),
        ("content_of_files_not_in_the_key", "digest.update(path.read_bytes())", "pass", SWEEPS),
        ("user_s_effects_not_in_the_key", "hash_of_files(effects), ", "", SWEEPS),
        ("case_not_in_the_key", "hash_of_files(effects), case]", "hash_of_files(effects)]", SWEEPS),
        ("task_not_in_the_key", "[task.__qualname__, ", "[", SWEEPS),
        ("failures_taken_for_results", 'row["value"])', 'row.get("value"))', SWEEPS),
        ("lines_run_into_one", '"\\n" * cut + ', "", SWEEPS),
        ("done_cases_run_again", "if key not in done}", "}", SWEEPS),
        ("order_of_completion", "return [done[key] for key in keys]", "return list(done.values())", SWEEPS),
    ),
    *mutants(
        "fmi", INSTANCE,
        ("old_simulator_for_new_values", "if not self._running and changed != self._values:", "if False:",
         f"{FMI_RUN}::test_outputs_before_the_run_follow_the_values_set"),
        ("parameters_free_while_running", "not variable.changeable and self._running", "False", FMI_INSTANCE),
        ("times_free_while_running", "if self._running:", "if False:", FMI_INSTANCE, "setup_experiment"),
        ("time_stands_still", "self.time = time + dt", "self.time = time", f"{FMI_RUN}::test_restored_runs_go_on_bit_for_bit"),
        ("stop_time_forgotten", "self._stop = stop", "self._stop = None", FMI_INSTANCE, "setup_experiment"),
        ("failure_not_restored", "state.phase, state.failure", "state.phase, None", FMI_INSTANCE),
        ("simulator_of_other_parameters", 'parameters == self._of_role("parameter") and', "True and", FMI_INSTANCE),
        ("outputs_of_nan", "if validation.finite_problem(one, values[one.name])]", "if False]",
         f"{FMI_RUN}::test_outputs_that_are_not_finite_are_an_error"),
        ("outputs_after_a_failure", "if self.failure:", "if False:", FMI_INSTANCE),
        ("flipped_bits", " or crc32(data[start:]) != checksum", "",
         f"{FMI_RUN}::test_a_state_with_one_flipped_bit_is_refused"),
        ("partly_set_values", 'raise InputError("; ".join(problems))', "pass",
         f"{FMI_RUN}::test_a_refused_value_changes_nothing", "set_values"),
    ),
    *mutants(
        "fmi", VALIDATION,
        ("steps_back_in_time", "abs(time - reached) <=", "(time - reached) <=", FMI_INSTANCE),
        ("tolerance_of_a_step", "_TIME_TOLERANCE = 1e-6", "_TIME_TOLERANCE = 1e-3", FMI_INSTANCE),
        ("ends_of_ranges_refused", "low <= value <= high", "low < value < high", FMI_INSTANCE),
        ("range_s_maximum", "low <= value <= high", "low <= value", FMI_INSTANCE),
        ("steps_of_no_time", "dt > 0.0)", "dt >= 0.0)", FMI_INSTANCE),
        ("stop_time_passed", "time + dt > stop +", "time > stop +", FMI_INSTANCE),
    ),
    *mutants(
        "consent", "fmu_src/comprope/consent.py",
        ("any_value", 'os.environ.get(VARIABLE) == "1"', "bool(os.environ.get(VARIABLE))", CONSENT),
        ("for_ever", "os.environ[variable] = before", "pass", CONSENT),
        ("without_being_asked", '"1" if allow else before', '"1"', CONSENT),
    ),
]  # fmt: skip
