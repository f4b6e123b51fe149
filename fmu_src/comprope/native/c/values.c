#include "cosimulation.h"
#include "validation.h"

static bool is_time(const ValueType *type, unsigned reference)
{
    return type->is_fmi3 && type->kind == REAL && reference == VARIABLE_COUNT;
}

/* How many values a reference stands for; 0 for an element of an array, which has no reference of its own. */
static size_t element_count(const ValueType *type, unsigned reference)
{
    return type->is_fmi3 && reference < VARIABLE_COUNT ? VARIABLES[reference].elements : 1;
}

/* Where an element of a variable stands among all values. */
static size_t place_of(unsigned reference, size_t element)
{
    return reference + element * VARIABLES[reference].stride;
}

static bool known(Instance *instance, const ValueType *type, unsigned reference)
{
    static const char *const NAMES[] = {"real", "integer", "boolean", "string"};
    if (reference < VARIABLE_COUNT && VARIABLES[reference].kind == type->kind && element_count(type, reference)) {
        return true;
    }
    message_next(&instance->problems);
    message_add(&instance->problems, "value reference %u: not of type %s", reference, NAMES[type->kind]);
    return false;
}

/* Whether a call for `count` variables gives the values of all their elements. */
static bool complete(Instance *instance, const ValueType *type, const unsigned *references, size_t count,
                     const void *values, size_t value_count)
{
    if (count && (!references || !values)) {
        message_add(&instance->problems, "one value reference and one value are needed for each variable");
        return false;
    }
    size_t needed = 0;
    for (size_t k = 0; k < count; k++) {
        const size_t elements = element_count(type, references[k]);
        needed += elements ? elements : 1;
    }
    if (needed != value_count) {
        message_add(&instance->problems, "%lu values are given; these variables have %lu", (unsigned long)value_count,
                    (unsigned long)needed);
    }
    return needed == value_count;
}

/* Whether all references can be read; initializes the model if outputs are among them. */
static bool readable(Instance *instance, const ValueType *type, const unsigned *references, size_t count)
{
    bool output = false;
    for (size_t k = 0; k < count; k++) {
        if (is_time(type, references[k])) {
            continue;
        }
        if (!known(instance, type, references[k])) {
            return false;
        }
        output |= VARIABLES[references[k]].role == OUTPUT;
    }
    return !output || (not_failed(instance) && ensure_model(instance));
}

int get_values(void *component, const ValueType *type, const unsigned references[], size_t count, void *values,
               size_t value_count)
{
    Instance *instance = instance_begin_call(component);
    const bool found = instance && complete(instance, type, references, count, values, value_count) &&
                       readable(instance, type, references, count);
    size_t index = 0;
    for (size_t k = 0; found && k < count; k++) {
        const InstanceState *state = &instance->state;
        for (size_t e = 0; e < element_count(type, references[k]); e++) {
            const bool time = is_time(type, references[k]);
            type->store(values, index++, time ? state->time : state->values[place_of(references[k], e)]);
        }
    }
    return instance_end_call(instance, found);
}

/* Whether a variable may take a value now. */
static bool acceptable(Instance *instance, const Variable *variable, double value)
{
    Message *problems = &instance->problems;
    const char *reason = NULL;
    if (variable->role == OUTPUT) {
        reason = "an output cannot be set";
    } else if (variable->role == PARAMETER && instance->state.phase > INITIALIZING) {
        reason = "fixed once the run has started; reset the FMU to change it";
    } else if (instance->state.phase == TERMINATED) {
        reason = "the run has ended";
    } else {
        return check_finite(variable, value, problems);
    }
    message_next(problems);
    message_add(problems, "%s = ", variable->name);
    message_number(problems, value);
    message_add(problems, ": %s", reason);
    return false;
}

static bool settable(Instance *instance, const ValueType *type, const unsigned *references, size_t count,
                     const void *values)
{
    bool accepted = true;
    size_t index = 0;
    for (size_t k = 0; k < count; k++) {
        const bool is_known = known(instance, type, references[k]);
        accepted &= is_known;
        for (size_t e = 0; e < element_count(type, references[k]); e++) {
            const double value = type->load ? type->load(values, index) : 0.0;
            index++;
            accepted &= is_known && acceptable(instance, &VARIABLES[place_of(references[k], e)], value);
        }
    }
    return accepted;
}

int set_values(void *component, const ValueType *type, const unsigned references[], size_t count, const void *values,
               size_t value_count)
{
    Instance *instance = instance_begin_call(component);
    const bool accepted = instance && complete(instance, type, references, count, values, value_count) &&
                          settable(instance, type, references, count, values);
    size_t index = 0;
    for (size_t k = 0; accepted && k < count; k++) {
        for (size_t e = 0; e < element_count(type, references[k]); e++) {
            const double value = type->load(values, index++);
            double *target = &instance->state.values[place_of(references[k], e)];
            if (*target != value && instance->state.phase < STEPPING) {
                instance->model_ready = false;
            }
            *target = value;
        }
    }
    return instance_end_call(instance, accepted);
}
