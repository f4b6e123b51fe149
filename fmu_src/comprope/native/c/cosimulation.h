/* One instance: values by reference and an engine once there is one.
 *
 * Before the run begins the engine is made when an output is asked for, and made anew after a value has changed. A
 * refused call changes nothing but puts the instance out of action: after an error there are no steps and no outputs
 * until it is reset or a saved state is restored, so that not even an importer that overlooks errors can take old
 * values for new ones. Every function returns whether it succeeded; if not, `problems` says why.
 */
#ifndef RUN_H
#define RUN_H

#include "rope_model.h"
#include "allocator.h"
#include "variables.h"
#include "message.h"

#include <stdbool.h>

enum phase { INSTANTIATED, INITIALIZING, STEPPING, TERMINATED };

typedef struct {
    enum phase phase;
    int failed;
    double start, stop, time; /* s; stop is infinite where none is set */
    double *values;           /* of all variables; those of outputs are the ones last shown */
    char failure[TEXT_SIZE];
} Stand;

/* A saved state lies in one piece: this head, the values of all variables, the engine's state. */
typedef struct State {
    struct State *next;
    size_t size; /* bytes of the whole */
    char model[64];
    Stand stand;
    size_t engine_numbers; /* none before the run has begun */
    double numbers[];
} State;

typedef struct {
    Memory memory;
    Stand stand;
    Engine engine;
    bool engine_made;
    State *states; /* all that are saved and not freed yet */
    Text problems;
} Run;

bool run_create(Run *run, Memory memory);
void run_free(Run *run);
void run_reset(Run *run);

bool run_plan(Run *run, double start, double stop);
bool run_enter(Run *run);
bool run_begin(Run *run);
bool run_step(Run *run, double time, double dt);
bool run_terminate(Run *run);

/* Read or write values by reference, all or none; all must be of one kind. */
bool run_readable(Run *run, enum kind kind, const unsigned *references, size_t count);
bool run_write(Run *run, enum kind kind, const unsigned *references, size_t count,
               double (*value)(const void *values, size_t place), const void *values);

/* Make the engine from the present values if there is none. */
bool run_make_engine(Run *run);

#endif
