#include "values.h"

#include "cosimulation.h"
#include "validation.h"

#include <math.h>
#include <stdint.h>

double load_double(const void *values, size_t index)
{
    return ((const double *)values)[index];
}

void store_double(void *values, size_t index, double value)
{
    ((double *)values)[index] = value;
}

double load_int32(const void *values, size_t index)
{
    return ((const int32_t *)values)[index];
}

void store_int32(void *values, size_t index, double value)
{
    ((int32_t *)values)[index] = (int32_t)fmax(fmin(value, INT32_MAX), INT32_MIN);
}

/* Whether a call for `count` variables gives as many values. */
static bool complete(Instance *instance, const unsigned *references, size_t count, const void *values,
                     size_t value_count)
{
    const bool given = count == value_count && (!count || (references && values));
    if (!given) {
        message_add(&instance->problems, "one value reference and one value are needed for each variable");
    }
    return given;
}

static bool known(Instance *instance, enum kind kind, unsigned reference)
{
    static const char *const NAMES[] = {"real", "integer", "boolean", "string"};
    if (reference < VARIABLE_COUNT && VARIABLES[reference].kind == kind) {
        return true;
    }
    message_next(&instance->problems);
    message_add(&instance->problems, "value reference %u: not of type %s", reference, NAMES[kind]);
    return false;
}

static bool is_time(const ValueType *type, unsigned reference)
{
    return type->reads_time && reference == VARIABLE_COUNT;
}

/* Whether all references can be read; initializes the model if outputs are among them. */
static bool readable(Instance *instance, const ValueType *type, const unsigned *references, size_t count)
{
    bool output = false;
    for (size_t k = 0; k < count; k++) {
        if (is_time(type, references[k])) {
            continue;
        }
        if (!known(instance, type->kind, references[k])) {
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
    const bool found = instance && complete(instance, references, count, values, value_count) &&
                       readable(instance, type, references, count);
    for (size_t k = 0; found && k < count; k++) {
        const InstanceState *state = &instance->state;
        type->store(values, k, is_time(type, references[k]) ? state->time : state->values[references[k]]);
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
    for (size_t k = 0; k < count; k++) {
        accepted = known(instance, type->kind, references[k]) &&
                   acceptable(instance, &VARIABLES[references[k]], type->load(values, k)) && accepted;
    }
    return accepted;
}

int set_values(void *component, const ValueType *type, const unsigned references[], size_t count, const void *values,
               size_t value_count)
{
    Instance *instance = instance_begin_call(component);
    const bool accepted = instance && complete(instance, references, count, values, value_count) &&
                          settable(instance, type, references, count, values);
    for (size_t k = 0; accepted && k < count; k++) {
        const double value = type->load(values, k);
        double *target = &instance->state.values[references[k]];
        if (*target != value && instance->state.phase < STEPPING) {
            instance->model_ready = false;
        }
        *target = value;
    }
    return instance_end_call(instance, accepted);
}
