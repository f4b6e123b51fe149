/* The rope. */
#include "component.h"

#include <string.h>

/* The kernels' parameters from the values of the variables; the derived ones stay to be set. */
static void flatten(const double *values, double *p)
{
    for (size_t k = 0; k < SLOT_COUNT; k++) {
        p[k] = SLOT_PLACES[k] < 0 ? 0.0 : values[SLOT_PLACES[k]];
    }
}

size_t component_columns(double *values, Message *problems)
{
    double p[SLOT_COUNT], message[MESSAGE_VALUES] = {0};
    Tables tables = {{0}, {0}};
    flatten(values, p);
    tables.array[ROPEDATA_p] = p;
    tables.array[WORKSPACE_message] = message;
    if (!kernel_succeeded(message, call_check_mesh(&tables), problems)) {
        return 0;
    }
    return (size_t)call_generate_mesh(&tables) + 1;
}

void component_prepare(Tables *tables, const double *values, size_t columns)
{
    double *p = tables->array[ROPEDATA_p], *frictionless = tables->array[ROPEDATA_frictionless];
    tables->integer[ROPEDATA_n] = (int64_t)columns - 1;
    tables->integer[ROPEDATA_effects] = EFFECTS;
    tables->integer[ROPEDATA_history_size] = HISTORIES * (int64_t)columns;
    flatten(values, p);
    call_generate_mesh(tables);
    memcpy(frictionless, p, SLOT_COUNT * sizeof *p);
    for (size_t k = 0; k < FRICTIONLESS_COUNT; k++) {
        frictionless[FRICTIONLESS[k].slot] = FRICTIONLESS[k].value;
    }
}

bool component_initialize(Tables *tables, double t, Message *problems)
{
    const double *message = tables->array[WORKSPACE_message];
    if (!kernel_succeeded(message, call_check_reach(tables, t), problems) ||
        !kernel_succeeded(message, call_check_start(tables), problems)) {
        return false;
    }
    tables->array[STATE_time][0] = t;
    call_start_inputs(tables, t);
    return kernel_succeeded(message, call_start_at_rest(tables, t), problems);
}

void component_tune(Tables *tables, const double *values)
{
    for (size_t k = 0; k < TUNABLE_COUNT; k++) {
        tables->array[ROPEDATA_p][TUNABLE_SLOTS[k]] = values[SLOT_PLACES[TUNABLE_SLOTS[k]]];
    }
}

bool component_step(Tables *tables, double t, double dt, Message *problems)
{
    const double *message = tables->array[WORKSPACE_message];
    if (!kernel_succeeded(message, call_check_reach(tables, t), problems) ||
        !kernel_succeeded(message, call_check_motion(tables, t, dt), problems)) {
        return false;
    }
    const double duration = call_interpolate_inputs(tables, t, dt);
    if (duration == 0.0) { /* put off to the next step */
        return true;
    }
    tables->array[STATE_time][0] = t - (duration - dt);
    return kernel_succeeded(message, call_advance(tables, duration), problems);
}

const double *component_outputs(Tables *tables)
{
    call_evaluate_outputs(tables, SENSORS);
    return tables->array[OUTPUTS_y];
}
