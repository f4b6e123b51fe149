/* The drive. */
#include "component.h"

/* Whether no check from `first` up to `end` fails; adds a sentence for each that does. */
static bool accepted(Tables *tables, int64_t first, int64_t end, double t, Message *problems)
{
    bool valid = true;
    for (int64_t number = first; number < end; number++) {
        const int64_t status = call_check(tables, number, t);
        valid = kernel_succeeded(tables->array[WORKSPACE_message], status, problems) && valid;
    }
    return valid;
}

size_t component_columns(double *values, Message *problems)
{
    double message[MESSAGE_VALUES] = {0};
    Tables tables = {{0}, {0}};
    for (size_t k = 0; k < AMONG_VALUES_COUNT; k++) {
        tables.array[AMONG_VALUES[k].array] = values + AMONG_VALUES[k].place;
    }
    tables.array[WORKSPACE_message] = message;
    if (!accepted(&tables, COMPONENT_CHECKS, STOPS, 0.0, problems) ||
        !accepted(&tables, STOPS, INPUT_CHECKS, 0.0, problems)) {
        return 0;
    }
    return (size_t)call_count_points(&tables);
}

void component_prepare(Tables *tables, const double *values, size_t columns)
{
    (void)values; /* the parameters are read where they lie */
    tables->integer[DESIGN_points] = (int64_t)columns;
    call_design_drive(tables);
}

bool component_initialize(Tables *tables, double t, Message *problems)
{
    if (!accepted(tables, INPUT_CHECKS, TORQUE_CHECK, t, problems) ||
        !accepted(tables, TORQUE_CHECK, CHECKS, t, problems)) {
        return false;
    }
    call_start_at_rest(tables, t);
    return true;
}

void component_tune(Tables *tables, const double *values)
{
    (void)tables, (void)values; /* the design of the servo follows from all parameters: none is tunable */
}

bool component_step(Tables *tables, double t, double dt, Message *problems)
{
    return accepted(tables, INPUT_CHECKS, START_CHECK, t, problems) &&
           kernel_succeeded(tables->array[WORKSPACE_message], call_advance_drive(tables, t, dt), problems);
}

const double *component_outputs(Tables *tables)
{
    call_evaluate_drive(tables);
    return tables->array[OUTPUTS_y];
}
