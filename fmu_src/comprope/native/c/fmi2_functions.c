/* The life of an instance and its steps in FMI 2.0, each function a thin skin around one of `Run`. */

#include "fmi2Functions.h"
#include "instance.h"

#include <math.h>

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void)
{
    return fmi2Version;
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[])
{
    (void)on, (void)count, (void)categories; /* there is nothing but errors to log, and those are always told */
    return instance_called(c) ? fmi2OK : fmi2Error;
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_given, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean stop_given, fmi2Real stop)
{
    Instance *instance = instance_called(c);
    (void)tolerance_given, (void)tolerance; /* accuracy is the affair of the model's own parameters */
    return instance ? instance_finish(instance, run_plan(&instance->run, start, stop_given ? stop : INFINITY))
                    : fmi2Error;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    Instance *instance = instance_called(c);
    return instance ? instance_finish(instance, run_enter(&instance->run)) : fmi2Error;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    Instance *instance = instance_called(c);
    return instance ? instance_finish(instance, run_begin(&instance->run)) : fmi2Error;
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    Instance *instance = instance_called(c);
    return instance ? instance_finish(instance, run_terminate(&instance->run)) : fmi2Error;
}

fmi2Status fmi2Reset(fmi2Component c)
{
    Instance *instance = instance_called(c);
    if (!instance) {
        return fmi2Error;
    }
    run_reset(&instance->run);
    return fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real dt, fmi2Boolean keeps_no_state)
{
    Instance *instance = instance_called(c);
    (void)keeps_no_state;
    return instance ? instance_finish(instance, run_step(&instance->run, time, dt)) : fmi2Error;
}
