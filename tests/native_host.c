/* A host without Python for a co-simulation FMU, run by the tests and benchmarks.
 *
 *     native_host SCENARIO BINARY GUID CAR COUNTERWEIGHT MASS OUTPUT [NUMBER]
 *
 * CAR and COUNTERWEIGHT are value references of the ends' heights, MASS of a positive parameter, OUTPUT of a real
 * output. Each failed check is printed with its line, and the exit status is then 1. Memory that an instance
 * takes through the callbacks and does not give back counts as an error.
 */

#include "fmi2FunctionTypes.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
#define OPEN(path) ((void *)LoadLibraryA(path))
#define SYMBOL(library, name) ((void *)GetProcAddress((HMODULE)(library), name))
#define CLOSE(library) FreeLibrary((HMODULE)(library))
#else
#include <dlfcn.h>
#include <pthread.h>
#define OPEN(path) dlopen(path, RTLD_NOW | RTLD_LOCAL)
#define SYMBOL(library, name) dlsym(library, name)
#define CLOSE(library) dlclose(library)
#endif

/* clang-format off */
#define FUNCTIONS(X) \
    X(Instantiate) X(FreeInstance) X(SetupExperiment) X(EnterInitializationMode) X(ExitInitializationMode) X(Terminate) \
    X(Reset) X(DoStep) X(GetReal) X(SetReal) X(GetInteger) X(SetInteger) X(GetBoolean) X(SetBoolean) X(GetString) \
    X(SetString) X(GetFMUstate) X(SetFMUstate) X(FreeFMUstate) X(SerializedFMUstateSize) X(SerializeFMUstate) \
    X(DeSerializeFMUstate) X(GetRealStatus) X(CancelStep) X(SetRealInputDerivatives) X(GetRealOutputDerivatives) \
    X(GetDirectionalDerivative) X(SetDebugLogging) X(GetVersion)
/* clang-format on */

#define DECLARE(name) fmi2##name##TYPE *name;
typedef struct {
    void *library;
    FUNCTIONS(DECLARE)
} Fmu;

static struct {
    const char *path, *guid;
    fmi2ValueReference car, counterweight, mass, output;
    long number;
} given;

static int failures;
static _Atomic long taken, messages;

#define CHECK(condition) check(!!(condition), #condition, __LINE__)

static void check(int passed, const char *what, int line)
{
    if (!passed) {
        failures++;
        printf("line %d: not so: %s\n", line, what);
    }
}

/* Which allocation from now on fails; none if negative. */
static _Atomic long failing = -1;

static void *take(size_t count, size_t size)
{
    if (failing >= 0 && failing-- == 0) {
        return NULL;
    }
    taken++;
    return calloc(count, size);
}

static void give_back(void *memory)
{
    taken -= memory != NULL;
    free(memory);
}

static void hear(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status, fmi2String category,
                 fmi2String message, ...)
{
    (void)environment, (void)instance, (void)category;
    CHECK(status == fmi2Error && message && *message);
    messages++;
}

static const fmi2CallbackFunctions CALLBACKS = {hear, take, give_back, NULL, NULL};

