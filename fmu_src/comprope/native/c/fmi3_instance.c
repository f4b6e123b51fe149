/* Instances in FMI 3.0: for co-simulation only. */

#include "fmi3Functions.h"
#include "instance.h"

#include <stdlib.h>

_Static_assert((int)fmi3OK == INSTANCE_OK && (int)fmi3Error == INSTANCE_ERROR, "statuses are FMI's own");

static const Memory OWN = {calloc, free};

static void send(const Log *log, const char *name, const char *sentence)
{
    (void)name; /* the environment tells the importer which instance it is */
    if (log->logger) {
        ((fmi3LogMessageCallback)log->logger)(log->environment, fmi3Error, "logStatusError", sentence);
    }
}

static Log log_of(fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger)
{
    return (Log){send, (void (*)(void))logger, environment};
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                         fmi3Boolean logging, fmi3Boolean events, fmi3Boolean early,
                                         const fmi3ValueReference intermediate[], size_t count,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                         fmi3IntermediateUpdateCallback update)
{
    (void)resources, (void)visible, (void)logging, (void)early, (void)intermediate, (void)update;
    const char *why = !token || strcmp(token, MODEL_TOKEN)
                          ? "the instantiation token is not this FMU's: binary and modelDescription.xml do not belong together"
                      : events ? "this FMU has no event mode"
                      : count  ? "this FMU tells nothing between the ends of steps"
                               : NULL;
    return instance_new(name, why, log_of(environment, logger), OWN);
}

static fmi3Instance refused(fmi3String name, fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger)
{
    return instance_new(name, "this FMU is for co-simulation only", log_of(environment, logger), OWN);
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                          fmi3Boolean logging, fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback logger)
{
    (void)token, (void)resources, (void)visible, (void)logging;
    return refused(name, environment, logger);
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resources,
                                               fmi3Boolean visible, fmi3Boolean logging,
                                               fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
                                               fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock,
                                               fmi3UnlockPreemptionCallback unlock)
{
    (void)token, (void)resources, (void)visible, (void)logging, (void)update, (void)lock, (void)unlock;
    return refused(name, environment, logger);
}

void fmi3FreeInstance(fmi3Instance c)
{
    instance_free(c);
}
