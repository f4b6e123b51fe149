/* One instance of the FMU as its importer knows it, and how errors get out, whichever version of FMI it is called by. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "cosimulation.h"

enum { INSTANCE_OK = 0, INSTANCE_ERROR = 3 }; /* as FMI 2.0 and FMI 3.0 have them */

/* Where sentences go: `send` knows of which type the importer's logger is. */
typedef struct Log {
    void (*send)(const struct Log *log, const char *name, const char *sentence);
    void (*logger)(void);
    void *environment;
} Log;

typedef struct {
    Run run;
    Log log;
    char name[256];
} Instance;

/* A new instance; NULL, and the importer is told, if there is a reason `why` not or no memory. */
Instance *instance_new(const char *name, const char *why, Log log, Memory memory);
void instance_free(Instance *instance);

/* The instance, ready for a call; NULL if there is none. */
Instance *instance_called(void *component);

/* The end of every call: an error is told to the importer and puts the instance out of action. */
int instance_finish(Instance *instance, bool succeeded);

/* The end of a call that is an error in itself. */
int instance_refuse(Instance *instance, const char *why);

#endif
