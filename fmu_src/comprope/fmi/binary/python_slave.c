/* The binary of an FMU that runs in Python: it finds Python, lets it load the code of the FMU, and forwards all calls. The
 * functions of the FMI themselves are those of the native FMUs, fmi2_functions.c.
 *
 * resources/load.py puts pointers to the functions of the FMI into FUNCTIONS (made by ctypes, see functions.py).
 * Python is the one that runs in this process already; else the library named by COMPROPE_LIBPYTHON; else that of
 * the first python3 in the PATH (on Windows: the first python3*.dll there). It is never unloaded: numpy cannot be loaded twice.
 */
#define _GNU_SOURCE
#include "fmi2Functions.h"

#include "calls.h"
#include "find_python.h"
#include "message.h"

#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum function { /* as functions.py lists them */
    INSTANTIATE, FREE_INSTANCE, SETUP_EXPERIMENT, ENTER_INITIALIZATION, EXIT_INITIALIZATION, DO_STEP, TERMINATE, RESET,
    GET_VALUES, SET_VALUES = GET_VALUES + STRING + 1, /* of each kind in turn */
    GET_STATE = SET_VALUES + STRING + 1, SET_STATE, FREE_STATE, STATE_SIZE, SERIALIZE_STATE, DESERIALIZE_STATE, LAST_TIME,
    REFUSE, FUNCTION_COUNT
};
enum { PATH_SIZE = 4096 };

static void *FUNCTIONS[FUNCTION_COUNT];
static const char LOADER[] = "load.py";

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
                 (unsigned long long)(uintptr_t)problem, MESSAGE_SIZE);
    }
    free(digits);
    return text;
}

static bool load(const char *uri, char problem[MESSAGE_SIZE])
{
    static atomic_flag starting = ATOMIC_FLAG_INIT;
    char resources[PATH_SIZE];
    Python python;

    if (!find_resources(uri, resources)) {
        snprintf(problem, MESSAGE_SIZE, "resources/%s is not found: the importer says %.1000s", LOADER, uri ? uri : "nothing");
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
        snprintf(problem, MESSAGE_SIZE,
                 "no Python is found; put one with the packages named in the FMU's documentation first in the PATH, or name its "
                 "library in the environment variable COMPROPE_LIBPYTHON");
        return false;
    }
    snprintf(problem, MESSAGE_SIZE, "resources/%s failed; the reason is on standard error", LOADER);
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
    char format[2 * MESSAGE_SIZE];
    if (!functions || !functions->logger) {
        fprintf(stderr, "%s\n", sentence);
        return;
    }
    message_as_format(sentence, format, sizeof format);
    functions->logger(functions->componentEnvironment, name ? name : "", fmi2Error, "logStatusError", format);
}

/* -- The calls of the FMI (see calls.h); fmi2_functions.c has the functions that lead here -- */

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging)
{
    char problem[MESSAGE_SIZE];
    if (!FUNCTIONS[INSTANTIATE] && !load(resources, problem)) {
        report(functions, name, problem);
        return NULL;
    }
    return ((fmi2InstantiateTYPE *)FUNCTIONS[INSTANTIATE])(name, type, guid, resources, functions, visible, logging);
}

void instance_free(void *component)
{
    if (FUNCTIONS[FREE_INSTANCE]) {
        ((void (*)(void *))FUNCTIONS[FREE_INSTANCE])(component);
    }
}

#define FORWARD(function, types, ...) \
    return FUNCTIONS[function] ? ((int(*) types)FUNCTIONS[function])(__VA_ARGS__) : STATUS_ERROR

int setup_experiment(void *component, double start, bool stop_defined, double stop)
{
    FORWARD(SETUP_EXPERIMENT, (void *, double, int, double), component, start, stop_defined, stop);
}

int enter_initialization(void *component)
{
    FORWARD(ENTER_INITIALIZATION, (void *), component);
}

int exit_initialization(void *component)
{
    FORWARD(EXIT_INITIALIZATION, (void *), component);
}

int do_step(void *component, double time, double dt)
{
    FORWARD(DO_STEP, (void *, double, double), component, time, dt);
}

int terminate(void *component)
{
    FORWARD(TERMINATE, (void *), component);
}

int reset(void *component)
{
    FORWARD(RESET, (void *), component);
}

int last_time(void *component, double *time)
{
    FORWARD(LAST_TIME, (void *, double *), component, time);
}

int get_values(void *component, const ValueType *type, const unsigned references[], size_t count, void *values,
               size_t value_count)
{
    (void)value_count; /* no arrays in FMI 2.0 */
    FORWARD(GET_VALUES + type->kind, (void *, const unsigned *, size_t, void *), component, references, count, values);
}

int set_values(void *component, const ValueType *type, const unsigned references[], size_t count, const void *values,
               size_t value_count)
{
    (void)value_count;
    FORWARD(SET_VALUES + type->kind, (void *, const unsigned *, size_t, const void *), component, references, count, values);
}

int save_state(void *component, void **state)
{
    FORWARD(GET_STATE, (void *, void **), component, state);
}

int restore_state(void *component, const void *state)
{
    FORWARD(SET_STATE, (void *, const void *), component, state);
}

int free_state(void *component, void **state)
{
    FORWARD(FREE_STATE, (void *, void **), component, state);
}

int serialized_size(void *component, const void *state, size_t *size)
{
    FORWARD(STATE_SIZE, (void *, const void *, size_t *), component, state, size);
}

int serialize_state(void *component, const void *state, void *bytes, size_t size)
{
    FORWARD(SERIALIZE_STATE, (void *, const void *, void *, size_t), component, state, bytes, size);
}

int deserialize_state(void *component, const void *bytes, size_t size, void **state)
{
    FORWARD(DESERIALIZE_STATE, (void *, const void *, size_t, void **), component, bytes, size, state);
}

int instance_refuse(void *component, const char *reason)
{
    FORWARD(REFUSE, (void *, const char *), component, reason);
}
