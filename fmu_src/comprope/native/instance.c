#include "instance.h"

#include <stdio.h>
#include <stdlib.h>

/* The logger takes the sentence as a format, in which a percent sign stands twice. */
void instance_send(const fmi2CallbackFunctions *functions, const char *name, const char *sentence)
{
    char format[2 * TEXT_SIZE];
    size_t length = 0;

    if (!functions->logger) {
        return;
    }
    for (; *sentence && length < sizeof format - 2; sentence++) {
        format[length++] = *sentence;
        if (*sentence == '%') {
            format[length++] = '%';
        }
    }
    format[length] = '\0';
    functions->logger(functions->componentEnvironment, name, fmi2Error, "logStatusError", format);
}

Instance *instance_called(fmi2Component component)
{
    Instance *instance = component;
    if (instance) {
        text_clear(&instance->run.problems);
    }
    return instance;
}

fmi2Status instance_finish(Instance *instance, bool succeeded)
{
    Stand *stand = &instance->run.stand;
    Text text;

    if (succeeded) {
        return fmi2OK;
    }
    if (!stand->failed) {
        stand->failed = 1;
        snprintf(stand->failure, sizeof stand->failure, "%s", instance->run.problems.chars);
    }
    text_clear(&text);
    text_add(&text, "%s '%s' at t = %.9g s: %s", MODEL_NAME, instance->name, stand->time, instance->run.problems.chars);
    instance_send(&instance->functions, instance->name, text.chars);
    return fmi2Error;
}

fmi2Status instance_refuse(Instance *instance, const char *why)
{
    text_add(&instance->run.problems, "%s", why);
    return instance_finish(instance, false);
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
    const char *why = NULL;
    (void)resources, (void)visible, (void)logging;
    if (!functions) {
        return NULL;
    }
    why = !name || !*name            ? "an instance needs a name"
          : type != fmi2CoSimulation ? "this FMU is for co-simulation only"
          : !guid || strcmp(guid, MODEL_GUID)
              ? "the GUID is not this FMU's: binary and modelDescription.xml do not belong together"
              : NULL;
    const Memory memory = memory_of(functions);
    Instance *instance = why ? NULL : take_zeros(memory, sizeof *instance);
    if (!why && (!instance || !run_create(&instance->run, memory))) {
        why = "no memory for one more instance";
    }
    if (why) {
        instance_send(functions, name ? name : "", why);
        if (instance) {
            memory.give_back(instance);
        }
        return NULL;
    }
    instance->functions = *functions;
    snprintf(instance->name, sizeof instance->name, "%s", name);
    return instance;
}

void fmi2FreeInstance(fmi2Component c)
{
    Instance *instance = c;
    if (instance) {
        const Memory memory = instance->run.memory;
        run_free(&instance->run);
        memory.give_back(instance);
    }
}
