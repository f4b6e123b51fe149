/* Saved states in FMI 2.0, each function a thin skin around one of `state.h`. */

#include "fmi2Functions.h"
#include "instance.h"
#include "fmu_state.h"

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    Instance *instance = instance_called(c);
    if (!instance || !state) {
        return instance ? instance_refuse(instance, "no place for a state is given") : fmi2Error;
    }
    return instance_finish(instance, state_save(&instance->run, (State **)state));
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state)
{
    Instance *instance = instance_called(c);
    return instance ? instance_finish(instance, state_restore(&instance->run, state)) : fmi2Error;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    Instance *instance = instance_called(c);
    return instance ? instance_finish(instance, !state || state_free(&instance->run, (State **)state)) : fmi2Error;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    Instance *instance = instance_called(c);
    if (!instance || !size) {
        return instance ? instance_refuse(instance, "no place for a size is given") : fmi2Error;
    }
    return instance_finish(instance, state_size(&instance->run, state, size));
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    Instance *instance = instance_called(c);
    if (!instance || !bytes) {
        return instance ? instance_refuse(instance, "no place for the bytes is given") : fmi2Error;
    }
    return instance_finish(instance, state_to_bytes(&instance->run, state, bytes, size));
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state)
{
    Instance *instance = instance_called(c);
    if (!instance || !bytes || !state) {
        return instance ? instance_refuse(instance, "bytes or a place for the state are missing") : fmi2Error;
    }
    return instance_finish(instance, state_from_bytes(&instance->run, bytes, size, (State **)state));
}
