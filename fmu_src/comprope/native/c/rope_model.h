/* One rope for the functions of FMI: started at rest, stepped, its outputs evaluated, its state saved. `values` are
 * those of all variables of the model. */
#ifndef ROPE_MODEL_H
#define ROPE_MODEL_H

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
} RopeModel;

/* Ready the memory for the parameters among the values, which must be in range; it is taken once for one mesh. */
bool rope_model_prepare(RopeModel *model, Allocator allocator, double *values, Message *problems);

/* Bring the rope to static equilibrium between its ends at the time t [s]. */
bool rope_model_initialize(RopeModel *model, double t, Message *problems);

/* Advance from t to t + dt [s]; the message of a step that does not converge says where and when. */
bool rope_model_step(RopeModel *model, double t, double dt, Message *problems);

/* All outputs, in the order of their variables, valid until the next call. */
const double *rope_model_outputs(RopeModel *model);

void rope_model_free(RopeModel *model, Allocator allocator);

#endif
