/* The calls of the FMI, whichever its version: what fmi2_functions.c and fmi3_functions.c turn an importer's calls into.
 *
 * Native FMUs have them in cosimulation.c, values.c, fmu_state.c and instance.c; FMUs that run in Python have them in
 * python_slave.c, which forwards them. Each returns a status, and reports an error to the importer. A refused call changes
 * nothing but marks the instance as failed: after an error there are no steps and no outputs until it is reset or a saved
 * state is restored, so that not even an importer that ignores errors can take old values for new ones.
 */
#ifndef CALLS_H
#define CALLS_H

#include "value_type.h"

enum { STATUS_OK = 0, STATUS_ERROR = 3 }; /* the same values in FMI 2.0 and FMI 3.0 */

void instance_free(void *component);
int setup_experiment(void *component, double start, bool stop_defined, double stop);
int enter_initialization(void *component);
int exit_initialization(void *component);
int do_step(void *component, double time, double dt);
int terminate(void *component);
int reset(void *component);

/* The time reached [s]; no error before the first step. */
int last_time(void *component, double *time);

/* Reading and setting variables by value reference, all or none; all must be of one type. Values of an array stand one after
 * the other. */
int get_values(void *component, const ValueType *type, const unsigned references[], size_t count, void *values,
               size_t value_count);
int set_values(void *component, const ValueType *type, const unsigned references[], size_t count, const void *values,
               size_t value_count);

/* States: saved into *state, which is NULL or a state of this instance to be overwritten; bit for bit. */
int save_state(void *component, void **state);
int restore_state(void *component, const void *state);
int free_state(void *component, void **state);
int serialized_size(void *component, const void *state, size_t *size);
int serialize_state(void *component, const void *state, void *bytes, size_t size);
int deserialize_state(void *component, const void *bytes, size_t size, void **state);

/* The status of a call that is an error in itself. */
int instance_refuse(void *component, const char *reason);

#endif
