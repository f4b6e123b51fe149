/* Initialization, steps and termination of an instance. See instance.h for the conventions.
 *
 * Before the steps begin the model is initialized when an output is read, and anew after a value has changed.
 */
#ifndef COSIMULATION_H
#define COSIMULATION_H

#include "instance.h"

int setup_experiment(void *component, double start, bool stop_defined, double stop);
int enter_initialization(void *component);
int exit_initialization(void *component);
int do_step(void *component, double time, double dt);
int terminate(void *component);
int reset(void *component);

/* Whether no call has failed since the last reset or restored state. */
bool not_failed(Instance *instance);

/* Initialize the model from the present values, unless it is. */
bool ensure_model(Instance *instance);

#endif
