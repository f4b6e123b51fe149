/* The binary of an FMU that runs in Python: it finds Python, lets it load the code of the FMU, and forwards all calls.
 *
 * resources/load.py puts pointers to the functions of the FMI into FUNCTIONS (made by ctypes, see functions.py).
 * Python is the one that runs in this process already; else the library named by COMPROPE_LIBPYTHON; else that of
 * the first python3 in the PATH (on Windows: the first python3*.dll there). It is never unloaded: numpy cannot be loaded twice.
 */
#define _GNU_SOURCE
#include "fmi2Functions.h"
#include "find_python.h"

#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum function { /* as functions.py lists them */
    INSTANTIATE, FREE_INSTANCE, SETUP_EXPERIMENT, ENTER_INITIALIZATION, EXIT_INITIALIZATION, DO_STEP, TERMINATE, RESET,
    GET_REAL, GET_INTEGER, GET_BOOLEAN, GET_STRING, SET_REAL, SET_INTEGER, SET_BOOLEAN, SET_STRING,
    GET_STATE, SET_STATE, FREE_STATE, STATE_SIZE, SERIALIZE_STATE, DESERIALIZE_STATE, LAST_TIME, REFUSE,
    FUNCTION_COUNT
};
enum { PATH_SIZE = 4096, PROBLEM_SIZE = 2048 };

static void *FUNCTIONS[FUNCTION_COUNT];
static const char LOADER[] = "load.py";

#define CALL(function, type) ((type *)FUNCTIONS[function])
#define FORWARD(function, type, ...) \
    return FUNCTIONS[function] ? CALL(function, type)(__VA_ARGS__) : fmi2Error

/* -- Where the FMU is unpacked -- */

