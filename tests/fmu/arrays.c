/* The library of an FMU of FMI 3.0 with arrays, one of a size that is a structural parameter: y[i] = A[i]*(B[1][1] + … + B[2][2])*u.
   It prints at every step. `arrays.py` makes the FMU. */
#include "fmi3Functions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { N = 3, TIME = 0, SIZE = 1, A = 2, B = 3, U = 4, Y = 5 };

typedef struct {
    double a[N], b[4], u;
} Own;

FMI3_Export fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean event_mode,
    fmi3Boolean early, const fmi3ValueReference required[], size_t n_required, fmi3InstanceEnvironment environment,
    fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update)
{
    static const Own start = {{1, 2, 3}, {1, 0, 0, 1}, 0};
    Own *own = malloc(sizeof *own);
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)event_mode, (void)early, (void)required;
    (void)n_required, (void)environment, (void)log, (void)update;
    if (own != NULL) {
        *own = start;
    }
    return own;
}

FMI3_Export void fmi3FreeInstance(fmi3Instance instance)
{
    free(instance);
}

FMI3_Export fmi3Status fmi3EnterInitializationMode(
    fmi3Instance instance, fmi3Boolean has_tolerance, fmi3Float64 tolerance, fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop)
{
    (void)instance, (void)has_tolerance, (void)tolerance, (void)start, (void)has_stop, (void)stop;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3ExitInitializationMode(fmi3Instance instance)
{
    (void)instance;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3Terminate(fmi3Instance instance)
{
    (void)instance;
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3DoStep(
    fmi3Instance instance, fmi3Float64 t, fmi3Float64 step, fmi3Boolean no_set, fmi3Boolean *event, fmi3Boolean *terminate,
    fmi3Boolean *early, fmi3Float64 *reached)
{
    (void)instance, (void)no_set;
    *event = *terminate = *early = fmi3False;
    *reached = t + step;
    puts("a library may print");
    return fmi3OK;
}

FMI3_Export fmi3Status fmi3SetFloat64(
    fmi3Instance instance, const fmi3ValueReference references[], size_t n, const fmi3Float64 values[], size_t n_values)
{
    Own *own = instance;
    if (n != 1) {
        return fmi3Error;
    }
    switch (references[0]) {
    case A:
        if (n_values != N) return fmi3Error;
        memcpy(own->a, values, sizeof own->a);
        return fmi3OK;
    case B:
        if (n_values != 4) return fmi3Error;
        memcpy(own->b, values, sizeof own->b);
        return fmi3OK;
    case U:
        own->u = values[0];
        return fmi3OK;
    default:
        return fmi3Error;
    }
}

FMI3_Export fmi3Status fmi3GetFloat64(
    fmi3Instance instance, const fmi3ValueReference references[], size_t n, fmi3Float64 values[], size_t n_values)
{
    const Own *own = instance;
    if (n != 1 || references[0] != Y || n_values != N) {
        return fmi3Error;
    }
    for (int k = 0; k < N; ++k) {
        values[k] = own->a[k] * (own->b[0] + own->b[1] + own->b[2] + own->b[3]) * own->u;
    }
    return fmi3OK;
}
