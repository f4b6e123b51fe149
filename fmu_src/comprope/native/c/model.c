#include "model.h"

#include "component.h"
#include "variables.h"

#include <string.h>

bool kernel_succeeded(const double *message, int64_t status, Message *problems)
{
    if (status == 0) {
        return true;
    }
    message_next(problems);
    message_add(problems, MESSAGES[status], message[0], message[1], message[2], message[3], message[4], message[5],
                message[6], message[7]);
    return false;
}

_Static_assert(MESSAGE_VALUES == 8, "as many values as a message takes at most are passed");

static size_t size_of(size_t array, size_t columns)
{
    return SIZES[array].per_column * columns + SIZES[array].fixed;
}

/* Point the arrays into the block, which begins with those of the state; some are among the variables' values. */
static void divide_block(Model *model, double *values, size_t columns)
{
    double *at = model->block;
    for (size_t k = 0; k < ARRAYS; k++) {
        model->tables.array[k] = at;
        at += size_of(k, columns);
        if (k + 1 == STATE_ARRAYS) {
            model->state_numbers = (size_t)(at - model->block);
        }
    }
    for (size_t k = 0; k < AMONG_VALUES_COUNT; k++) {
        model->tables.array[AMONG_VALUES[k].array] = values + AMONG_VALUES[k].place;
    }
}

static bool allocate_block(Model *model, Allocator allocator, size_t columns, Message *problems)
{
    size_t numbers = 0;
    for (size_t k = 0; k < ARRAYS; k++) {
        numbers += size_of(k, columns);
    }
    if (model->block && model->numbers == numbers) {
        return true;
    }
    model_free(model, allocator);
    model->block = allocate_zeros(allocator, numbers * sizeof(double));
    if (!model->block) {
        message_next(problems);
        message_add(problems, "these parameters need %.1f MB of memory, which are not there", 8e-6 * (double)numbers);
        return false;
    }
    model->numbers = numbers;
    return true;
}

bool model_prepare(Model *model, Allocator allocator, double *values, Message *problems)
{
    const size_t columns = component_columns(values, problems);
    if (!columns || !allocate_block(model, allocator, columns, problems)) {
        return false;
    }
    divide_block(model, values, columns);
    component_prepare(&model->tables, values, columns);
    return true;
}

bool model_initialize(Model *model, double t, Message *problems)
{
    memset(model->block, 0, model->state_numbers * sizeof(double));
    return component_initialize(&model->tables, t, problems);
}

bool model_step(Model *model, const double *values, double t, double dt, Message *problems)
{
    component_tune(&model->tables, values);
    return component_step(&model->tables, t, dt, problems);
}

const double *model_outputs(Model *model)
{
    return component_outputs(&model->tables);
}

void model_free(Model *model, Allocator allocator)
{
    if (model->block) {
        allocator.release(model->block);
    }
    memset(model, 0, sizeof *model);
}