static Fmu load(void)
{
    Fmu fmu;
    fmu.library = OPEN(given.path);
    if (!fmu.library) {
        printf("%s cannot be loaded\n", given.path);
        exit(1);
    }
#define FIND(name)                                           \
    *(void **)&fmu.name = SYMBOL(fmu.library, "fmi2" #name); \
    CHECK(fmu.name != NULL);
    FUNCTIONS(FIND)
    return fmu;
}

static fmi2Component made(const Fmu *fmu)
{
    fmi2Component one = fmu->Instantiate("one", fmi2CoSimulation, given.guid, "", &CALLBACKS, fmi2False, fmi2False);
    CHECK(one != NULL);
    return one;
}

static fmi2Component begun(const Fmu *fmu)
{
    fmi2Component one = made(fmu);
    CHECK(fmu->SetupExperiment(one, fmi2False, 0.0, 0.0, fmi2False, 0.0) == fmi2OK);
    CHECK(fmu->EnterInitializationMode(one) == fmi2OK);
    CHECK(fmu->ExitInitializationMode(one) == fmi2OK);
    return one;
}

/* Move the car up by steps of 10 ms; the counterweight mirrors it. */
static void ride(const Fmu *fmu, fmi2Component one, int first, int last)
{
    const fmi2ValueReference ends[] = {given.car, given.counterweight};
    for (int k = first; k < last; k++) {
        const double time = 0.01 * k, height = 0.3 * time * time;
        const fmi2Real values[] = {height, 50.0 - height};
        CHECK(fmu->SetReal(one, ends, 2, values) == fmi2OK);
        CHECK(fmu->DoStep(one, time, 0.01, fmi2True) == fmi2OK);
    }
}

static double output(const Fmu *fmu, fmi2Component one)
{
    fmi2Real value = NAN;
    CHECK(fmu->GetReal(one, &given.output, 1, &value) == fmi2OK);
    CHECK(isfinite(value));
    return value;
}

static void end(const Fmu *fmu, fmi2Component one)
{
    CHECK(fmu->Terminate(one) == fmi2OK);
    fmu->FreeInstance(one);
}

/* Load and unload many times, with a few instances each time. */
static void scenario_cycle(void)
{
    double first = 0.0;
    for (long k = 0; k < given.number; k++) {
        const Fmu fmu = load();
        fmi2Component many[3];
        for (int i = 0; i < 3; i++) {
            many[i] = begun(&fmu);
            ride(&fmu, many[i], 0, 5);
            first = k + i ? first : output(&fmu, many[i]);
            CHECK(output(&fmu, many[i]) == first);
        }
        for (int i = 0; i < 3; i++) {
            end(&fmu, many[i]);
        }
        CLOSE(fmu.library);
    }
    CHECK(messages == 0);
}

/* One ride of so many steps; where it gets to can be compared with other systems. */
static void scenario_ride(void)
{
    const Fmu fmu = load();
    fmi2Component one = begun(&fmu);
    ride(&fmu, one, 0, (int)given.number);
    printf("%.17g\n", output(&fmu, one));
    end(&fmu, one);
    CLOSE(fmu.library);
}

#ifndef _WIN32
typedef struct {
    const Fmu *fmu;
    double reached;
} Rider;

static void *ride_apart(void *argument)
{
    Rider *rider = argument;
    for (long k = 0; k < given.number; k++) {
        fmi2Component one = begun(rider->fmu);
        ride(rider->fmu, one, 0, 50);
        rider->reached = output(rider->fmu, one);
        end(rider->fmu, one);
    }
    return NULL;
}

/* Instances in several threads at once do not disturb each other. */
static void scenario_threads(void)
{
    enum { THREADS = 8 };
    const Fmu fmu = load();
    pthread_t threads[THREADS];
    Rider riders[THREADS];
    for (int i = 0; i < THREADS; i++) {
        riders[i].fmu = &fmu;
        CHECK(pthread_create(&threads[i], NULL, ride_apart, &riders[i]) == 0);
    }
    for (int i = 0; i < THREADS; i++) {
        pthread_join(threads[i], NULL);
        CHECK(riders[i].reached == riders[0].reached);
    }
    CLOSE(fmu.library);
}
#endif

/* Saved states: back and on again, in another instance by bytes, and what is no state. */
static void scenario_states(void)
{
    const Fmu fmu = load();
    fmi2Component one = begun(&fmu), other = made(&fmu);
    fmi2FMUstate state = NULL, copy = NULL;
    size_t size = 0;

    ride(&fmu, one, 0, 20);
    CHECK(fmu.GetFMUstate(one, &state) == fmi2OK);
    ride(&fmu, one, 20, 40);
    const double reached = output(&fmu, one);
    CHECK(fmu.SetFMUstate(one, state) == fmi2OK);
    ride(&fmu, one, 20, 40);
    CHECK(output(&fmu, one) == reached);

    CHECK(fmu.SerializedFMUstateSize(one, state, &size) == fmi2OK);
    char *bytes = malloc(size);
    CHECK(fmu.SerializeFMUstate(one, state, bytes, size) == fmi2OK);
    CHECK(fmu.DeSerializeFMUstate(other, bytes, size, &copy) == fmi2OK);
    CHECK(fmu.SetFMUstate(other, copy) == fmi2OK);
    ride(&fmu, other, 20, 40);
    CHECK(output(&fmu, other) == reached);

    CHECK(fmu.SetFMUstate(other, state) == fmi2Error);
    CHECK(fmu.SerializeFMUstate(one, state, bytes, size - 1) == fmi2Error);
    srand(1);
    for (size_t cut = 0; cut < size; cut += 1 + size / 97) {
        fmi2FMUstate broken = NULL;
        CHECK(fmu.DeSerializeFMUstate(one, bytes, cut, &broken) == fmi2Error);
    }
    for (int k = 0; k < 1000; k++) {
        fmi2FMUstate broken = NULL;
        const size_t at = (size_t)rand() % (k % 2 ? size : 2400);
        const char was = bytes[at];
        bytes[at] = (char)rand();
        if (fmu.DeSerializeFMUstate(other, bytes, size, &broken) == fmi2OK) {
            fmu.SetFMUstate(other, broken);
            fmu.DoStep(other, 0.2, 0.01, fmi2True);
            CHECK(fmu.FreeFMUstate(other, &broken) == fmi2OK);
        }
        bytes[at] = was;
    }
    free(bytes);
    CHECK(fmu.FreeFMUstate(one, &state) == fmi2OK && state == NULL);
    CHECK(fmu.FreeFMUstate(one, &state) == fmi2OK);
    fmu.FreeInstance(one);
    fmu.FreeInstance(other); /* with a state left */
    CLOSE(fmu.library);
}

/* Calls that make no sense are refused with a message and do no harm. */
static void scenario_wrong(void)
{
    const Fmu fmu = load();
    const fmi2ValueReference nowhere = 4000000000u;
    fmi2Real value = NAN;
    fmi2Integer order = 1;

    CHECK(fmu.Instantiate("one", fmi2CoSimulation, "another", "", &CALLBACKS, 0, 0) == NULL);
    CHECK(fmu.Instantiate("", fmi2CoSimulation, given.guid, "", &CALLBACKS, 0, 0) == NULL);
    CHECK(fmu.Instantiate("one", fmi2ModelExchange, given.guid, "", &CALLBACKS, 0, 0) == NULL);
    CHECK(fmu.Instantiate("one", fmi2CoSimulation, given.guid, "", NULL, 0, 0) == NULL);
    CHECK(messages == 3);
    fmu.FreeInstance(NULL);
    CHECK(fmu.DoStep(NULL, 0.0, 0.01, 1) == fmi2Error);
    CHECK(fmu.GetReal(NULL, &given.output, 1, &value) == fmi2Error);

    fmi2Component one = made(&fmu);
    CHECK(fmu.DoStep(one, 0.0, 0.01, 1) == fmi2Error);
    CHECK(fmu.ExitInitializationMode(one) == fmi2Error);
    CHECK(fmu.Terminate(one) == fmi2Error);
    CHECK(fmu.GetReal(one, &nowhere, 1, &value) == fmi2Error);
    CHECK(fmu.GetReal(one, NULL, 1, &value) == fmi2Error);
    CHECK(fmu.GetReal(one, &given.output, 1, NULL) == fmi2Error);
    CHECK(fmu.GetString(one, &given.output, 1, (fmi2String[]){NULL}) == fmi2Error);
    CHECK(fmu.SetReal(one, &given.mass, 1, &value) == fmi2Error);
    CHECK(fmu.SetReal(one, &given.output, 1, &(fmi2Real){1.0}) == fmi2Error);
    CHECK(fmu.SetInteger(one, &given.mass, 1, &order) == fmi2Error);
    CHECK(fmu.GetFMUstate(one, NULL) == fmi2Error);
    CHECK(fmu.SetFMUstate(one, NULL) == fmi2Error);
    CHECK(fmu.CancelStep(one) == fmi2Error);
    CHECK(fmu.SetRealInputDerivatives(one, &given.car, 1, &order, &value) == fmi2Error);
    CHECK(fmu.GetRealOutputDerivatives(one, &given.output, 1, &order, &value) == fmi2Error);
    CHECK(fmu.GetDirectionalDerivative(one, &given.output, 1, &given.car, 1, &value, &value) == fmi2Error);
    CHECK(fmu.Reset(one) == fmi2OK);
    CHECK(fmu.SetupExperiment(one, 0, 0.0, NAN, 0, 0.0) == fmi2Error);
    CHECK(fmu.SetupExperiment(one, 0, 0.0, 1.0, 1, 0.0) == fmi2Error);
    fmu.FreeInstance(one);

    one = begun(&fmu);
    CHECK(fmu.EnterInitializationMode(one) == fmi2Error);
    CHECK(fmu.SetReal(one, &given.mass, 1, &(fmi2Real){60.0}) == fmi2Error);
    CHECK(fmu.GetReal(one, &given.output, 1, &value) == fmi2Error); /* after an error there is no output */
    CHECK(fmu.GetRealStatus(one, fmi2LastSuccessfulTime, &value) == fmi2OK && value == 0.0);
    CHECK(fmu.GetRealStatus(one, fmi2DoStepStatus, &value) == fmi2Discard);
    const double steps[] = {0.0, -0.01, NAN, INFINITY, 1e300};
    for (size_t k = 0; k < sizeof steps / sizeof *steps; k++) {
        fmu.FreeInstance(one);
        one = begun(&fmu);
        CHECK(fmu.DoStep(one, 0.0, steps[k], 1) == fmi2Error);
    }
    fmu.FreeInstance(one);
    CLOSE(fmu.library);
}

/* Everything that takes memory; returns whether all went well. Whatever fails first is an error, and told. */
static int complete(const Fmu *fmu)
{
    const fmi2Real ends[] = {0.0, 50.0}, mass = 2000.0;
    const fmi2ValueReference inputs[] = {given.car, given.counterweight};
    fmi2FMUstate state = NULL, copy = NULL;
    size_t size = 0;
    fmi2Component one = fmu->Instantiate("one", fmi2CoSimulation, given.guid, "", &CALLBACKS, fmi2False, fmi2False);
    if (!one) {
        return 0;
    }
    fmi2Status status = fmu->SetReal(one, &given.mass, 1, &mass);
    status |= fmu->SetReal(one, inputs, 2, ends);
    status |= fmu->SetupExperiment(one, fmi2False, 0.0, 0.0, fmi2False, 0.0);
    status |= fmu->EnterInitializationMode(one);
    status |= fmu->ExitInitializationMode(one);
    status |= fmu->DoStep(one, 0.0, 0.01, fmi2True);
    status |= fmu->GetFMUstate(one, &state);
    if (state && fmu->SerializedFMUstateSize(one, state, &size) == fmi2OK) {
        char *bytes = malloc(size);
        status |= fmu->SerializeFMUstate(one, state, bytes, size);
        status |= fmu->DeSerializeFMUstate(one, bytes, size, &copy);
        free(bytes);
    }
    status |= copy ? fmu->SetFMUstate(one, copy) : fmi2Error;
    status |= fmu->DoStep(one, 0.01, 0.01, fmi2True);
    fmu->FreeInstance(one);
    return status == fmi2OK;
}

/* Every allocation fails in turn: an error with a message, and nothing is lost. */
static void scenario_memory(void)
{
    const Fmu fmu = load();
    long failed = 0;
    for (;; failed++) {
        const long before = messages;
        failing = failed;
        const int done = complete(&fmu);
        CHECK(done == (failing >= 0));
        if (failing >= 0) { /* there are not so many */
            break;
        }
        CHECK(messages > before);
        CHECK(taken == 0);
    }
    CHECK(failed >= 5);
    failing = -1;
    CLOSE(fmu.library);
}

int main(int count, char **arguments)
{
    if (count < 8) {
        return 2;
    }
    given.path = arguments[2];
    given.guid = arguments[3];
    given.car = (fmi2ValueReference)atoi(arguments[4]);
    given.counterweight = (fmi2ValueReference)atoi(arguments[5]);
    given.mass = (fmi2ValueReference)atoi(arguments[6]);
    given.output = (fmi2ValueReference)atoi(arguments[7]);
    given.number = count > 8 ? atol(arguments[8]) : 1;

    const char *scenario = arguments[1];
    if (!strcmp(scenario, "cycle")) {
        scenario_cycle();
    } else if (!strcmp(scenario, "ride")) {
        scenario_ride();
    } else if (!strcmp(scenario, "states")) {
        scenario_states();
    } else if (!strcmp(scenario, "wrong")) {
        scenario_wrong();
    } else if (!strcmp(scenario, "memory")) {
        scenario_memory();
#ifndef _WIN32
    } else if (!strcmp(scenario, "threads")) {
        scenario_threads();
#endif
    } else {
        return 2;
    }
    CHECK(taken == 0);
    printf("%s: %d failures, %ld messages\n", scenario, failures, (long)messages);
    return failures != 0;
}
