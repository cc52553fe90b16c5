/* What hardness, conductance and leak add to a study of contact: surfaces of 256 x 256 and 512 x
 * 512 points, Hurst exponent 0.8, ratio 8 and 8 points a shortest wave, four loads on a half-space.
 * Printed: points x transforms of all loads over those of elastic contact, and CPU time, the least
 * of five runs, over its least. Transforms are counted and the same on each machine. Leaks have
 * none, and no transform counts what measuring costs. Instructions of a run, with all of it, are
 * those that `valgrind --tool=callgrind rugo run --workers 1 STUDY.json` collects. */
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "schema/result/result.h"
#include "tests/support/timing.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { REPEATS = 5, TEXT = 1024 };

struct variant {
    const char *name, *asked;
};
static const struct variant VARIANTS[] = {
    {"elastic", ""},
    {"conductance", ", \"conductance\": true"},
    {"leak", ", \"leak\": true"},
    {"hardness 1", ", \"hardness\": 1"},
    {"hardness 0.5", ", \"hardness\": 0.5"},
    {"hardness 0.25", ", \"hardness\": 0.25"},
    {"hardness 1, conductance", ", \"hardness\": 1, \"conductance\": true"},
};

struct cost {
    double transforms, seconds;
};

static double transforms_of(const struct case_result *result) {
    double sum = 0;
    for (size_t c = 0; c < result->curve_count; c++)
        for (size_t k = 0; k < result->curves[c].n; k++)
            sum += strcmp(result->curves[c].quantity, "work") == 0 ? result->curves[c].y[k] : 0;
    return sum;
}

/* Runs one realisation with a runner of its own. */
static int run(const cJSON *parameters, struct cost *out, struct error *err) {
    const struct job_kind *kind = kind_find("contact");
    struct job_runner *runner = NULL;
    struct job_merger *merger = NULL;
    struct block_result result = {0};
    struct case_result merged = {0};
    int status = runner_create(&runner, kind, parameters, NULL, 1, 0, err);
    double start = cpu_ms();
    if (status == 0)
        status = runner_run(runner, 0, 1, NULL, &result, err);
    out->seconds = 1e-3 * (cpu_ms() - start);
    if (status == 0)
        status = merger_create(&merger, kind, parameters, err);
    if (status == 0)
        status = merger_add(merger, &result, err);
    if (status == 0)
        status = merger_result(merger, &merged, err);
    out->transforms = transforms_of(&merged);
    result_clear(&merged);
    block_result_clear(&result);
    merger_destroy(&merger);
    runner_destroy(&runner);
    return status;
}

static int measure(int side, const struct variant *variant, struct cost *out, struct error *err) {
    char study[TEXT];
    (void)snprintf(
        study, sizeof study,
        "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 8, \"length_ratio\": %d,"
        " \"points_per_wavelength\": 8}, \"contact\": {\"model\": \"halfspace\","
        " \"cell_error\": \"none\", \"pressures\": {\"values\": [0.01, 0.03, 0.1, 0.2]}%s}}",
        side / 64, variant->asked);
    cJSON *parameters = cJSON_Parse(study);
    int status = parameters != NULL ? 0 : error_memory(err, sizeof study, "a study");
    out->seconds = INFINITY;
    for (int a = 0; a < REPEATS && status == 0; a++) {
        struct cost cost;
        status = run(parameters, &cost, err);
        out->transforms = cost.transforms;
        out->seconds = fmin(out->seconds, cost.seconds);
    }
    cJSON_Delete(parameters);
    return status;
}

int main(void) {
    struct error err = {0};
    int status = 0;
    for (int side = 256; side <= 512 && status == 0; side *= 2) {
        struct cost elastic = {0};
        printf("%d x %d points\n%-24s  transforms  ratio  CPU s  ratio\n", side, side, "");
        for (size_t v = 0; v < sizeof VARIANTS / sizeof *VARIANTS && status == 0; v++) {
            struct cost cost = {0};
            status = measure(side, &VARIANTS[v], &cost, &err);
            if (v == 0)
                elastic = cost;
            double points = (double)side * side;
            printf("%-24s  %10.0f  %5.2f  %5.2f  %5.2f\n", VARIANTS[v].name,
                   cost.transforms / points, cost.transforms / elastic.transforms, cost.seconds,
                   cost.seconds / elastic.seconds);
        }
    }
    if (status != 0)
        fprintf(stderr, "%s\n", err.text);
    return status != 0;
}
