/* One model for the functions of FMI: started at rest, stepped, its outputs evaluated, its state saved. `values` are
 * those of all variables of the model. What is specific to rope or drive is in component.h. */
#ifndef MODEL_H
#define MODEL_H

#include "kernels.h"
#include "allocator.h"
#include "message.h"

#include <stdbool.h>

/* All numbers of a model lie in one block, those that make its state first; the tables point into it. */
typedef struct {
    Tables tables;
    double *block;
    size_t numbers;
    size_t state_numbers;
} Model;

/* Ready the memory for the parameters among the values, which must be in range; it is taken once for one size. */
bool model_prepare(Model *model, Allocator allocator, double *values, Message *problems);

/* Bring the model to equilibrium at the time t [s]. */
bool model_initialize(Model *model, double t, Message *problems);

/* Advance from t to t + dt [s] with the tunable parameters among the values; the message of a failure says where and when. */
bool model_step(Model *model, const double *values, double t, double dt, Message *problems);

/* All outputs, in the order of their variables, valid until the next call. */
const double *model_outputs(Model *model);

void model_free(Model *model, Allocator allocator);

#endif
