/* What FMI 3.0 has and this FMU does not; the standard wants every function there. */

#include "fmi3Functions.h"
#include "instance.h"

#define REFUSED(function, why, ...)                                   \
    fmi3Status function(__VA_ARGS__)                                  \
    {                                                                 \
        Instance *instance = instance_called(c);                      \
        return instance ? instance_refuse(instance, why) : fmi3Error; \
    }
#define REFERENCES const fmi3ValueReference references[], size_t count
#define DERIVATIVE_ARGUMENTS                                                                             \
    const fmi3ValueReference unknowns[], size_t unknown_count, const fmi3ValueReference knowns[],        \
        size_t known_count, const fmi3Float64 seeds[], size_t seed_count, fmi3Float64 results[], size_t result_count
#define FRACTIONS fmi3UInt64 counters[], fmi3UInt64 resolutions[]
#define GIVEN_FRACTIONS const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]

static const char NO_DERIVATIVES[] = "derivatives are not offered";
static const char NO_DEPENDENCIES[] = "dependencies stand in modelDescription.xml only";
static const char NO_STRUCTURE[] = "no parameter changes the structure";
static const char NO_EVENTS[] = "this FMU has no event mode";
static const char NO_CLOCKS[] = "this FMU has no clocks";
static const char NO_EXCHANGE[] = "this FMU is for co-simulation only";

REFUSED(fmi3GetDirectionalDerivative, NO_DERIVATIVES, fmi3Instance c, DERIVATIVE_ARGUMENTS)
REFUSED(fmi3GetAdjointDerivative, NO_DERIVATIVES, fmi3Instance c, DERIVATIVE_ARGUMENTS)
REFUSED(fmi3GetOutputDerivatives, NO_DERIVATIVES, fmi3Instance c, REFERENCES, const fmi3Int32 orders[],
        fmi3Float64 values[], size_t value_count)

REFUSED(fmi3GetNumberOfVariableDependencies, NO_DEPENDENCIES, fmi3Instance c, fmi3ValueReference reference, size_t *count)
REFUSED(fmi3GetVariableDependencies, NO_DEPENDENCIES, fmi3Instance c, fmi3ValueReference reference, size_t elements[],
        fmi3ValueReference independents[], size_t independent_elements[], fmi3DependencyKind kinds[], size_t count)

REFUSED(fmi3EnterConfigurationMode, NO_STRUCTURE, fmi3Instance c)
REFUSED(fmi3ExitConfigurationMode, NO_STRUCTURE, fmi3Instance c)

REFUSED(fmi3EnterEventMode, NO_EVENTS, fmi3Instance c)
REFUSED(fmi3EnterStepMode, NO_EVENTS, fmi3Instance c)
REFUSED(fmi3EvaluateDiscreteStates, NO_EVENTS, fmi3Instance c)
REFUSED(fmi3UpdateDiscreteStates, NO_EVENTS, fmi3Instance c, fmi3Boolean *again, fmi3Boolean *terminate,
        fmi3Boolean *nominals, fmi3Boolean *values, fmi3Boolean *next_given, fmi3Float64 *next)

REFUSED(fmi3GetIntervalDecimal, NO_CLOCKS, fmi3Instance c, REFERENCES, fmi3Float64 intervals[],
        fmi3IntervalQualifier qualifiers[])
REFUSED(fmi3GetIntervalFraction, NO_CLOCKS, fmi3Instance c, REFERENCES, FRACTIONS, fmi3IntervalQualifier qualifiers[])
REFUSED(fmi3GetShiftDecimal, NO_CLOCKS, fmi3Instance c, REFERENCES, fmi3Float64 shifts[])
REFUSED(fmi3GetShiftFraction, NO_CLOCKS, fmi3Instance c, REFERENCES, FRACTIONS)
REFUSED(fmi3SetIntervalDecimal, NO_CLOCKS, fmi3Instance c, REFERENCES, const fmi3Float64 intervals[])
REFUSED(fmi3SetIntervalFraction, NO_CLOCKS, fmi3Instance c, REFERENCES, GIVEN_FRACTIONS)
REFUSED(fmi3SetShiftDecimal, NO_CLOCKS, fmi3Instance c, REFERENCES, const fmi3Float64 shifts[])
REFUSED(fmi3SetShiftFraction, NO_CLOCKS, fmi3Instance c, REFERENCES, GIVEN_FRACTIONS)
REFUSED(fmi3ActivateModelPartition, NO_CLOCKS, fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time)

REFUSED(fmi3EnterContinuousTimeMode, NO_EXCHANGE, fmi3Instance c)
REFUSED(fmi3CompletedIntegratorStep, NO_EXCHANGE, fmi3Instance c, fmi3Boolean keeps_no_state, fmi3Boolean *event_needed,
        fmi3Boolean *terminate)
REFUSED(fmi3SetTime, NO_EXCHANGE, fmi3Instance c, fmi3Float64 time)
REFUSED(fmi3SetContinuousStates, NO_EXCHANGE, fmi3Instance c, const fmi3Float64 states[], size_t count)
REFUSED(fmi3GetContinuousStateDerivatives, NO_EXCHANGE, fmi3Instance c, fmi3Float64 derivatives[], size_t count)
REFUSED(fmi3GetEventIndicators, NO_EXCHANGE, fmi3Instance c, fmi3Float64 indicators[], size_t count)
REFUSED(fmi3GetContinuousStates, NO_EXCHANGE, fmi3Instance c, fmi3Float64 states[], size_t count)
REFUSED(fmi3GetNominalsOfContinuousStates, NO_EXCHANGE, fmi3Instance c, fmi3Float64 nominals[], size_t count)
REFUSED(fmi3GetNumberOfEventIndicators, NO_EXCHANGE, fmi3Instance c, size_t *count)
REFUSED(fmi3GetNumberOfContinuousStates, NO_EXCHANGE, fmi3Instance c, size_t *count)
