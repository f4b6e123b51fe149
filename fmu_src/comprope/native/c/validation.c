#include "validation.h"

#include <float.h>
#include <math.h>

static const double TIME_TOLERANCE = 1e-6; /* of a step; importers that add up their steps drift by far less */

bool check_finite(const Variable *variable, double value, Message *problems)
{
    if (variable->kind != REAL || isfinite(value)) {
        return true;
    }
    message_next(problems);
    message_add(problems, "%s = ", variable->name);
    message_number(problems, value);
    message_add(problems, ": %s", variable->accepted);
    return false;
}

static bool in_range(const Variable *variable, double value, Message *problems)
{
    if (variable->kind == BOOLEAN || (isfinite(value) && variable->minimum <= value && value <= variable->maximum)) {
        return true;
    }
    message_next(problems);
    message_add(problems, "%s = ", variable->name);
    message_number(problems, value);
    message_add(problems, "%s: %s (%s)", variable->unit, variable->accepted, variable->help);
    return false;
}

bool check_ranges(enum role first, enum role last, const double *values, Message *problems)
{
    bool valid = true;
    for (size_t k = 0; k < VARIABLE_COUNT; k++) {
        if (first <= VARIABLES[k].role && VARIABLES[k].role <= last) {
            valid &= in_range(&VARIABLES[k], values[k], problems);
        }
    }
    return valid;
}

bool check_outputs(const double *outputs, Message *problems)
{
    bool valid = true;
    for (size_t k = 0; k < OUTPUT_COUNT; k++) {
        const Variable *variable = &VARIABLES[VARIABLE_COUNT - OUTPUT_COUNT + k];
        if (!isfinite(outputs[k])) {
            message_add(problems, valid ? "the model gave %s = " : ", %s = ", variable->name);
            message_number(problems, outputs[k]);
            valid = false;
        }
    }
    if (!valid) {
        message_add(problems, "; the step is too large or the model unstable");
    }
    return valid;
}

bool check_step(double time, double dt, double reached, double stop, Message *problems)
{
    const double tolerance = TIME_TOLERANCE * dt + 8.0 * DBL_EPSILON * fmax(1.0, fabs(time));
    if (!(isfinite(dt) && dt > 0.0)) {
        message_add(problems, "step size = ");
        message_number(problems, dt);
        message_add(problems, " s: a finite number above 0 is accepted");
        return false;
    }
    if (!(fabs(time - reached) <= tolerance)) {
        message_add(problems, "step from %.12g s: the time reached is %.12g s, and only a step from there is accepted; ",
                 time, reached);
        message_add(problems, "to go back, restore a saved state");
        return false;
    }
    if (time + dt > stop + tolerance) {
        message_add(problems, "step to %.12g s: the stop time was set to %.12g s", time + dt, stop);
        return false;
    }
    if (time + dt == time) {
        message_add(problems, "step size = %g s: too small to change the time of %.12g s", dt, time);
        return false;
    }
    return true;
}
