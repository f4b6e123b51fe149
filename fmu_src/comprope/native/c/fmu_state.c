#include "fmu_state.h"

#include "validation.h"
#include "variables.h"

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* One block of memory: this head, the values of all variables, the numbers of the model's state. */
typedef struct SavedState {
    struct SavedState *next;
    size_t size;       /* bytes of the block */
    uint64_t checksum; /* of what follows, in serialized states */
    char model[64];
    InstanceState instance_state;
    size_t model_numbers; /* none before the steps begin */
    double numbers[];
} SavedState;

enum { SERIALIZED_FROM = offsetof(SavedState, size) }; /* what comes before is valid in this process only */
enum { CHECKED_FROM = offsetof(SavedState, model) - SERIALIZED_FROM };

/* FNV-1a of the serialized bytes behind the checksum: no single byte can change without changing it. */
static uint64_t checksum_of(const void *bytes, size_t size)
{
    const unsigned char *byte = bytes;
    uint64_t sum = UINT64_C(0xcbf29ce484222325);
    for (size_t k = CHECKED_FROM; k < size; k++) {
        sum = (sum ^ byte[k]) * UINT64_C(0x100000001b3);
    }
    return sum;
}

static size_t block_size(size_t model_numbers)
{
    return offsetof(SavedState, numbers) + (VARIABLE_COUNT + model_numbers) * sizeof(double);
}

/* Whether this is a state of this instance that has not been freed. */
static bool is_own(Instance *instance, const SavedState *state)
{
    for (const SavedState *one = instance->saved_states; one; one = one->next) {
        if (one == state) {
            return true;
        }
    }
    message_add(&instance->problems, "saved state: not one of this instance, or freed already");
    return false;
}

static SavedState *new_state(Instance *instance, size_t model_numbers)
{
    SavedState *state = allocate_zeros(instance->allocator, block_size(model_numbers));
    if (!state) {
        message_add(&instance->problems, "no memory for a state of %lu bytes",
                    (unsigned long)block_size(model_numbers));
        return NULL;
    }
    state->next = instance->saved_states;
    instance->saved_states = state;
    state->size = block_size(model_numbers);
    state->model_numbers = model_numbers;
    return state;
}

static void release_state(Instance *instance, SavedState *state)
{
    SavedState **link = &instance->saved_states;
    while (*link != state) {
        link = &(*link)->next;
    }
    *link = state->next;
    instance->allocator.release(state);
}

void free_all_states(Instance *instance)
{
    while (instance->saved_states) {
        release_state(instance, instance->saved_states);
    }
}

int free_state(void *component, void **state)
{
    Instance *instance = instance_begin_call(component);
    const bool present = state && *state;
    const bool allowed = instance && (!present || is_own(instance, *state));
    if (allowed && present) {
        release_state(instance, *state);
        *state = NULL;
    }
    return instance_end_call(instance, allowed);
}

static void copy_to_state(const Instance *instance, SavedState *saved)
{
    strncpy(saved->model, MODEL_GUID, sizeof saved->model - 1);
    saved->instance_state = instance->state;
    saved->instance_state.values = NULL;
    memcpy(saved->numbers, instance->state.values, VARIABLE_COUNT * sizeof(double));
    if (saved->model_numbers) {
        memcpy(saved->numbers + VARIABLE_COUNT, instance->model.block, saved->model_numbers * sizeof(double));
    }
}

static bool save(Instance *instance, void **state)
{
    const size_t model_numbers = instance->state.phase >= STEPPING ? instance->model.state_numbers : 0;
    SavedState *old = *state, *saved = old;
    if (old && !is_own(instance, old)) {
        return false;
    }
    if (!old || old->model_numbers != model_numbers) {
        saved = new_state(instance, model_numbers);
        if (!saved) {
            return false;
        }
        if (old) {
            release_state(instance, old);
        }
    }
    copy_to_state(instance, saved);
    *state = saved;
    return true;
}

int save_state(void *component, void **state)
{
    if (!state) {
        return instance_refuse(component, "no place for a state is given");
    }
    Instance *instance = instance_begin_call(component);
    return instance_end_call(instance, instance && save(instance, state));
}

/* Prepare the model for a state's parameters, unless it has them. */
static bool prepare_model_for(Instance *instance, const SavedState *state)
{
    const size_t settable = VARIABLE_COUNT - OUTPUT_COUNT; /* parameters and inputs */
    double *values = instance->state.values;
    if (instance->model_ready && !memcmp(values, state->numbers, FIRST_INPUT * sizeof *values)) {
        return true;
    }
    if (!check_ranges(PARAMETER, TUNABLE, state->numbers, &instance->problems)) {
        return false;
    }
    instance->model_ready = false;
    memcpy(values, state->numbers, settable * sizeof *values);
    return model_prepare(&instance->model, instance->allocator, values, &instance->problems);
}

