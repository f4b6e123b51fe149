#include "rope_model.h"

#include "variables.h"

#include <math.h>
#include <string.h>

/* Add a kernel's refusal in the words it shares with Python; returns whether there was none. */
static bool fine(const Rope *rope, int64_t status, Message *problems)
{
    const double *told = rope->array[AT_told];
    if (status == 0) {
        return true;
    }
    message_next(problems);
    message_add(problems, WORDS[status], told[0], told[1], told[2], told[3], told[4], told[5]);
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

/* Point the arrays into the block, which begins with those that make the state. */
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
    model->rope.array[AT_u] = values + FIRST_INPUT;
    model->rope.array[AT_options] = values + FIRST_OPTION;
    model->rope.array[AT_spots] = values + FIRST_SENSOR;
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
    double p[SLOT_COUNT], told[TOLD];
    Rope *rope = &model->rope;

    flatten(values, p);
    rope->array[AT_p] = p;
    rope->array[AT_told] = told;
    if (!fine(rope, rope_coarse(rope), problems)) {
        return false;
    }
    const size_t columns = (size_t)rope_divide(rope) + 1;
    if (!allocate_block(model, allocator, columns, problems)) {
        return false;
    }
    rope->n = (int64_t)columns - 1;
    rope->m = SENSORS;
    rope->effects = EFFECTS;
    rope->state_size = HISTORIES * (int64_t)columns;
    divide_block(model, values, columns);
    memcpy(rope->array[AT_p], p, sizeof p);
    memcpy(rope->array[AT_smooth], p, sizeof p);
    for (size_t k = 0; k < SMOOTH_COUNT; k++) {
        rope->array[AT_smooth][SMOOTH[k].slot] = SMOOTH[k].value;
    }
    return true;
}

bool rope_model_initialize(RopeModel *model, double t, Message *problems)
{
    Rope *rope = &model->rope;
    if (!fine(rope, rope_reach(rope, t), problems)) {
        return false;
    }
    memset(model->block, 0, model->state_numbers * sizeof(double));
    rope->array[AT_time][0] = t;
    rope_begin_motion(rope, t);
    return fine(rope, rope_settle(rope, t), problems);
}

bool rope_model_step(RopeModel *model, double t, double dt, Message *problems)
{
    Rope *rope = &model->rope;
    if (!fine(rope, rope_reach(rope, t), problems)) {
        return false;
    }
    rope->array[AT_time][0] = t;
    rope_lead(rope, t, dt);
    return fine(rope, rope_travel(rope, dt), problems);
}

const double *rope_model_outputs(RopeModel *model)
{
    rope_show(&model->rope);
    return model->rope.array[AT_y];
}

void rope_model_free(RopeModel *model, Allocator allocator)
{
    if (model->block) {
        allocator.release(model->block);
    }
    memset(model, 0, sizeof *model);
}
