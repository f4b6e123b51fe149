/* Values by reference in FMI 3.0. All variables are scalars; the time has the reference after the last one of the model. */

#include "fmi3Functions.h"
#include "instance.h"

#include <limits.h>
#include <math.h>

/* The instance, if a call for `count` values gives as many places for them. */
static Instance *asked(fmi3Instance c, const fmi3ValueReference *references, size_t count, const void *values,
                       size_t value_count)
{
    Instance *instance = instance_called(c);
    if (instance && (count != value_count || (count && (!references || !values)))) {
        instance_refuse(instance, "one value reference and one value are needed for each variable");
        return NULL;
    }
    return instance;
}

static bool is_time(fmi3ValueReference reference)
{
    return reference == VARIABLE_COUNT;
}

fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference references[], size_t count, fmi3Float64 values[],
                          size_t value_count)
{
    Instance *instance = asked(c, references, count, values, value_count);
    bool fine = instance;
    for (size_t k = 0; fine && k < count; k++) {
        const Stand *stand = &instance->run.stand;
        fine = is_time(references[k]) || run_readable(&instance->run, REAL, references + k, 1);
        values[k] = !fine ? NAN : is_time(references[k]) ? stand->time : stand->values[references[k]];
    }
    return instance ? instance_finish(instance, fine) : fmi3Error;
}

fmi3Status fmi3GetInt32(fmi3Instance c, const fmi3ValueReference references[], size_t count, fmi3Int32 values[],
                        size_t value_count)
{
    Instance *instance = asked(c, references, count, values, value_count);
    if (!instance || instance_finish(instance, run_readable(&instance->run, INTEGER, references, count)) != fmi3OK) {
        return fmi3Error;
    }
    for (size_t k = 0; k < count; k++) {
        values[k] = (fmi3Int32)fmax(fmin(instance->run.stand.values[references[k]], INT32_MAX), INT32_MIN);
    }
    return fmi3OK;
}

fmi3Status fmi3GetBoolean(fmi3Instance c, const fmi3ValueReference references[], size_t count, fmi3Boolean values[],
                          size_t value_count)
{
    Instance *instance = asked(c, references, count, values, value_count);
    if (!instance || instance_finish(instance, run_readable(&instance->run, BOOLEAN, references, count)) != fmi3OK) {
        return fmi3Error;
    }
    for (size_t k = 0; k < count; k++) {
        values[k] = instance->run.stand.values[references[k]] != 0.0;
    }
    return fmi3OK;
}

static double float64_value(const void *values, size_t place)
{
    return ((const fmi3Float64 *)values)[place];
}

static double int32_value(const void *values, size_t place)
{
    return ((const fmi3Int32 *)values)[place];
}

static double boolean_value(const void *values, size_t place)
{
    return ((const fmi3Boolean *)values)[place];
}

/* Set values of one of the types that the model has. */
#define SETTER(Type, kind, value)                                                                                    \
    fmi3Status fmi3Set##Type(fmi3Instance c, const fmi3ValueReference references[], size_t count,                    \
                             const fmi3##Type values[], size_t value_count)                                          \
    {                                                                                                                \
        Instance *instance = asked(c, references, count, values, value_count);                                       \
        return instance ? instance_finish(instance,                                                                  \
                                          run_write(&instance->run, kind, references, count, value, values))         \
                        : fmi3Error;                                                                                 \
    }

SETTER(Float64, REAL, float64_value)
SETTER(Int32, INTEGER, int32_value)
SETTER(Boolean, BOOLEAN, boolean_value)

/* Of a type that the model does not have, no variables can be read or set. */
static fmi3Status none(fmi3Instance c, size_t count, const char *sentence)
{
    Instance *instance = instance_called(c);
    return !instance ? fmi3Error : count ? instance_refuse(instance, sentence) : fmi3OK;
}

#define NONE(Type, call, ...)                                              \
    fmi3Status fmi3##call##Type(__VA_ARGS__)                               \
    {                                                                      \
        (void)references, (void)values;                                    \
        return none(c, count, "this FMU has no variables of type " #Type); \
    }
#define REFERENCES fmi3Instance c, const fmi3ValueReference references[], size_t count
#define NO_NUMBERS(Type)                                                       \
    NONE(Type, Get, REFERENCES, fmi3##Type values[], size_t value_count)       \
    NONE(Type, Set, REFERENCES, const fmi3##Type values[], size_t value_count)

NO_NUMBERS(Float32)
NO_NUMBERS(Int8)
NO_NUMBERS(UInt8)
NO_NUMBERS(Int16)
NO_NUMBERS(UInt16)
NO_NUMBERS(UInt32)
NO_NUMBERS(Int64)
NO_NUMBERS(UInt64)
NO_NUMBERS(String)
NONE(Binary, Get, REFERENCES, size_t sizes[], fmi3Binary values[], size_t value_count)
NONE(Binary, Set, REFERENCES, const size_t sizes[], const fmi3Binary values[], size_t value_count)
NONE(Clock, Get, REFERENCES, fmi3Clock values[])
NONE(Clock, Set, REFERENCES, const fmi3Clock values[])