static int hex_digit(char c)
{
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* The path of a file URI, percent-encoded or, as some importers write it, not; a plain path stays as it is. */
static void path_of_uri(const char *uri, bool decode, char path[PATH_SIZE])
{
    size_t length = 0;
    if (!strncmp(uri, "file:", 5)) {
        uri += 5;
        if (!strncmp(uri, "//localhost/", 12)) {
            uri += 11;
        } else if (!strncmp(uri, "///", 3)) {
            uri += 2;
        }
#ifdef _WIN32
        if (uri[0] == '/' && uri[1] && (uri[2] == ':' || uri[2] == '|')) {
            uri++;
        }
#endif
    }
    for (; *uri && length < PATH_SIZE - 1; uri++) {
        const int high = decode && *uri == '%' ? hex_digit(uri[1]) : -1;
        const int low = high >= 0 ? hex_digit(uri[2]) : -1;
        path[length++] = low >= 0 ? (char)(16 * high + low) : *uri;
        uri += low >= 0 ? 2 : 0;
    }
    while (length > 1 && (path[length - 1] == '/' || path[length - 1] == '\\')) {
        length--;
    }
    path[length] = '\0';
}

static bool has_loader(const char *folder)
{
    char file[PATH_SIZE + sizeof LOADER + 1];
    snprintf(file, sizeof file, "%s/%s", folder, LOADER);
    return file_exists(file);
}

/* The folder `resources`: as the importer says, else two levels above this binary. */
static bool find_resources(const char *uri, char folder[PATH_SIZE])
{
    for (int decode = 1; uri && decode >= 0; decode--) {
        path_of_uri(uri, decode, folder);
        if (has_loader(folder)) {
            return true;
        }
    }
    if (!path_of_this_binary(folder, PATH_SIZE)) {
        return false;
    }
    for (int level = 0; level < 3; level++) { /* file, linux64, binaries */
        char *end = folder + strlen(folder);
        while (end > folder && *end != '/' && *end != '\\') {
            end--;
        }
        *end = '\0';
    }
    strncat(folder, "/resources", PATH_SIZE - strlen(folder) - 1);
    return has_loader(folder);
}

/* -- Loading the code of the FMU -- */

/* The statements that run load.py; the path is in hexadecimal digits, since it may hold anything. */
static char *loading_statements(const char *resources, char *problem)
{
    static const char FORM[] =
        "import os\n"
        "_r = os.fsdecode(bytes.fromhex('%s'))\n"
        "_f = os.path.join(_r, '%s')\n"
        "with open(_f, 'rb') as _o: _c = compile(_o.read(), _f, 'exec')\n"
        "exec(_c, {'__name__': 'load', 'RESOURCES': _r, 'TABLE': %llu, 'PROBLEM': %llu, 'PROBLEM_SIZE': %d})\n";
    const size_t length = strlen(resources), size = sizeof FORM + sizeof LOADER + 2 * length + 64;
    char *digits = malloc(2 * length + 1), *text = malloc(size);
    if (digits && text) {
        for (size_t k = 0; k < length; k++) {
            snprintf(digits + 2 * k, 3, "%02x", (unsigned char)resources[k]);
        }
        digits[2 * length] = '\0';
        snprintf(text, size, FORM, digits, LOADER, (unsigned long long)(uintptr_t)FUNCTIONS,
                 (unsigned long long)(uintptr_t)problem, PROBLEM_SIZE);
    }
    free(digits);
    return text;
}

static bool load(const char *uri, char problem[PROBLEM_SIZE])
{
    static atomic_flag starting = ATOMIC_FLAG_INIT;
    char resources[PATH_SIZE];
    Python python;

    if (!find_resources(uri, resources)) {
        snprintf(problem, PROBLEM_SIZE, "resources/%s is not found: the importer says %.1000s", LOADER, uri ? uri : "nothing");
        return false;
    }
    while (atomic_flag_test_and_set(&starting)) {
    }
    const bool found = find_python(&python);
    if (found && !python.is_initialized()) {
        python.initialize(0);
        python.save_thread();
    }
    atomic_flag_clear(&starting);
    if (!found) {
        snprintf(problem, PROBLEM_SIZE,
                 "no Python is found; put one with the packages named in the FMU's documentation first in the PATH, or name its "
                 "library in the environment variable COMPROPE_LIBPYTHON");
        return false;
    }
    snprintf(problem, PROBLEM_SIZE, "resources/%s failed; the reason is on standard error", LOADER);
    char *statements = loading_statements(resources, problem);
    if (statements) {
        const int lock = python.ensure();
        python.run(statements, NULL);
        python.release(lock);
        free(statements);
    }
    return FUNCTIONS[INSTANTIATE] != NULL;
}

/* Report a sentence to the importer, whose logger takes it as a format; without a logger, on standard error. */
static void report(const fmi2CallbackFunctions *functions, const char *name, const char *sentence)
{
    char format[2 * PROBLEM_SIZE];
    size_t length = 0;

    if (!functions || !functions->logger) {
        fprintf(stderr, "%s\n", sentence);
        return;
    }
    for (; *sentence && length < sizeof format - 2; sentence++) {
        format[length++] = *sentence;
        if (*sentence == '%') {
            format[length++] = '%';
        }
    }
    format[length] = '\0';
    functions->logger(functions->componentEnvironment, name ? name : "", fmi2Error, "logStatusError", format);
}

/* -- The functions of FMI 2.0 -- */

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
    (void)on, (void)count, (void)categories; /* only errors are logged, and those always */
    return c ? fmi2OK : fmi2Error;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging)
{
    char problem[PROBLEM_SIZE];
    if (!FUNCTIONS[INSTANTIATE] && !load(resources, problem)) {
        report(functions, name, problem);
        return NULL;
    }
    return CALL(INSTANTIATE, fmi2InstantiateTYPE)(name, type, guid, resources, functions, visible, logging);
}

void fmi2FreeInstance(fmi2Component c)
{
    if (FUNCTIONS[FREE_INSTANCE]) {
        CALL(FREE_INSTANCE, fmi2FreeInstanceTYPE)(c);
    }
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean stop_defined, fmi2Real stop)
{
    FORWARD(SETUP_EXPERIMENT, fmi2SetupExperimentTYPE, c, tolerance_defined, tolerance, start, stop_defined, stop);
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    FORWARD(ENTER_INITIALIZATION, fmi2EnterInitializationModeTYPE, c);
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    FORWARD(EXIT_INITIALIZATION, fmi2ExitInitializationModeTYPE, c);
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real dt, fmi2Boolean no_set_state_prior)
{
    FORWARD(DO_STEP, fmi2DoStepTYPE, c, time, dt, no_set_state_prior);
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    FORWARD(TERMINATE, fmi2TerminateTYPE, c);
}

