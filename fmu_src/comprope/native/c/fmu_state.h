/* Saved states of an instance: taken, restored, turned into bytes and back, bit for bit. See `Run` for the conventions.
 */
#ifndef STATE_H
#define STATE_H

#include "cosimulation.h"

/* Save into *state, which is NULL or a state of this instance to be overwritten. */
bool state_save(Run *run, State **state);
bool state_restore(Run *run, const State *state);
bool state_free(Run *run, State **state);

bool state_size(Run *run, const State *state, size_t *size);
bool state_to_bytes(Run *run, const State *state, char *bytes, size_t size);
bool state_from_bytes(Run *run, const char *bytes, size_t size, State **state);

#endif
