/* Loads the library of an FMU and calls it from instantiation to freeing, twice, for a checker of memory:
   `lifecycle LIBRARY VERSION TOKEN RESOURCES STOP`. The states are saved, restored and written as bytes on the way. */
#include "fmi2Functions.h"
#include "fmi3Functions.h"

#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 10 };

static void *library;

/* A function of the library; the program ends without it. */
static void *function(const char *name)
{
    void *found = dlsym(library, name);
    if (found == NULL) {
        fprintf(stderr, "no %s\n", name);
        exit(2);
    }
    return found;
}

#define CALL(type, name) ((type *)function(#name))

static void check(int status, const char *what)
{
    /* Discard: the model has no solution there, which is an answer. */
    if (status > 2) {
        fprintf(stderr, "%s: %d\n", what, status);
        exit(3);
    }
}

static void log_three(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String message)
{
    (void)environment;
    (void)category;
    if (status > 2) {
        fprintf(stderr, "%s\n", message);
    }
}

static void three(const char *token, const char *resources, double stop)
{
    fmi3Instance own = CALL(fmi3InstantiateCoSimulationTYPE, fmi3InstantiateCoSimulation)(
        "own", token, resources, fmi3False, fmi3True, fmi3False, fmi3False, NULL, 0, NULL, log_three, NULL);
    if (own == NULL) {
        exit(4);
    }
    check(CALL(fmi3EnterInitializationModeTYPE, fmi3EnterInitializationMode)(own, fmi3False, 0.0, 0.0, fmi3True, stop), "enter");
    check(CALL(fmi3ExitInitializationModeTYPE, fmi3ExitInitializationMode)(own), "exit");
    const fmi3ValueReference time = 0;
    double value = 0.0;
    for (int k = 0; k < STEPS; ++k) {
        fmi3Boolean event, end, early;
        const int status = CALL(fmi3DoStepTYPE, fmi3DoStep)(own, stop * k / STEPS, stop / STEPS, fmi3True, &event, &end, &early, &value);
        check(status, "step");
        if (status != fmi3OK) {
            break;
        }
        check(CALL(fmi3GetFloat64TYPE, fmi3GetFloat64)(own, &time, 1, &value, 1), "get");
    }
    fmi3FMUState state = NULL;
    size_t size = 0;
    check(CALL(fmi3GetFMUStateTYPE, fmi3GetFMUState)(own, &state), "state");
    check(CALL(fmi3SerializedFMUStateSizeTYPE, fmi3SerializedFMUStateSize)(own, state, &size), "size");
    fmi3Byte *bytes = malloc(size);
    check(CALL(fmi3SerializeFMUStateTYPE, fmi3SerializeFMUState)(own, state, bytes, size), "serialize");
    check(CALL(fmi3FreeFMUStateTYPE, fmi3FreeFMUState)(own, &state), "free state");
    check(CALL(fmi3DeserializeFMUStateTYPE, fmi3DeserializeFMUState)(own, bytes, size, &state), "deserialize");
    check(CALL(fmi3SetFMUStateTYPE, fmi3SetFMUState)(own, state), "set state");
    check(CALL(fmi3FreeFMUStateTYPE, fmi3FreeFMUState)(own, &state), "free state");
    free(bytes);
    check(CALL(fmi3ResetTYPE, fmi3Reset)(own), "reset");
    CALL(fmi3FreeInstanceTYPE, fmi3FreeInstance)(own);
}

static void log_two(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status, fmi2String category, fmi2String message, ...)
{
    (void)environment;
    (void)instance;
    (void)category;
    if (status > 2) {
        fprintf(stderr, "%s\n", message);
    }
}

static void two(const char *token, const char *resources, double stop)
{
    const fmi2CallbackFunctions callbacks = {log_two, calloc, free, NULL, NULL};
    char place[4096];
    snprintf(place, sizeof place, "file://%s", resources);
    fmi2Component own =
        CALL(fmi2InstantiateTYPE, fmi2Instantiate)("own", fmi2CoSimulation, token, place, &callbacks, fmi2False, fmi2True);
    if (own == NULL) {
        exit(4);
    }
    check(CALL(fmi2SetupExperimentTYPE, fmi2SetupExperiment)(own, fmi2False, 0.0, 0.0, fmi2True, stop), "set up");
    check(CALL(fmi2EnterInitializationModeTYPE, fmi2EnterInitializationMode)(own), "enter");
    check(CALL(fmi2ExitInitializationModeTYPE, fmi2ExitInitializationMode)(own), "exit");
    const fmi2ValueReference time = 0;
    double value = 0.0;
    for (int k = 0; k < STEPS; ++k) {
        const int status = CALL(fmi2DoStepTYPE, fmi2DoStep)(own, stop * k / STEPS, stop / STEPS, fmi2True);
        check(status, "step");
        if (status != fmi2OK) {
            break;
        }
        check(CALL(fmi2GetRealTYPE, fmi2GetReal)(own, &time, 1, &value), "get");
    }
    fmi2FMUstate state = NULL;
    size_t size = 0;
    check(CALL(fmi2GetFMUstateTYPE, fmi2GetFMUstate)(own, &state), "state");
    check(CALL(fmi2SerializedFMUstateSizeTYPE, fmi2SerializedFMUstateSize)(own, state, &size), "size");
    fmi2Byte *bytes = malloc(size);
    check(CALL(fmi2SerializeFMUstateTYPE, fmi2SerializeFMUstate)(own, state, bytes, size), "serialize");
    check(CALL(fmi2FreeFMUstateTYPE, fmi2FreeFMUstate)(own, &state), "free state");
    check(CALL(fmi2DeSerializeFMUstateTYPE, fmi2DeSerializeFMUstate)(own, bytes, size, &state), "deserialize");
    check(CALL(fmi2SetFMUstateTYPE, fmi2SetFMUstate)(own, state), "set state");
    check(CALL(fmi2FreeFMUstateTYPE, fmi2FreeFMUstate)(own, &state), "free state");
    free(bytes);
    check(CALL(fmi2ResetTYPE, fmi2Reset)(own), "reset");
    CALL(fmi2FreeInstanceTYPE, fmi2FreeInstance)(own);
}

int main(int argc, char **argv)
{
    if (argc != 6) {
        return 1;
    }
    library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
        fprintf(stderr, "%s\n", dlerror());
        return 2;
    }
    for (int instance = 0; instance < 2; ++instance) {
        if (strcmp(argv[2], "3") == 0) {
            three(argv[3], argv[4], atof(argv[5]));
        } else {
            two(argv[3], argv[4], atof(argv[5]));
        }
    }
    puts("done");
    return 0;
}
