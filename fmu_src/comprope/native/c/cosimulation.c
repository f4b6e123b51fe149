#include "cosimulation.h"

#include "validation.h"

#include <math.h>
#include <string.h>

bool run_create(Run *run, Memory memory)
{
    memset(run, 0, sizeof *run);
    run->memory = memory;
    run->stand.values = take_zeros(memory, VARIABLE_COUNT * sizeof(double));
    if (run->stand.values) {
        run_reset(run);
    }
    return run->stand.values;
}

void run_free(Run *run)
{
    while (run->states) {
        State *state = run->states;
        run->states = state->next;
        run->memory.give_back(state);
    }
    engine_free(&run->engine, run->memory);
    run->memory.give_back(run->stand.values);
}

void run_reset(Run *run)
{
    Stand *stand = &run->stand;
    stand->phase = INSTANTIATED;
    stand->failed = 0;
    stand->start = stand->time = 0.0;
    stand->stop = INFINITY;
    for (size_t k = 0; k < VARIABLE_COUNT; k++) {
        stand->values[k] = VARIABLES[k].start;
    }
    memset(stand->failure, 0, sizeof stand->failure);
    run->engine_made = false;
}

/* Refuse a call that the phase does not allow. */
static bool in_phase(Run *run, enum phase phase, const char *when)
{
    if (run->stand.phase != phase) {
        text_add(&run->problems, "this call is possible only %s", when);
    }
    return run->stand.phase == phase;
}

static bool sound(Run *run)
{
    if (run->stand.failed) {
        text_add(&run->problems, "no steps and outputs after an error, unless reset or restored; the error was: %s",
                 run->stand.failure);
    }
    return !run->stand.failed;
}

bool run_plan(Run *run, double start, double stop)
{
    if (!in_phase(run, INSTANTIATED, "before initialization")) {
        return false;
    }
    if (!isfinite(start) || isnan(stop) || stop < start) {
        text_add(&run->problems, "start time = ");
        text_number(&run->problems, start);
        text_add(&run->problems, " s, stop time = ");
        text_number(&run->problems, stop);
        text_add(&run->problems, " s: a finite start and a stop after it are accepted");
        return false;
    }
    run->stand.start = run->stand.time = start;
    run->stand.stop = stop;
    run->engine_made = false;
    return true;
}

bool run_enter(Run *run)
{
    const bool allowed = in_phase(run, INSTANTIATED, "before initialization");
    if (allowed) {
        run->stand.phase = INITIALIZING;
    }
    return allowed;
}

/* Take over the engine's outputs if every one is finite. */
static bool collect(Run *run)
{
    const double *outputs = engine_show(&run->engine);
    if (!check_outputs(outputs, &run->problems)) {
        return false;
    }
    memcpy(run->stand.values + VARIABLE_COUNT - OUTPUT_COUNT, outputs, OUTPUT_COUNT * sizeof *outputs);
    return true;
}

bool run_make_engine(Run *run)
{
    if (run->engine_made) {
        return true;
    }
    bool fine = check_ranges(PARAMETER, run->stand.values, &run->problems);
    fine &= check_ranges(INPUT, run->stand.values, &run->problems);
    fine = fine && engine_prepare(&run->engine, run->memory, run->stand.values, &run->problems);
    fine = fine && engine_open(&run->engine, run->stand.start, &run->problems);
    run->engine_made = fine && collect(run);
    return run->engine_made;
}

bool run_begin(Run *run)
{
    if (!in_phase(run, INITIALIZING, "in initialization mode") || !run_make_engine(run)) {
        return false;
    }
    run->stand.phase = STEPPING;
    return true;
}

bool run_step(Run *run, double time, double dt)
{
    Stand *stand = &run->stand;
    bool fine = sound(run) && in_phase(run, STEPPING, "between the end of initialization and termination");
    fine = fine && check_step(time, dt, stand->time, stand->stop, &run->problems);
    fine = fine && check_ranges(INPUT, stand->values, &run->problems);
    fine = fine && engine_step(&run->engine, time, dt, &run->problems) && collect(run);
    if (fine) {
        stand->time = time + dt;
    }
    return fine;
}

bool run_terminate(Run *run)
{
    const bool allowed = in_phase(run, STEPPING, "between the end of initialization and termination");
    if (allowed) {
        run->stand.phase = TERMINATED;
    }
    return allowed;
}

static bool known(Run *run, enum kind kind, unsigned reference)
{
    static const char *const NAMES[] = {"real", "integer", "boolean", "string"};
    if (reference < VARIABLE_COUNT && VARIABLES[reference].kind == kind) {
        return true;
    }
    text_next(&run->problems);
    text_add(&run->problems, "value reference %u: not of type %s", reference, NAMES[kind]);
    return false;
}

bool run_readable(Run *run, enum kind kind, const unsigned *references, size_t count)
{
    bool output = false;
    for (size_t k = 0; k < count; k++) {
        if (!known(run, kind, references[k])) {
            return false;
        }
        output |= VARIABLES[references[k]].role == OUTPUT;
    }
    return !output || (sound(run) && run_make_engine(run));
}

/* Whether a variable may take a value now. */
static bool acceptable(Run *run, const Variable *variable, double value)
{
    const char *why = NULL;
    if (variable->role == OUTPUT) {
        why = "an output cannot be set";
    } else if (variable->role == PARAMETER && run->stand.phase > INITIALIZING) {
        why = "fixed once the run has started; reset the FMU to change it";
    } else if (run->stand.phase == TERMINATED) {
        why = "the run has ended";
    } else {
        return check_finite(variable, value, &run->problems);
    }
    text_next(&run->problems);
    text_add(&run->problems, "%s = ", variable->name);
    text_number(&run->problems, value);
    text_add(&run->problems, ": %s", why);
    return false;
}

bool run_write(Run *run, enum kind kind, const unsigned *references, size_t count,
               double (*value)(const void *values, size_t place), const void *values)
{
    bool fine = true;
    for (size_t k = 0; k < count; k++) {
        fine = known(run, kind, references[k]) && acceptable(run, &VARIABLES[references[k]], value(values, k)) && fine;
    }
    for (size_t k = 0; fine && k < count; k++) {
        double *target = &run->stand.values[references[k]];
        if (*target != value(values, k) && run->stand.phase < STEPPING) {
            run->engine_made = false;
        }
        *target = value(values, k);
    }
    return fine;
}
