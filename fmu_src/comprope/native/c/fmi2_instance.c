/* The instance of a native FMU for FMI 2.0, with its logger and its memory. */

#include "fmi2Functions.h"

#include "instance.h"

#include <stdlib.h>
#include <string.h>

/* The importer's logger takes the sentence as a format. */
static void send(const Logger *logger, const char *instance_name, const char *sentence)
{
    char format[2 * MESSAGE_SIZE];
    if (logger->callback) {
        message_as_format(sentence, format, sizeof format);
        ((fmi2CallbackLogger)logger->callback)(logger->environment, instance_name, fmi2Error, "logStatusError", format);
    }
}

static Allocator allocator_of(const fmi2CallbackFunctions *functions)
{
    if (functions->allocateMemory && functions->freeMemory) {
        return (Allocator){functions->allocateMemory, functions->freeMemory};
    }
    return (Allocator){calloc, free};
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging)
{
    (void)resources, (void)visible, (void)logging;
    if (!functions) {
        return NULL;
    }
    const char *refusal = type != fmi2CoSimulation ? "this FMU is for co-simulation only"
                          : !guid || strcmp(guid, MODEL_GUID)
                              ? "the GUID is not this FMU's: binary and modelDescription.xml do not belong together"
                              : NULL;
    const Logger logger = {send, (void (*)(void))functions->logger, functions->componentEnvironment};
    return instance_create(name, refusal, logger, allocator_of(functions));
}
