/* What FMI 2.0 has and this FMU does not, and how an instance stands. */

#include "fmi2Functions.h"
#include "instance.h"

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference references[], size_t count,
                                       const fmi2Integer orders[], const fmi2Real values[])
{
    Instance *instance = instance_called(c);
    (void)references, (void)count, (void)orders, (void)values;
    return instance ? instance_refuse(
                          instance,
                          "derivatives of inputs cannot be set; velocities and accelerations are inputs of their own")
                    : fmi2Error;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference references[], size_t count,
                                        const fmi2Integer orders[], fmi2Real values[])
{
    Instance *instance = instance_called(c);
    (void)references, (void)count, (void)orders, (void)values;
    return instance ? instance_refuse(instance, "derivatives of outputs are not offered") : fmi2Error;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t unknown_count,
                                        const fmi2ValueReference knowns[], size_t known_count, const fmi2Real changes[],
                                        fmi2Real results[])
{
    Instance *instance = instance_called(c);
    (void)unknowns, (void)unknown_count, (void)knowns, (void)known_count, (void)changes, (void)results;
    return instance ? instance_refuse(instance, "directional derivatives are not offered") : fmi2Error;
}

fmi2Status fmi2CancelStep(fmi2Component c)
{
    Instance *instance = instance_called(c);
    return instance ? instance_refuse(instance, "no step is under way: each call of fmi2DoStep ends with its step done")
                    : fmi2Error;
}

/* A question about the status that has no answer here is no error: FMI says to discard it. */
static fmi2Status no_answer(Instance *instance)
{
    return instance ? fmi2Discard : fmi2Error;
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value)
{
    (void)kind, (void)value;
    return no_answer(instance_called(c));
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    Instance *instance = instance_called(c);
    if (!instance || !value || kind != fmi2LastSuccessfulTime) {
        return no_answer(instance);
    }
    *value = instance->run.stand.time;
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value)
{
    (void)kind, (void)value;
    return no_answer(instance_called(c));
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    Instance *instance = instance_called(c);
    if (!instance || !value || kind != fmi2Terminated) {
        return no_answer(instance);
    }
    *value = fmi2False; /* a run ends when its importer says so */
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value)
{
    (void)kind, (void)value;
    return no_answer(instance_called(c));
}
