/* One rope as the face sees it: opened at rest, stepped, shown, saved. `values` are those of all variables of the
 * model. */
#ifndef ENGINE_H
#define ENGINE_H

#include "kernels.h"
#include "allocator.h"
#include "message.h"

#include <stdbool.h>

/* All numbers of a rope lie in one block, those that make its state first; the rope points into it. */
typedef struct {
    Rope rope;
    double *block;
    size_t numbers;
    size_t state_numbers;
} Engine;

/* Ready the memory for the parameters among the values, which must be in range; it is taken once for one mesh. */
bool engine_prepare(Engine *engine, Memory memory, double *values, Text *problems);

/* Hang the rope at rest between its ends at the time t [s]. */
bool engine_open(Engine *engine, double t, Text *problems);

/* Advance from t to t + dt [s]; a step that is lost tells where and when. */
bool engine_step(Engine *engine, double t, double dt, Text *problems);

/* All outputs, in the order of their variables, valid until the next call. */
const double *engine_show(Engine *engine);

void engine_free(Engine *engine, Memory memory);

#endif
