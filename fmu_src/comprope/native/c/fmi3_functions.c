/* The functions of FMI 3.0 for co-simulation: each translates types and makes one call (see calls.h). */

#include "fmi3Functions.h"

#include "instance.h"

#include <stdlib.h>
#include <string.h>

_Static_assert((int)fmi3OK == STATUS_OK && (int)fmi3Error == STATUS_ERROR, "statuses are those of the FMI");

#define REFERENCES const fmi3ValueReference references[], size_t count

/* -- Inquiry and instances -- */

const char *fmi3GetVersion(void)
{
    return fmi3Version;
}

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t count, const fmi3String categories[])
{
    (void)on, (void)count, (void)categories; /* only errors are logged, and those always */
    return c ? fmi3OK : fmi3Error;
}

static void send(const Logger *logger, const char *instance_name, const char *sentence)
{
    (void)instance_name; /* the importer knows the instance by its environment */
    if (logger->callback) {
        ((fmi3LogMessageCallback)logger->callback)(logger->environment, fmi3Error, "logStatusError", sentence);
    }
}

static fmi3Instance create(fmi3String name, const char *refusal, fmi3InstanceEnvironment environment,
                           fmi3LogMessageCallback callback)
{
    const Logger logger = {send, (void (*)(void))callback, environment};
    return instance_create(name, refusal, logger, (Allocator){calloc, free});
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                         fmi3Boolean logging, fmi3Boolean events, fmi3Boolean early_return,
                                         const fmi3ValueReference intermediate[], size_t count,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                         fmi3IntermediateUpdateCallback update)
{
    (void)resources, (void)visible, (void)logging, (void)early_return, (void)intermediate, (void)update;
    const char *refusal =
        !token || strcmp(token, MODEL_TOKEN)
            ? "the instantiation token is not this FMU's: binary and modelDescription.xml do not belong together"
        : events ? "this FMU has no event mode"
        : count  ? "this FMU offers nothing between the ends of steps"
                 : NULL;
    return create(name, refusal, environment, logger);
}

static const char COSIMULATION_ONLY[] = "this FMU is for co-simulation only";

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                          fmi3Boolean logging, fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback logger)
{
    (void)token, (void)resources, (void)visible, (void)logging;
    return create(name, COSIMULATION_ONLY, environment, logger);
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                               fmi3Boolean visible, fmi3Boolean logging,
                                               fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                               fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
                                               fmi3UnlockPreemptionCallback unlock)
{
    (void)token, (void)resources, (void)visible, (void)logging, (void)update, (void)lock, (void)unlock;
    return create(name, COSIMULATION_ONLY, environment, logger);
}

void fmi3FreeInstance(fmi3Instance c)
{
    instance_free(c);
}

/* -- Initialization, steps and termination -- */

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerance_defined, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean stop_defined, fmi3Float64 stop)
{
    (void)tolerance_defined, (void)tolerance; /* the model's own parameters set its accuracy */
    const int status = setup_experiment(c, start, stop_defined, stop);
    return status == STATUS_OK ? enter_initialization(c) : status;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    return exit_initialization(c);
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 dt, fmi3Boolean no_set_state_prior,
                      fmi3Boolean *event_needed, fmi3Boolean *terminate_simulation, fmi3Boolean *early_return,
                      fmi3Float64 *last_successful_time)
{
    (void)no_set_state_prior;
    if (!c || !event_needed || !terminate_simulation || !early_return || !last_successful_time) {
        return instance_refuse(c, "places for what a step returns are missing");
    }
    *event_needed = *terminate_simulation = *early_return = fmi3False; /* only the importer ends a simulation */
    const int status = do_step(c, time, dt);
    last_time(c, last_successful_time);
    return status;
}

fmi3Status fmi3Terminate(fmi3Instance c)
{
    return terminate(c);
}

fmi3Status fmi3Reset(fmi3Instance c)
{
    return reset(c);
}

/* -- Values -- */

static double load_boolean(const void *values, size_t index)
{
    return ((const fmi3Boolean *)values)[index];
}

static void store_boolean(void *values, size_t index, double value)
{
    ((fmi3Boolean *)values)[index] = value != 0.0;
}

static const ValueType FLOAT64_TYPE = {REAL, load_double, store_double, true};
static const ValueType INT32_TYPE = {INTEGER, load_int32, store_int32, true};
static const ValueType BOOLEAN_TYPE = {BOOLEAN, load_boolean, store_boolean, true};

