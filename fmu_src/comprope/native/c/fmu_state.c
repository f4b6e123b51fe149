#include "fmu_state.h"

#include "validation.h"

#include <string.h>

enum { HEAD = offsetof(State, size) }; /* what comes before is of this process only */

static size_t whole_size(size_t engine_numbers)
{
    return offsetof(State, numbers) + (VARIABLE_COUNT + engine_numbers) * sizeof(double);
}

/* Whether this is a state of this instance that has not been freed. */
static bool ours(Run *run, const State *state)
{
    for (const State *one = run->states; one; one = one->next) {
        if (one == state) {
            return true;
        }
    }
    text_add(&run->problems, "saved state: not one of this instance, or freed already");
    return false;
}

static State *new_state(Run *run, size_t engine_numbers)
{
    State *state = take_zeros(run->memory, whole_size(engine_numbers));
    if (!state) {
        text_add(&run->problems, "no memory for a state of %lu bytes", (unsigned long)whole_size(engine_numbers));
        return NULL;
    }
    state->next = run->states;
    run->states = state;
    state->size = whole_size(engine_numbers);
    state->engine_numbers = engine_numbers;
    return state;
}

bool state_free(Run *run, State **state)
{
    if (!*state) {
        return true;
    }
    if (!ours(run, *state)) {
        return false;
    }
    State **link = &run->states;
    while (*link != *state) {
        link = &(*link)->next;
    }
    *link = (*state)->next;
    run->memory.give_back(*state);
    *state = NULL;
    return true;
}

bool state_save(Run *run, State **state)
{
    const size_t wanted = run->stand.phase >= STEPPING ? run->engine.state_numbers : 0;
    State *saved = *state;
    if (saved && !ours(run, saved)) {
        return false;
    }
    if (!saved || saved->engine_numbers != wanted) {
        saved = new_state(run, wanted);
        if (!saved || !state_free(run, state)) {
            return false;
        }
    }
    strncpy(saved->model, MODEL_GUID, sizeof saved->model - 1);
    saved->stand = run->stand;
    saved->stand.values = NULL;
    memcpy(saved->numbers, run->stand.values, VARIABLE_COUNT * sizeof(double));
    if (wanted) {
        memcpy(saved->numbers + VARIABLE_COUNT, run->engine.block, wanted * sizeof(double));
    }
    *state = saved;
    return true;
}

/* Ready the engine for a state's parameters, unless it is. */
static bool ready_for(Run *run, const State *state)
{
    const size_t parameters = VARIABLE_COUNT - OUTPUT_COUNT; /* and inputs, which do no harm */
    double *values = run->stand.values;
    if (run->engine_made && !memcmp(values, state->numbers, FIRST_INPUT * sizeof *values)) {
        return true;
    }
    if (!check_ranges(PARAMETER, state->numbers, &run->problems)) {
        return false;
    }
    run->engine_made = false;
    memcpy(values, state->numbers, parameters * sizeof *values);
    return engine_prepare(&run->engine, run->memory, values, &run->problems);
}

bool state_restore(Run *run, const State *state)
{
    if (!ours(run, state)) {
        return false;
    }
    double *values = run->stand.values;
    if (state->engine_numbers) {
        if (!ready_for(run, state)) {
            return false;
        }
        if (state->engine_numbers != run->engine.state_numbers) {
            text_add(&run->problems, "saved state: of another mesh than its parameters give");
            return false;
        }
        memcpy(run->engine.block, state->numbers + VARIABLE_COUNT, state->engine_numbers * sizeof(double));
    }
    run->engine_made = state->engine_numbers != 0;
    run->stand = state->stand;
    run->stand.values = values;
    memcpy(values, state->numbers, VARIABLE_COUNT * sizeof *values);
    return true;
}

bool state_size(Run *run, const State *state, size_t *size)
{
    if (!ours(run, state)) {
        return false;
    }
    *size = state->size - HEAD;
    return true;
}

bool state_to_bytes(Run *run, const State *state, char *bytes, size_t size)
{
    if (!ours(run, state)) {
        return false;
    }
    if (size < state->size - HEAD) {
        text_add(&run->problems, "saved state: needs %lu bytes, %lu are given", (unsigned long)(state->size - HEAD),
                 (unsigned long)size);
        return false;
    }
    memcpy(bytes, (const char *)state + HEAD, state->size - HEAD);
    return true;
}

/* Whether bytes have the form of a state of this very FMU; `head` is a copy of their beginning. */
static bool is_state(const State *head, size_t size)
{
    const Stand *stand = &head->stand;
    if (size + HEAD != head->size || head->model[sizeof head->model - 1] || strcmp(head->model, MODEL_GUID) != 0) {
        return false;
    }
    const bool running = stand->phase == STEPPING || stand->phase == TERMINATED;
    if (head->engine_numbers > size / sizeof(double) || head->size != whole_size(head->engine_numbers)) {
        return false;
    }
    return (unsigned)stand->phase <= TERMINATED && running == (head->engine_numbers != 0) && !stand->values &&
           !stand->failure[sizeof stand->failure - 1];
}

bool state_from_bytes(Run *run, const char *bytes, size_t size, State **state)
{
    State head;
    memset(&head, 0, sizeof head);
    if (size >= offsetof(State, numbers) - HEAD) {
        memcpy((char *)&head + HEAD, bytes, offsetof(State, numbers) - HEAD);
    }
    if (!is_state(&head, size)) {
        text_add(&run->problems, "saved state: %lu bytes that are not a whole state of this FMU", (unsigned long)size);
        return false;
    }
    State *made = new_state(run, head.engine_numbers);
    if (!made) {
        return false;
    }
    memcpy((char *)made + HEAD, bytes, size);
    *state = made;
    return true;
}