static bool restore(Instance *instance, const SavedState *state)
{
    if (!is_own(instance, state)) {
        return false;
    }
    double *values = instance->state.values;
    if (state->model_numbers) {
        if (!prepare_model_for(instance, state)) {
            return false;
        }
        if (state->model_numbers != instance->model.state_numbers) {
            message_add(&instance->problems, "saved state: of another mesh than its parameters give");
            return false;
        }
        memcpy(instance->model.block, state->numbers + VARIABLE_COUNT, state->model_numbers * sizeof(double));
    }
    instance->model_ready = state->model_numbers != 0;
    instance->state = state->instance_state;
    instance->state.values = values;
    memcpy(values, state->numbers, VARIABLE_COUNT * sizeof *values);
    return true;
}

int restore_state(void *component, const void *state)
{
    Instance *instance = instance_begin_call(component);
    return instance_end_call(instance, instance && restore(instance, state));
}

int serialized_size(void *component, const void *state, size_t *size)
{
    if (!size) {
        return instance_refuse(component, "no place for a size is given");
    }
    Instance *instance = instance_begin_call(component);
    const bool allowed = instance && is_own(instance, state);
    if (allowed) {
        *size = ((const SavedState *)state)->size - SERIALIZED_FROM;
    }
    return instance_end_call(instance, allowed);
}

static bool serialize(Instance *instance, const SavedState *state, void *bytes, size_t size)
{
    if (!is_own(instance, state)) {
        return false;
    }
    const size_t needed = state->size - SERIALIZED_FROM;
    if (size < needed) {
        message_add(&instance->problems, "saved state: needs %lu bytes, %lu are given", (unsigned long)needed,
                    (unsigned long)size);
        return false;
    }
    memcpy(bytes, (const char *)state + SERIALIZED_FROM, needed);
    const uint64_t checksum = checksum_of(bytes, needed);
    memcpy((char *)bytes + offsetof(SavedState, checksum) - SERIALIZED_FROM, &checksum, sizeof checksum);
    return true;
}

int serialize_state(void *component, const void *state, void *bytes, size_t size)
{
    if (!bytes) {
        return instance_refuse(component, "no place for the bytes is given");
    }
    Instance *instance = instance_begin_call(component);
    return instance_end_call(instance, instance && serialize(instance, state, bytes, size));
}

/* Whether bytes have the form of a state of this very FMU; `head` is a copy of their beginning. */
static bool is_state(const SavedState *head, size_t size)
{
    const InstanceState *state = &head->instance_state;
    if (size + SERIALIZED_FROM != head->size || head->model[sizeof head->model - 1] ||
        strcmp(head->model, MODEL_GUID) != 0) {
        return false;
    }
    if (head->model_numbers > size / sizeof(double) || head->size != block_size(head->model_numbers)) {
        return false;
    }
    const bool running = state->phase == STEPPING || state->phase == TERMINATED;
    return (unsigned)state->phase <= TERMINATED && running == (head->model_numbers != 0) && !state->values &&
           !state->failure[sizeof state->failure - 1];
}

static bool deserialize(Instance *instance, const void *bytes, size_t size, void **state)
{
    const size_t head_size = offsetof(SavedState, numbers) - SERIALIZED_FROM;
    SavedState head;
    memset(&head, 0, sizeof head);
    if (size >= head_size) {
        memcpy((char *)&head + SERIALIZED_FROM, bytes, head_size);
    }
    if (!is_state(&head, size) || head.checksum != checksum_of(bytes, size)) {
        message_add(&instance->problems, "saved state: %lu bytes that are not a whole state of this FMU",
                    (unsigned long)size);
        return false;
    }
    SavedState *created = new_state(instance, head.model_numbers);
    if (!created) {
        return false;
    }
    memcpy((char *)created + SERIALIZED_FROM, bytes, size);
    *state = created;
    return true;
}

int deserialize_state(void *component, const void *bytes, size_t size, void **state)
{
    if (!bytes || !state) {
        return instance_refuse(component, "bytes or a place for the state are missing");
    }
    Instance *instance = instance_begin_call(component);
    return instance_end_call(instance, instance && deserialize(instance, bytes, size, state));
}
