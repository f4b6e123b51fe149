/* Saved states of an instance, of type SavedState. */
#ifndef FMU_STATE_H
#define FMU_STATE_H

#include "instance.h"

void free_all_states(Instance *instance);

#endif
