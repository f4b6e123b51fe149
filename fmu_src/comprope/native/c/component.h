/* What rope and drive have each in their own way; model.c has the rest. The tables are those of the kernels. */
#ifndef COMPONENT_H
#define COMPONENT_H

#include "kernels.h"
#include "message.h"

#include <stdbool.h>

/* The number of columns of the arrays for the parameters among the values; 0 if they are refused. */
size_t component_columns(double *values, Message *problems);

/* Set what depends on the parameters alone, once the arrays are there. */
void component_prepare(Tables *tables, const double *values, size_t columns);

/* Equilibrium at the time t [s], from a state of zeros. */
bool component_initialize(Tables *tables, double t, Message *problems);

/* Take over the tunable parameters among the values. */
void component_tune(Tables *tables, const double *values);

/* Advance from t to t + dt [s]. */
bool component_step(Tables *tables, double t, double dt, Message *problems);

/* All outputs, in the order of their variables. */
const double *component_outputs(Tables *tables);

/* Whether a kernel has succeeded; if not, the message that it shares with Python is added. */
bool kernel_succeeded(const double *message, int64_t status, Message *problems);

#endif
