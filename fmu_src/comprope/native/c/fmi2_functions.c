/* The functions of FMI 2.0 for co-simulation, except fmi2Instantiate: each translates types and makes one call (see calls.h).
 *
 * Native FMUs and those that run in Python share them.
 */

#include "fmi2Functions.h"

#include "calls.h"

_Static_assert((int)fmi2OK == STATUS_OK && (int)fmi2Error == STATUS_ERROR, "statuses are those of the FMI");

/* -- Inquiry -- */

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void)
{
    return fmi2Version;
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[])
{
    (void)on, (void)count, (void)categories; /* only errors are logged, and those always */
    return c ? fmi2OK : fmi2Error;
}

/* -- Initialization, steps and termination -- */

void fmi2FreeInstance(fmi2Component c)
{
    instance_free(c);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean stop_defined, fmi2Real stop)
{
    (void)tolerance_defined, (void)tolerance; /* the model's own parameters set its accuracy */
    return setup_experiment(c, start, stop_defined, stop);
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    return enter_initialization(c);
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    return exit_initialization(c);
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real dt, fmi2Boolean no_set_state_prior)
{
    (void)no_set_state_prior;
    return do_step(c, time, dt);
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    return terminate(c);
}

fmi2Status fmi2Reset(fmi2Component c)
{
    return reset(c);
}

/* -- Values -- */

static double load_boolean(const void *values, size_t index)
{
    return ((const fmi2Boolean *)values)[index] != fmi2False;
}

static void store_boolean(void *values, size_t index, double value)
{
    ((fmi2Boolean *)values)[index] = value != 0.0 ? fmi2True : fmi2False;
}

static const ValueType REAL_TYPE = {REAL, load_double, store_double, false};
static const ValueType INTEGER_TYPE = {INTEGER, load_int32, store_int32, false};
static const ValueType BOOLEAN_TYPE = {BOOLEAN, load_boolean, store_boolean, false};
static const ValueType STRING_TYPE = {STRING, NULL, NULL, false}; /* the model has no strings */

#define GETTER_AND_SETTER(Type, type)                                                                 \
    fmi2Status fmi2Get##Type(fmi2Component c, const fmi2ValueReference references[], size_t count,    \
                             fmi2##Type values[])                                                     \
    {                                                                                                 \
        return get_values(c, &type, references, count, values, count);                                \
    }                                                                                                 \
    fmi2Status fmi2Set##Type(fmi2Component c, const fmi2ValueReference references[], size_t count,    \
                             const fmi2##Type values[])                                               \
    {                                                                                                 \
        return set_values(c, &type, references, count, values, count);                                \
    }

GETTER_AND_SETTER(Real, REAL_TYPE)
GETTER_AND_SETTER(Integer, INTEGER_TYPE)
GETTER_AND_SETTER(Boolean, BOOLEAN_TYPE)
GETTER_AND_SETTER(String, STRING_TYPE)

/* -- Saved states -- */

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    return save_state(c, state);
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state)
{
    return restore_state(c, state);
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    return free_state(c, state);
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    return serialized_size(c, state, size);
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    return serialize_state(c, state, bytes, size);
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state)
{
    return deserialize_state(c, bytes, size, state);
}

/* -- What this FMU does not offer -- */

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference references[], size_t count,
                                       const fmi2Integer orders[], const fmi2Real values[])
{
    (void)references, (void)count, (void)orders, (void)values;
    return instance_refuse(
        c, "derivatives of inputs cannot be set; velocities and accelerations are inputs of their own");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference references[], size_t count,
                                        const fmi2Integer orders[], fmi2Real values[])
{
    (void)references, (void)count, (void)orders, (void)values;
    return instance_refuse(c, "derivatives of outputs are not offered");
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t unknown_count,
                                        const fmi2ValueReference knowns[], size_t known_count, const fmi2Real changes[],
                                        fmi2Real results[])
{
    (void)unknowns, (void)unknown_count, (void)knowns, (void)known_count, (void)changes, (void)results;
    return instance_refuse(c, "directional derivatives are not offered");
}

fmi2Status fmi2CancelStep(fmi2Component c)
{
    return instance_refuse(c, "no step is in progress: each call of fmi2DoStep returns when its step is done");
}

/* -- Status; what cannot be answered is no error: FMI says to discard it -- */

static fmi2Status no_answer(fmi2Component c)
{
    return c ? fmi2Discard : fmi2Error;
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value)
{
    (void)kind, (void)value;
    return no_answer(c);
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    if (!c || !value || kind != fmi2LastSuccessfulTime) {
        return no_answer(c);
    }
    return last_time(c, value);
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value)
{
    (void)kind, (void)value;
    return no_answer(c);
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    if (!c || !value || kind != fmi2Terminated) {
        return no_answer(c);
    }
    *value = fmi2False; /* only the importer ends a simulation */
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value)
{
    (void)kind, (void)value;
    return no_answer(c);
}
