#include "instance.h"

#include <stdio.h>

Instance *instance_called(void *component)
{
    Instance *instance = component;
    if (instance) {
        text_clear(&instance->run.problems);
    }
    return instance;
}

int instance_finish(Instance *instance, bool succeeded)
{
    Stand *stand = &instance->run.stand;
    Text text;

    if (succeeded) {
        return INSTANCE_OK;
    }
    if (!stand->failed) {
        stand->failed = 1;
        snprintf(stand->failure, sizeof stand->failure, "%s", instance->run.problems.chars);
    }
    text_clear(&text);
    text_add(&text, "%s '%s' at t = %.9g s: %s", MODEL_NAME, instance->name, stand->time, instance->run.problems.chars);
    instance->log.send(&instance->log, instance->name, text.chars);
    return INSTANCE_ERROR;
}

int instance_refuse(Instance *instance, const char *why)
{
    text_add(&instance->run.problems, "%s", why);
    return instance_finish(instance, false);
}

Instance *instance_new(const char *name, const char *why, Log log, Memory memory)
{
    Instance *instance = NULL;

    if (!name || !*name) {
        why = "an instance needs a name";
    }
    if (!why) {
        instance = take_zeros(memory, sizeof *instance);
        why = instance && run_create(&instance->run, memory) ? NULL : "no memory for one more instance";
    }
    if (why) {
        log.send(&log, name ? name : "", why);
        if (instance) {
            memory.give_back(instance);
        }
        return NULL;
    }
    instance->log = log;
    snprintf(instance->name, sizeof instance->name, "%s", name);
    return instance;
}

void instance_free(Instance *instance)
{
    if (instance) {
        const Memory memory = instance->run.memory;
        run_free(&instance->run);
        memory.give_back(instance);
    }
}
