/* What reading values needs of the initialization and the steps of an instance.
 *
 * Before the steps begin the model is initialized when an output is read, and anew after a value has changed.
 */
#ifndef COSIMULATION_H
#define COSIMULATION_H

#include "instance.h"

/* Whether no call has failed since the last reset or restored state. */
bool not_failed(Instance *instance);

/* Initialize the model from the present values, unless it is. */
bool ensure_model(Instance *instance);

#endif
