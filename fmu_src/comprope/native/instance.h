/* One instance of the FMU as its importer knows it, and how errors get out. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "fmi2Functions.h"
#include "run.h"

typedef struct {
    Run run;
    fmi2CallbackFunctions functions;
    char name[256];
} Instance;

/* The instance, ready for a call; NULL if there is none. */
Instance *instance_called(fmi2Component component);

/* The end of every call: an error is told to the importer and puts the instance out of action. */
fmi2Status instance_finish(Instance *instance, bool succeeded);

/* The end of a call that is an error in itself. */
fmi2Status instance_refuse(Instance *instance, const char *why);

/* Hand a sentence to the importer. */
void instance_send(const fmi2CallbackFunctions *functions, const char *name, const char *sentence);

#endif
