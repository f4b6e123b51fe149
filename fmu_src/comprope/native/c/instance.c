#include "instance.h"

#include "fmu_state.h"
#include "variables.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void instance_set_to_start(Instance *instance)
{
    InstanceState *state = &instance->state;
    state->phase = INSTANTIATED;
    state->failed = 0;
    state->start = state->time = 0.0;
    state->stop = INFINITY;
    for (size_t k = 0; k < VARIABLE_COUNT; k++) {
        state->values[k] = VARIABLES[k].start;
    }
    memset(state->failure, 0, sizeof state->failure);
    instance->model_ready = false;
}

static Instance *allocate_instance(Allocator allocator)
{
    Instance *instance = allocate_zeros(allocator, sizeof *instance);
    if (!instance) {
        return NULL;
    }
    instance->allocator = allocator;
    instance->state.values = allocate_zeros(allocator, VARIABLE_COUNT * sizeof(double));
    if (!instance->state.values) {
        allocator.release(instance);
        return NULL;
    }
    instance_set_to_start(instance);
    return instance;
}

Instance *instance_create(const char *name, const char *refusal, Logger logger, Allocator allocator)
{
    Instance *instance = NULL;

    if (!name || !*name) {
        refusal = "an instance needs a name";
    }
    if (!refusal) {
        instance = allocate_instance(allocator);
        refusal = instance ? NULL : "no memory for one more instance";
    }
    if (!instance) {
        logger.send(&logger, name ? name : "", refusal);
        return NULL;
    }
    instance->logger = logger;
    snprintf(instance->name, sizeof instance->name, "%s", name);
    return instance;
}

void instance_free(void *component)
{
    Instance *instance = component;
    if (instance) {
        const Allocator allocator = instance->allocator;
        free_all_states(instance);
        model_free(&instance->model, allocator);
        allocator.release(instance->state.values);
        allocator.release(instance);
    }
}

Instance *instance_begin_call(void *component)
{
    Instance *instance = component;
    if (instance) {
        message_clear(&instance->problems);
    }
    return instance;
}

int instance_end_call(Instance *instance, bool succeeded)
{
    Message report;

    if (!instance || succeeded) {
        return instance ? STATUS_OK : STATUS_ERROR;
    }
    InstanceState *state = &instance->state;
    if (!state->failed) {
        state->failed = 1;
        snprintf(state->failure, sizeof state->failure, "%s", instance->problems.chars);
    }
    message_clear(&report);
    message_add(&report, "%s '%s' at t = %.9g s: %s", MODEL_NAME, instance->name, state->time, instance->problems.chars);
    instance->logger.send(&instance->logger, instance->name, report.chars);
    return STATUS_ERROR;
}

int instance_refuse(void *component, const char *reason)
{
    Instance *instance = instance_begin_call(component);
    if (instance) {
        message_add(&instance->problems, "%s", reason);
    }
    return instance_end_call(instance, false);
}