#define GETTER_AND_SETTER(Type, type)                                                                              \
    fmi3Status fmi3Get##Type(fmi3Instance c, REFERENCES, fmi3##Type values[], size_t value_count)                  \
    {                                                                                                              \
        return get_values(c, &type, references, count, values, value_count);                                       \
    }                                                                                                              \
    fmi3Status fmi3Set##Type(fmi3Instance c, REFERENCES, const fmi3##Type values[], size_t value_count)            \
    {                                                                                                              \
        return set_values(c, &type, references, count, values, value_count);                                       \
    }

GETTER_AND_SETTER(Float64, FLOAT64_TYPE)
GETTER_AND_SETTER(Int32, INT32_TYPE)
GETTER_AND_SETTER(Boolean, BOOLEAN_TYPE)

/* A call for variables of a type that the model does not have: an error unless it asks for none. */
static fmi3Status no_variables(fmi3Instance c, size_t count, const char *sentence)
{
    return c && !count ? fmi3OK : (fmi3Status)instance_refuse(c, sentence);
}

#define NO_VARIABLES(Type, call, ...)                                              \
    fmi3Status fmi3##call##Type(fmi3Instance c, REFERENCES, __VA_ARGS__)           \
    {                                                                              \
        (void)references, (void)values;                                            \
        return no_variables(c, count, "this FMU has no variables of type " #Type); \
    }
#define NO_NUMBERS(Type)                                                   \
    NO_VARIABLES(Type, Get, fmi3##Type values[], size_t value_count)       \
    NO_VARIABLES(Type, Set, const fmi3##Type values[], size_t value_count)

NO_NUMBERS(Float32)
NO_NUMBERS(Int8)
NO_NUMBERS(UInt8)
NO_NUMBERS(Int16)
NO_NUMBERS(UInt16)
NO_NUMBERS(UInt32)
NO_NUMBERS(Int64)
NO_NUMBERS(UInt64)
NO_NUMBERS(String)
NO_VARIABLES(Binary, Get, size_t sizes[], fmi3Binary values[], size_t value_count)
NO_VARIABLES(Binary, Set, const size_t sizes[], const fmi3Binary values[], size_t value_count)
NO_VARIABLES(Clock, Get, fmi3Clock values[])
NO_VARIABLES(Clock, Set, const fmi3Clock values[])

/* -- Saved states -- */

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state)
{
    return save_state(c, state);
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state)
{
    return restore_state(c, state);
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state)
{
    return free_state(c, state);
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size)
{
    return serialized_size(c, state, size);
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size)
{
    return serialize_state(c, state, bytes, size);
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state)
{
    return deserialize_state(c, bytes, size, state);
}

/* -- What this FMU does not offer; the standard demands every function -- */

#define NOT_OFFERED(function, reason, ...)   \
    fmi3Status function(__VA_ARGS__)        \
    {                                       \
        return instance_refuse(c, reason);  \
    }
#define DERIVATIVE_ARGUMENTS                                                                             \
    const fmi3ValueReference unknowns[], size_t unknown_count, const fmi3ValueReference knowns[],        \
        size_t known_count, const fmi3Float64 seeds[], size_t seed_count, fmi3Float64 results[], size_t result_count
#define FRACTIONS fmi3UInt64 counters[], fmi3UInt64 resolutions[]
#define GIVEN_FRACTIONS const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]

static const char NO_DERIVATIVES[] = "derivatives are not offered";
static const char NO_DEPENDENCIES[] = "dependencies are in modelDescription.xml only";
static const char NO_STRUCTURE[] = "no parameter changes the structure";
static const char NO_EVENTS[] = "this FMU has no event mode";
static const char NO_CLOCKS[] = "this FMU has no clocks";

NOT_OFFERED(fmi3GetDirectionalDerivative, NO_DERIVATIVES, fmi3Instance c, DERIVATIVE_ARGUMENTS)
NOT_OFFERED(fmi3GetAdjointDerivative, NO_DERIVATIVES, fmi3Instance c, DERIVATIVE_ARGUMENTS)
NOT_OFFERED(fmi3GetOutputDerivatives, NO_DERIVATIVES, fmi3Instance c, REFERENCES, const fmi3Int32 orders[],
        fmi3Float64 values[], size_t value_count)

NOT_OFFERED(fmi3GetNumberOfVariableDependencies, NO_DEPENDENCIES, fmi3Instance c, fmi3ValueReference reference, size_t *count)
NOT_OFFERED(fmi3GetVariableDependencies, NO_DEPENDENCIES, fmi3Instance c, fmi3ValueReference reference, size_t elements[],
        fmi3ValueReference independents[], size_t independent_elements[], fmi3DependencyKind kinds[], size_t count)

NOT_OFFERED(fmi3EnterConfigurationMode, NO_STRUCTURE, fmi3Instance c)
NOT_OFFERED(fmi3ExitConfigurationMode, NO_STRUCTURE, fmi3Instance c)

NOT_OFFERED(fmi3EnterEventMode, NO_EVENTS, fmi3Instance c)
NOT_OFFERED(fmi3EnterStepMode, NO_EVENTS, fmi3Instance c)
NOT_OFFERED(fmi3EvaluateDiscreteStates, NO_EVENTS, fmi3Instance c)
NOT_OFFERED(fmi3UpdateDiscreteStates, NO_EVENTS, fmi3Instance c, fmi3Boolean *again, fmi3Boolean *terminate,
        fmi3Boolean *nominals, fmi3Boolean *values, fmi3Boolean *next_given, fmi3Float64 *next)

NOT_OFFERED(fmi3GetIntervalDecimal, NO_CLOCKS, fmi3Instance c, REFERENCES, fmi3Float64 intervals[],
        fmi3IntervalQualifier qualifiers[])
NOT_OFFERED(fmi3GetIntervalFraction, NO_CLOCKS, fmi3Instance c, REFERENCES, FRACTIONS, fmi3IntervalQualifier qualifiers[])
NOT_OFFERED(fmi3GetShiftDecimal, NO_CLOCKS, fmi3Instance c, REFERENCES, fmi3Float64 shifts[])
NOT_OFFERED(fmi3GetShiftFraction, NO_CLOCKS, fmi3Instance c, REFERENCES, FRACTIONS)
NOT_OFFERED(fmi3SetIntervalDecimal, NO_CLOCKS, fmi3Instance c, REFERENCES, const fmi3Float64 intervals[])
NOT_OFFERED(fmi3SetIntervalFraction, NO_CLOCKS, fmi3Instance c, REFERENCES, GIVEN_FRACTIONS)
NOT_OFFERED(fmi3SetShiftDecimal, NO_CLOCKS, fmi3Instance c, REFERENCES, const fmi3Float64 shifts[])
NOT_OFFERED(fmi3SetShiftFraction, NO_CLOCKS, fmi3Instance c, REFERENCES, GIVEN_FRACTIONS)
NOT_OFFERED(fmi3ActivateModelPartition, NO_CLOCKS, fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time)

NOT_OFFERED(fmi3EnterContinuousTimeMode, COSIMULATION_ONLY, fmi3Instance c)
NOT_OFFERED(fmi3CompletedIntegratorStep, COSIMULATION_ONLY, fmi3Instance c, fmi3Boolean no_set_state_prior, fmi3Boolean *event_needed,
        fmi3Boolean *terminate)
NOT_OFFERED(fmi3SetTime, COSIMULATION_ONLY, fmi3Instance c, fmi3Float64 time)
NOT_OFFERED(fmi3SetContinuousStates, COSIMULATION_ONLY, fmi3Instance c, const fmi3Float64 states[], size_t count)
NOT_OFFERED(fmi3GetContinuousStateDerivatives, COSIMULATION_ONLY, fmi3Instance c, fmi3Float64 derivatives[], size_t count)
NOT_OFFERED(fmi3GetEventIndicators, COSIMULATION_ONLY, fmi3Instance c, fmi3Float64 indicators[], size_t count)
NOT_OFFERED(fmi3GetContinuousStates, COSIMULATION_ONLY, fmi3Instance c, fmi3Float64 states[], size_t count)
NOT_OFFERED(fmi3GetNominalsOfContinuousStates, COSIMULATION_ONLY, fmi3Instance c, fmi3Float64 nominals[], size_t count)
NOT_OFFERED(fmi3GetNumberOfEventIndicators, COSIMULATION_ONLY, fmi3Instance c, size_t *count)
NOT_OFFERED(fmi3GetNumberOfContinuousStates, COSIMULATION_ONLY, fmi3Instance c, size_t *count)
