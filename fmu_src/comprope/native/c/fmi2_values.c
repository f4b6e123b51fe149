/* Values by reference in FMI 2.0. */

#include "fmi2Functions.h"
#include "instance.h"

#include <limits.h>
#include <math.h>

/* The instance, if a call for `count` values gives places for them. */
static Instance *asked(fmi2Component c, const fmi2ValueReference *references, size_t count, const void *values)
{
    Instance *instance = instance_called(c);
    if (instance && count && (!references || !values)) {
        instance_refuse(instance, "value references or values are missing");
        return NULL;
    }
    return instance;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference references[], size_t count, fmi2Real values[])
{
    Instance *instance = asked(c, references, count, values);
    if (!instance || instance_finish(instance, run_readable(&instance->run, REAL, references, count)) != fmi2OK) {
        return fmi2Error;
    }
    for (size_t k = 0; k < count; k++) {
        values[k] = instance->run.stand.values[references[k]];
    }
    return fmi2OK;
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference references[], size_t count, fmi2Integer values[])
{
    Instance *instance = asked(c, references, count, values);
    if (!instance || instance_finish(instance, run_readable(&instance->run, INTEGER, references, count)) != fmi2OK) {
        return fmi2Error;
    }
    for (size_t k = 0; k < count; k++) {
        values[k] = (fmi2Integer)fmax(fmin(instance->run.stand.values[references[k]], INT_MAX), INT_MIN);
    }
    return fmi2OK;
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference references[], size_t count, fmi2Boolean values[])
{
    Instance *instance = asked(c, references, count, values);
    if (!instance || instance_finish(instance, run_readable(&instance->run, BOOLEAN, references, count)) != fmi2OK) {
        return fmi2Error;
    }
    for (size_t k = 0; k < count; k++) {
        values[k] = instance->run.stand.values[references[k]] != 0.0 ? fmi2True : fmi2False;
    }
    return fmi2OK;
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference references[], size_t count, fmi2String values[])
{
    Instance *instance = asked(c, references, count, values);
    return instance ? instance_finish(instance, run_readable(&instance->run, STRING, references, count)) : fmi2Error;
}

static double real_value(const void *values, size_t place)
{
    return ((const fmi2Real *)values)[place];
}

static double integer_value(const void *values, size_t place)
{
    return ((const fmi2Integer *)values)[place];
}

static double boolean_value(const void *values, size_t place)
{
    return ((const fmi2Boolean *)values)[place] != fmi2False;
}

static double no_value(const void *values, size_t place)
{
    (void)values, (void)place;
    return 0.0;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference references[], size_t count, const fmi2Real values[])
{
    Instance *instance = asked(c, references, count, values);
    return instance ? instance_finish(instance, run_write(&instance->run, REAL, references, count, real_value, values))
                    : fmi2Error;
}

fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference references[], size_t count,
                          const fmi2Integer values[])
{
    Instance *instance = asked(c, references, count, values);
    return instance
               ? instance_finish(instance, run_write(&instance->run, INTEGER, references, count, integer_value, values))
               : fmi2Error;
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference references[], size_t count,
                          const fmi2Boolean values[])
{
    Instance *instance = asked(c, references, count, values);
    return instance
               ? instance_finish(instance, run_write(&instance->run, BOOLEAN, references, count, boolean_value, values))
               : fmi2Error;
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference references[], size_t count,
                         const fmi2String values[])
{
    Instance *instance = asked(c, references, count, values);
    return instance ? instance_finish(instance, run_write(&instance->run, STRING, references, count, no_value, values))
                    : fmi2Error;
}
