#include "cosimulation.h"

#include "validation.h"

#include <math.h>
#include <string.h>

/* Whether the phase allows a call. */
static bool in_phase(Instance *instance, enum phase phase, const char *when)
{
    if (instance->state.phase != phase) {
        message_add(&instance->problems, "this call is possible only %s", when);
    }
    return instance->state.phase == phase;
}

bool not_failed(Instance *instance)
{
    if (instance->state.failed) {
        message_add(&instance->problems,
                    "no steps and outputs after an error, unless reset or restored; the error was: %s",
                    instance->state.failure);
    }
    return !instance->state.failed;
}

static bool set_times(Instance *instance, double start, double stop)
{
    Message *problems = &instance->problems;
    if (!in_phase(instance, INSTANTIATED, "before initialization")) {
        return false;
    }
    if (!isfinite(start) || isnan(stop) || stop < start) {
        message_add(problems, "start time = ");
        message_number(problems, start);
        message_add(problems, " s, stop time = ");
        message_number(problems, stop);
        message_add(problems, " s: a finite start and a stop after it are accepted");
        return false;
    }
    instance->state.start = instance->state.time = start;
    instance->state.stop = stop;
    instance->model_ready = false;
    return true;
}

int setup_experiment(void *component, double start, bool stop_defined, double stop)
{
    Instance *instance = instance_begin_call(component);
    return instance_end_call(instance, instance && set_times(instance, start, stop_defined ? stop : INFINITY));
}

int enter_initialization(void *component)
{
    Instance *instance = instance_begin_call(component);
    const bool allowed = instance && in_phase(instance, INSTANTIATED, "before initialization");
    if (allowed) {
        instance->state.phase = INITIALIZING;
    }
    return instance_end_call(instance, allowed);
}

/* Copy the model's outputs to the values if all are finite. */
static bool update_outputs(Instance *instance)
{
    const double *outputs = model_outputs(&instance->model);
    if (!check_outputs(outputs, &instance->problems)) {
        return false;
    }
    memcpy(instance->state.values + VARIABLE_COUNT - OUTPUT_COUNT, outputs, OUTPUT_COUNT * sizeof *outputs);
    return true;
}

bool ensure_model(Instance *instance)
{
    InstanceState *state = &instance->state;
    Message *problems = &instance->problems;
    if (instance->model_ready) {
        return true;
    }
    instance->model_ready = check_ranges(PARAMETER, INPUT, state->values, problems) &&
                            model_prepare(&instance->model, instance->allocator, state->values, problems) &&
                            model_initialize(&instance->model, state->start, problems) && update_outputs(instance);
    return instance->model_ready;
}

int exit_initialization(void *component)
{
    Instance *instance = instance_begin_call(component);
    const bool initialized =
        instance && in_phase(instance, INITIALIZING, "in initialization mode") && ensure_model(instance);
    if (initialized) {
        instance->state.phase = STEPPING;
    }
    return instance_end_call(instance, initialized);
}

static bool can_step(Instance *instance)
{
    return not_failed(instance) &&
           in_phase(instance, STEPPING, "between the end of initialization and termination");
}

int do_step(void *component, double time, double dt)
{
    Instance *instance = instance_begin_call(component);
    if (!instance) {
        return STATUS_ERROR;
    }
    InstanceState *state = &instance->state;
    Message *problems = &instance->problems;
    const bool done = can_step(instance) && check_step(time, dt, state->time, state->stop, problems) &&
                      check_ranges(TUNABLE, INPUT, state->values, problems) &&
                      model_step(&instance->model, state->values, time, dt, problems) && update_outputs(instance);
    if (done) {
        state->time = time + dt;
    }
    return instance_end_call(instance, done);
}

int terminate(void *component)
{
    Instance *instance = instance_begin_call(component);
    const bool allowed =
        instance && in_phase(instance, STEPPING, "between the end of initialization and termination");
    if (allowed) {
        instance->state.phase = TERMINATED;
    }
    return instance_end_call(instance, allowed);
}

int reset(void *component)
{
    Instance *instance = instance_begin_call(component);
    if (instance) {
        instance_set_to_start(instance);
    }
    return instance_end_call(instance, true);
}

int last_time(void *component, double *time)
{
    *time = ((const Instance *)component)->state.time;
    return STATUS_OK;
}
