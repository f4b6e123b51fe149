#include "rope_model.h"

#include "variables.h"

#include <math.h>
#include <string.h>

/* Whether a kernel has succeeded; if not, the message that it shares with Python is added. */
static bool kernel_succeeded(const Rope *rope, int64_t status, Message *problems)
{
    const double *values = rope->array[WORKSPACE_message];
    if (status == 0) {
        return true;
    }
    message_next(problems);
    message_add(problems, MESSAGES[status], values[0], values[1], values[2], values[3], values[4], values[5]);
    return false;
}

/* The kernels' parameters from the values of the variables; the derived ones stay to be set. */
static void flatten(const double *values, double *p)
{
    for (size_t k = 0; k < SLOT_COUNT; k++) {
        p[k] = SLOT_PLACES[k] < 0 ? 0.0 : values[SLOT_PLACES[k]];
    }
}

static size_t size_of(size_t array, size_t columns)
{
    return SIZES[array].per_column * columns + SIZES[array].fixed;
}

/* Point the arrays into the block, which begins with those of the state; some are among the variables' values. */
static void divide_block(RopeModel *model, double *values, size_t columns)
{
    double *at = model->block;
    for (size_t k = 0; k < ARRAYS; k++) {
        model->rope.array[k] = at;
        at += size_of(k, columns);
        if (k + 1 == STATE_ARRAYS) {
            model->state_numbers = (size_t)(at - model->block);
        }
    }
    model->rope.array[ENDS_u] = values + FIRST_INPUT;
    model->rope.array[ENDS_options] = values + FIRST_OPTION;
    model->rope.array[OUTPUTS_sensors] = values + FIRST_SENSOR;
}

static bool allocate_block(RopeModel *model, Allocator allocator, size_t columns, Message *problems)
{
    size_t numbers = 0;
    for (size_t k = 0; k < ARRAYS; k++) {
        numbers += size_of(k, columns);
    }
    if (model->block && model->numbers == numbers) {
        return true;
    }
    rope_model_free(model, allocator);
    model->block = allocate_zeros(allocator, numbers * sizeof(double));
    if (!model->block) {
        message_next(problems);
        message_add(problems, "the rope's mesh of %lu nodes needs %.0f MB of memory, which are not there",
                 (unsigned long)columns - 1, 8e-6 * (double)numbers);
        return false;
    }
    model->numbers = numbers;
    return true;
}

bool rope_model_prepare(RopeModel *model, Allocator allocator, double *values, Message *problems)
{
    double p[SLOT_COUNT], message[MESSAGE_VALUES];
    Rope *rope = &model->rope;

    flatten(values, p);
    rope->array[ROPEDATA_p] = p;
    rope->array[WORKSPACE_message] = message;
    if (!kernel_succeeded(rope, rope_check_mesh(rope), problems)) {
        return false;
    }
    const size_t columns = (size_t)rope_generate_mesh(rope) + 1;
    if (!allocate_block(model, allocator, columns, problems)) {
        return false;
    }
    rope->integer[ROPEDATA_n] = (int64_t)columns - 1;
    rope->integer[ROPEDATA_effects] = EFFECTS;
    rope->integer[ROPEDATA_history_size] = HISTORIES * (int64_t)columns;
    divide_block(model, values, columns);
    memcpy(rope->array[ROPEDATA_p], p, sizeof p);
    memcpy(rope->array[ROPEDATA_frictionless], p, sizeof p);
    for (size_t k = 0; k < FRICTIONLESS_COUNT; k++) {
        rope->array[ROPEDATA_frictionless][FRICTIONLESS[k].slot] = FRICTIONLESS[k].value;
    }
    return true;
}

bool rope_model_initialize(RopeModel *model, double t, Message *problems)
{
    Rope *rope = &model->rope;
    if (!kernel_succeeded(rope, rope_check_reach(rope, t), problems) ||
        !kernel_succeeded(rope, rope_check_start(rope), problems)) {
        return false;
    }
    memset(model->block, 0, model->state_numbers * sizeof(double));
    rope->array[STATE_time][0] = t;
    rope_start_inputs(rope, t);
    return kernel_succeeded(rope, rope_start_at_rest(rope, t), problems);
}

bool rope_model_step(RopeModel *model, double t, double dt, Message *problems)
{
    Rope *rope = &model->rope;
    if (!kernel_succeeded(rope, rope_check_reach(rope, t), problems) ||
        !kernel_succeeded(rope, rope_check_motion(rope, t, dt), problems)) {
        return false;
    }
    const double duration = rope_interpolate_inputs(rope, t, dt);
    if (duration == 0.0) { /* put off to the next step */
        return true;
    }
    rope->array[STATE_time][0] = t - (duration - dt);
    return kernel_succeeded(rope, rope_advance(rope, duration), problems);
}

const double *rope_model_outputs(RopeModel *model)
{
    rope_evaluate_outputs(&model->rope, SENSORS);
    return model->rope.array[OUTPUTS_y];
}

void rope_model_free(RopeModel *model, Allocator allocator)
{
    if (model->block) {
        allocator.release(model->block);
    }
    memset(model, 0, sizeof *model);
}
