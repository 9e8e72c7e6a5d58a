/* Times the steps of a model: `timed COUNT TURNS [INPUTS]`, with a line of inputs for each step, prints the nanoseconds of a
   step in the quickest turn. */
#define _POSIX_C_SOURCE 199309L
#include "model.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static model m;

static double now(void)
{
    struct timespec at;
    clock_gettime(CLOCK_MONOTONIC, &at);
    return 1e9 * (double)at.tv_sec + (double)at.tv_nsec;
}

int main(int argc, char **argv)
{
    const long count = argc > 2 ? atol(argv[1]) : 0;
    const long turns = argc > 2 ? atol(argv[2]) : 0;
    FILE *file = argc > 3 ? fopen(argv[3], "r") : NULL;
    const long width = file != NULL ? model_INPUTS : 0;
    double *inputs = malloc((size_t)(count * width + 1) * sizeof *inputs);
    for (long k = 0; k < count * width; ++k) {
        if (inputs == NULL || fscanf(file, "%lf", &inputs[k]) != 1) {
            return 2;
        }
    }
    double least = 1e300;
    for (long turn = 0; turn < turns; ++turn) {
        if (model_init(&m) != model_OK) {
            return 1;
        }
        const double begin = now();
        for (long k = 0; k < count; ++k) {
            for (int input = 0; input < width; ++input) {
                model_set(&m, input, inputs[k * width + input]);
            }
            const int status = model_step(&m);
            if (status != model_OK) {
                fprintf(stderr, "at %.9g s: %s\n", model_time(&m), model_message(&m, status));
                return 1;
            }
        }
        const double each = (now() - begin) / (double)count;
        least = each < least ? each : least;
    }
    free(inputs);
    printf("%.17g\n", least);
    return 0;
}
