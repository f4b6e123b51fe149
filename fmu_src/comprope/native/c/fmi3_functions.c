/* The life of an instance and its steps in FMI 3.0, each function a thin skin around one of `Run`. */

#include "fmi3Functions.h"
#include "instance.h"

#include <math.h>

const char *fmi3GetVersion(void)
{
    return fmi3Version;
}

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t count, const fmi3String categories[])
{
    (void)on, (void)count, (void)categories; /* there is nothing but errors to log, and those are always told */
    return instance_called(c) ? fmi3OK : fmi3Error;
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerance_given, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean stop_given, fmi3Float64 stop)
{
    Instance *instance = instance_called(c);
    (void)tolerance_given, (void)tolerance; /* accuracy is the affair of the model's own parameters */
    if (!instance) {
        return fmi3Error;
    }
    Run *run = &instance->run;
    return instance_finish(instance, run_plan(run, start, stop_given ? stop : INFINITY) && run_enter(run));
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    Instance *instance = instance_called(c);
    return instance ? instance_finish(instance, run_begin(&instance->run)) : fmi3Error;
}

fmi3Status fmi3Terminate(fmi3Instance c)
{
    Instance *instance = instance_called(c);
    return instance ? instance_finish(instance, run_terminate(&instance->run)) : fmi3Error;
}

fmi3Status fmi3Reset(fmi3Instance c)
{
    Instance *instance = instance_called(c);
    if (!instance) {
        return fmi3Error;
    }
    run_reset(&instance->run);
    return fmi3OK;
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 dt, fmi3Boolean keeps_no_state,
                      fmi3Boolean *event_needed, fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *reached)
{
    Instance *instance = instance_called(c);
    (void)keeps_no_state;
    if (!instance || !event_needed || !terminate || !early || !reached) {
        return instance ? instance_refuse(instance, "places for what a step tells are missing") : fmi3Error;
    }
    *event_needed = *terminate = *early = fmi3False; /* a run ends when its importer says so */
    const bool succeeded = run_step(&instance->run, time, dt);
    *reached = instance->run.stand.time;
    return instance_finish(instance, succeeded);
}
