/* Saved states in FMI 3.0, each function a thin skin around one of `state.h`. */

#include "fmi3Functions.h"
#include "instance.h"
#include "fmu_state.h"

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state)
{
    Instance *instance = instance_called(c);
    if (!instance || !state) {
        return instance ? instance_refuse(instance, "no place for a state is given") : fmi3Error;
    }
    return instance_finish(instance, state_save(&instance->run, (State **)state));
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state)
{
    Instance *instance = instance_called(c);
    return instance ? instance_finish(instance, state_restore(&instance->run, state)) : fmi3Error;
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state)
{
    Instance *instance = instance_called(c);
    return instance ? instance_finish(instance, !state || state_free(&instance->run, (State **)state)) : fmi3Error;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size)
{
    Instance *instance = instance_called(c);
    if (!instance || !size) {
        return instance ? instance_refuse(instance, "no place for a size is given") : fmi3Error;
    }
    return instance_finish(instance, state_size(&instance->run, state, size));
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size)
{
    Instance *instance = instance_called(c);
    if (!instance || !bytes) {
        return instance ? instance_refuse(instance, "no place for the bytes is given") : fmi3Error;
    }
    return instance_finish(instance, state_to_bytes(&instance->run, state, (char *)bytes, size));
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state)
{
    Instance *instance = instance_called(c);
    if (!instance || !bytes || !state) {
        return instance ? instance_refuse(instance, "bytes or a place for the state are missing") : fmi3Error;
    }
    return instance_finish(instance, state_from_bytes(&instance->run, (const char *)bytes, size, (State **)state));
}
