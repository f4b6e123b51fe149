/* A host without Python: loads a binary, makes nine steps and prints the first real output. */
#include <dlfcn.h>
#include <stdio.h>

#include "fmi2FunctionTypes.h"

static void log_message(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                        fmi2String message, ...)
{
    (void)environment, (void)name, (void)status, (void)category;
    fprintf(stderr, "%s\n", message);
}

#define FUNCTION(name) name##TYPE *name = (name##TYPE *)dlsym(library, #name)

int main(int count, char **arguments)
{
    const fmi2CallbackFunctions callbacks = {log_message, NULL, NULL, NULL, NULL};
    const fmi2ValueReference place = 7; /* of the toy's output */
    double value = 0.0;
    void *library = count == 4 ? dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL) : NULL;
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        return 1;
    }
    FUNCTION(fmi2Instantiate);
    FUNCTION(fmi2EnterInitializationMode);
    FUNCTION(fmi2ExitInitializationMode);
    FUNCTION(fmi2DoStep);
    FUNCTION(fmi2GetReal);
    FUNCTION(fmi2FreeInstance);
    fmi2Component one = fmi2Instantiate("one", fmi2CoSimulation, arguments[2], arguments[3], &callbacks, 0, 0);
    if (!one || fmi2EnterInitializationMode(one) || fmi2ExitInitializationMode(one)) {
        return 2;
    }
    for (int k = 0; k < 9; k++) {
        if (fmi2DoStep(one, k * 0.01, 0.01, fmi2True)) {
            return 3;
        }
    }
    if (fmi2GetReal(one, &place, 1, &value)) {
        return 4;
    }
    fmi2FreeInstance(one);
    printf("%.17g\n", value);
    return 0;
}
