/* Instances in FMI 2.0: the importer brings a logger and, if it wants, memory. */

#include "fmi2Functions.h"
#include "instance.h"

#include <stdlib.h>

_Static_assert((int)fmi2OK == INSTANCE_OK && (int)fmi2Error == INSTANCE_ERROR, "statuses are FMI's own");

/* The logger takes the sentence as a format, in which a percent sign stands twice. */
static void send(const Log *log, const char *name, const char *sentence)
{
    char format[2 * TEXT_SIZE];
    size_t length = 0;

    if (!log->logger) {
        return;
    }
    for (; *sentence && length < sizeof format - 2; sentence++) {
        format[length++] = *sentence;
        if (*sentence == '%') {
            format[length++] = '%';
        }
    }
    format[length] = '\0';
    ((fmi2CallbackLogger)log->logger)(log->environment, name, fmi2Error, "logStatusError", format);
}

static Memory memory_of(const fmi2CallbackFunctions *functions)
{
    if (functions->allocateMemory && functions->freeMemory) {
        return (Memory){functions->allocateMemory, functions->freeMemory};
    }
    return (Memory){calloc, free};
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging)
{
    (void)resources, (void)visible, (void)logging;
    if (!functions) {
        return NULL;
    }
    const char *why = type != fmi2CoSimulation ? "this FMU is for co-simulation only"
                      : !guid || strcmp(guid, MODEL_GUID)
                          ? "the GUID is not this FMU's: binary and modelDescription.xml do not belong together"
                          : NULL;
    const Log log = {send, (void (*)(void))functions->logger, functions->componentEnvironment};
    return instance_new(name, why, log, memory_of(functions));
}

void fmi2FreeInstance(fmi2Component c)
{
    instance_free(c);
}
