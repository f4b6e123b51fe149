/* Saved states of an instance: saved, restored, serialized and deserialized, bit for bit. See instance.h for the
 * conventions. A state is of type SavedState. */
#ifndef FMU_STATE_H
#define FMU_STATE_H

#include "instance.h"

/* Save into *state, which is NULL or a state of this instance to be overwritten. */
int save_state(void *component, void **state);
int restore_state(void *component, const void *state);
int free_state(void *component, void **state);

int serialized_size(void *component, const void *state, size_t *size);
int serialize_state(void *component, const void *state, void *bytes, size_t size);
int deserialize_state(void *component, const void *bytes, size_t size, void **state);

void free_all_states(Instance *instance);

#endif
