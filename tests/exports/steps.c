/* Steps a model and prints its outputs after every step: `steps COUNT [INPUTS|- [CHANGES]]`, with a line of inputs for each step, and
   a line `STEP p|in NUMBER VALUE` for each parameter or input that is set before a step, in the order of the steps. */
#include "model.h"

#include <stdio.h>
#include <stdlib.h>

static model m;

static void row(void)
{
    for (int k = 0; k < model_OUTPUTS; ++k) {
        printf("%.17g ", model_get(&m, k));
    }
    printf("\n");
}

int main(int argc, char **argv)
{
    const long count = argc > 1 ? atol(argv[1]) : 0;
    FILE *inputs = argc > 2 ? fopen(argv[2], "r") : NULL;
    FILE *changes = argc > 3 ? fopen(argv[3], "r") : NULL;
    long at = -1;
    char kind[4] = "";
    int number = 0;
    double changed = 0.0;
    int more = changes != NULL && fscanf(changes, "%ld %3s %d %lf", &at, kind, &number, &changed) == 4;
    int status = model_init(&m);
    if (status != model_OK) {
        fprintf(stderr, "start: %s\n", model_message(&m, status));
        return 1;
    }
    row();
    for (long k = 0; k < count; ++k) {
        for (int input = 0; inputs != NULL && input < model_INPUTS; ++input) {
            double value = 0.0;
            if (fscanf(inputs, "%lf", &value) != 1) {
                return 2;
            }
            if (model_set(&m, input, value) != model_OK) {
                return 3;
            }
        }
        while (more && at == k) {
            const int set = kind[0] == 'p' ? model_set_parameter(&m, number, changed) : model_set(&m, number, changed);
            if (set != model_OK) {
                return 5;
            }
            more = fscanf(changes, "%ld %3s %d %lf", &at, kind, &number, &changed) == 4;
        }
        status = model_step(&m);
        if (status != model_OK) {
            fprintf(stderr, "at %.9g s: %s\n", model_time(&m), model_message(&m, status));
            return 1;
        }
        row();
    }
    if (model_set(&m, -1, 0.0) == model_OK || model_set_parameter(&m, model_PARAMETERS, 0.0) == model_OK) {
        return 4;
    }
    return 0;
}
