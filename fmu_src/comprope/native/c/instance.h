/* One instance of the FMU, whichever version of FMI it is called by: its state, its model, and how errors are reported.
 *
 * Every function whose argument is a `component` is one call of the FMI (see calls.h). Functions with an `instance` return
 * whether they succeeded; if not, `problems` says why.
 */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "allocator.h"
#include "calls.h"
#include "message.h"
#include "model.h"

#include <stdbool.h>

enum phase { INSTANTIATED, INITIALIZING, STEPPING, TERMINATED };

typedef struct {
    enum phase phase;
    int failed;
    double start, stop, time; /* s; stop is infinite where none is set */
    double *values;           /* of all variables; those of outputs are of the last step */
    char failure[MESSAGE_SIZE];
} InstanceState;

/* Where error messages go: `send` knows which type the importer's `callback` has. */
typedef struct Logger {
    void (*send)(const struct Logger *logger, const char *instance_name, const char *sentence);
    void (*callback)(void);
    void *environment;
} Logger;

typedef struct {
    char name[256];
    Logger logger;
    Allocator allocator;
    InstanceState state;
    Model model;
    bool model_ready; /* initialized from the present values */
    struct SavedState *saved_states; /* those not freed yet */
    Message problems;
} Instance;

/* A new instance; NULL, reported to the importer, if `refusal` gives a reason or there is no memory. */
Instance *instance_create(const char *name, const char *refusal, Logger logger, Allocator allocator);

/* Back to the start values of all variables. */
void instance_set_to_start(Instance *instance);

/* The instance, without problems left from an earlier call; NULL if there is none. */
Instance *instance_begin_call(void *component);

/* The status of a call: an error is reported to the importer and marks the instance as failed. */
int instance_end_call(Instance *instance, bool succeeded);

#endif
