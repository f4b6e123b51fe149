#include "rope_model.h"

#include "variables.h"

#include <math.h>
#include <string.h>

/* Add a kernel's refusal in the words it shares with Python; returns whether there was none. */
static bool fine(const Rope *rope, int64_t status, Text *problems)
{
    const double *told = rope->array[AT_told];
    if (status == 0) {
        return true;
    }
    text_next(problems);
    text_add(problems, WORDS[status], told[0], told[1], told[2], told[3], told[4], told[5]);
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
static void divide_block(Engine *engine, double *values, size_t columns)
{
    double *at = engine->block;
    for (size_t k = 0; k < ARRAYS; k++) {
        engine->rope.array[k] = at;
        at += size_of(k, columns);
        if (k + 1 == STATE_ARRAYS) {
            engine->state_numbers = (size_t)(at - engine->block);
        }
    }
    engine->rope.array[AT_u] = values + FIRST_INPUT;
    engine->rope.array[AT_options] = values + FIRST_OPTION;
    engine->rope.array[AT_spots] = values + FIRST_SENSOR;
}

static bool take_block(Engine *engine, Memory memory, size_t columns, Text *problems)
{
    size_t numbers = 0;
    for (size_t k = 0; k < ARRAYS; k++) {
        numbers += size_of(k, columns);
    }
    if (engine->block && engine->numbers == numbers) {
        return true;
    }
    engine_free(engine, memory);
    engine->block = take_zeros(memory, numbers * sizeof(double));
    if (!engine->block) {
        text_next(problems);
        text_add(problems, "the rope's mesh of %lu nodes needs %.0f MB of memory, which are not there",
                 (unsigned long)columns - 1, 8e-6 * (double)numbers);
        return false;
    }
    engine->numbers = numbers;
    return true;
}

bool engine_prepare(Engine *engine, Memory memory, double *values, Text *problems)
{
    double p[SLOT_COUNT], told[TOLD];
    Rope *rope = &engine->rope;

    flatten(values, p);
    rope->array[AT_p] = p;
    rope->array[AT_told] = told;
    if (!fine(rope, rope_coarse(rope), problems)) {
        return false;
    }
    const size_t columns = (size_t)rope_divide(rope) + 1;
    if (!take_block(engine, memory, columns, problems)) {
        return false;
    }
    rope->n = (int64_t)columns - 1;
    rope->m = SENSORS;
    rope->effects = EFFECTS;
    rope->state_size = HISTORIES * (int64_t)columns;
    divide_block(engine, values, columns);
    memcpy(rope->array[AT_p], p, sizeof p);
    memcpy(rope->array[AT_smooth], p, sizeof p);
    for (size_t k = 0; k < SMOOTH_COUNT; k++) {
        rope->array[AT_smooth][SMOOTH[k].slot] = SMOOTH[k].value;
    }
    return true;
}

bool engine_open(Engine *engine, double t, Text *problems)
{
    Rope *rope = &engine->rope;
    if (!fine(rope, rope_reach(rope, t), problems)) {
        return false;
    }
    memset(engine->block, 0, engine->state_numbers * sizeof(double));
    rope->array[AT_time][0] = t;
    rope_begin_motion(rope, t);
    return fine(rope, rope_settle(rope, t), problems);
}

bool engine_step(Engine *engine, double t, double dt, Text *problems)
{
    Rope *rope = &engine->rope;
    if (!fine(rope, rope_reach(rope, t), problems)) {
        return false;
    }
    rope->array[AT_time][0] = t;
    rope_lead(rope, t, dt);
    return fine(rope, rope_travel(rope, dt), problems);
}

const double *engine_show(Engine *engine)
{
    rope_show(&engine->rope);
    return engine->rope.array[AT_y];
}

void engine_free(Engine *engine, Memory memory)
{
    if (engine->block) {
        memory.give_back(engine->block);
    }
    memset(engine, 0, sizeof *engine);
}