fmi2Status fmi2Reset(fmi2Component c)
{
    FORWARD(RESET, fmi2ResetTYPE, c);
}

#define GETTER_AND_SETTER(Type, NAME)                                                                 \
    fmi2Status fmi2Get##Type(fmi2Component c, const fmi2ValueReference references[], size_t count,    \
                             fmi2##Type values[])                                                     \
    {                                                                                                 \
        FORWARD(GET_##NAME, fmi2Get##Type##TYPE, c, references, count, values);                       \
    }                                                                                                 \
    fmi2Status fmi2Set##Type(fmi2Component c, const fmi2ValueReference references[], size_t count,    \
                             const fmi2##Type values[])                                               \
    {                                                                                                 \
        FORWARD(SET_##NAME, fmi2Set##Type##TYPE, c, references, count, values);                       \
    }

GETTER_AND_SETTER(Real, REAL)
GETTER_AND_SETTER(Integer, INTEGER)
GETTER_AND_SETTER(Boolean, BOOLEAN)
GETTER_AND_SETTER(String, STRING)

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    FORWARD(GET_STATE, fmi2GetFMUstateTYPE, c, state);
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state)
{
    FORWARD(SET_STATE, fmi2SetFMUstateTYPE, c, state);
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    FORWARD(FREE_STATE, fmi2FreeFMUstateTYPE, c, state);
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    FORWARD(STATE_SIZE, fmi2SerializedFMUstateSizeTYPE, c, state, size);
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    FORWARD(SERIALIZE_STATE, fmi2SerializeFMUstateTYPE, c, state, bytes, size);
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state)
{
    FORWARD(DESERIALIZE_STATE, fmi2DeSerializeFMUstateTYPE, c, bytes, size, state);
}

/* -- What this FMU does not offer -- */

typedef fmi2Status RefuseType(fmi2Component c, const char *reason);

static fmi2Status refuse(fmi2Component c, const char *reason)
{
    FORWARD(REFUSE, RefuseType, c, reason);
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference references[], size_t count,
                                       const fmi2Integer orders[], const fmi2Real values[])
{
    (void)references, (void)count, (void)orders, (void)values;
    return refuse(c, "derivatives of inputs cannot be set; velocities and accelerations are inputs of their own");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference references[], size_t count,
                                        const fmi2Integer orders[], fmi2Real values[])
{
    (void)references, (void)count, (void)orders, (void)values;
    return refuse(c, "derivatives of outputs are not offered");
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t unknown_count,
                                        const fmi2ValueReference knowns[], size_t known_count, const fmi2Real changes[],
                                        fmi2Real results[])
{
    (void)unknowns, (void)unknown_count, (void)knowns, (void)known_count, (void)changes, (void)results;
    return refuse(c, "directional derivatives are not offered");
}

fmi2Status fmi2CancelStep(fmi2Component c)
{
    return refuse(c, "no step is in progress: each call of fmi2DoStep returns when its step is done");
}

/* -- Status; what cannot be answered is no error: FMI says to discard it -- */

static fmi2Status no_answer(fmi2Component c)
{
    return c ? fmi2Discard : fmi2Error;
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value)
{
    (void)kind, (void)value;
    return no_answer(c);
}

typedef fmi2Status LastTimeType(fmi2Component c, fmi2Real *time);

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    if (!c || !value || kind != fmi2LastSuccessfulTime) {
        return no_answer(c);
    }
    FORWARD(LAST_TIME, LastTimeType, c, value);
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value)
{
    (void)kind, (void)value;
    return no_answer(c);
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    if (!c || !value || kind != fmi2Terminated) {
        return no_answer(c);
    }
    *value = fmi2False; /* only the importer ends a simulation */
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value)
{
    (void)kind, (void)value;
    return no_answer(c);
}
