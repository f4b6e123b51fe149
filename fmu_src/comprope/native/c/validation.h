/* Checks of values and steps. Each returns whether the value is accepted, and adds one sentence for each problem. */
#ifndef VALIDATION_H
#define VALIDATION_H

#include "message.h"
#include "variables.h"

#include <stdbool.h>

/* A value to be set: a real number must be finite. */
bool check_finite(const Variable *variable, double value, Message *problems);

/* Values of all variables of the roles from `first` to `last`: finite and within their ranges. */
bool check_ranges(enum role first, enum role last, const double *values, Message *problems);

/* Outputs of the model, in the order of their variables: finite. */
bool check_outputs(const double *outputs, Message *problems);

/* A step of `dt` from `time` when the simulation is at `reached` and ends at `stop` (infinite if open) [s]. */
bool check_step(double time, double dt, double reached, double stop, Message *problems);

#endif
