/* Is a value or a step acceptable? Each returns whether it is, and adds one sentence for each problem. */
#ifndef CHECK_H
#define CHECK_H

#include "variables.h"
#include "message.h"

#include <stdbool.h>

/* A value to be set: a number that is finite. */
bool check_finite(const Variable *variable, double value, Text *problems);

/* Values of all variables of a role: finite and within their ranges. */
bool check_ranges(enum role role, const double *values, Text *problems);

/* Outputs of the model, in the order of their variables: finite. */
bool check_outputs(const double *outputs, Text *problems);

/* A step of `dt` from `time`, after a run that has reached `reached` and shall end at `stop` (infinite if open) [s]. */
bool check_step(double time, double dt, double reached, double stop, Text *problems);

#endif
