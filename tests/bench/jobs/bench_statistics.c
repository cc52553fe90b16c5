/* A realisation of a study of statistics, 1024 x 1024, with all that it measures, beside generation
 * with nine-point summits alone. Printed: CPU time, one core, medians, taken in turn so that other
 * work on the machine is the same for all. Weibull surfaces are those without pairs for the law
 * difference, which some have.
 *
 * A second table has surfaces and profiles, 8 and 2 points a shortest wave: Gaussian ones with
 * fixed and with random amplitudes, and Weibull ones (C = 1) of the law "translation", beside what
 * is estimated before they run. Ratios are to the column before, and medians of ratios. */
#include "core/statistics/summits/summits.h"
#include "jobs/runner.h"
#include "tests/support/timing.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SIDE = 1024, REPEATS_MOST = 15 };
#define SURFACE                                                                                    \
    "\"dimension\":2,\"hurst\":0.8,\"wavelength_ratio\":16,\"length_ratio\":8,"                    \
    "\"points_per_wavelength\":8"

struct statistics_bench {
    const char *name, *parameters;
    struct surface_options options;
    size_t repeats;
    uint64_t block; /* realisations, 7 at most: pairs are those of number 0 and 8 */
};

/* What is measured. */
struct work {
    struct generator *generator;
    struct summit_finder *finder;
    struct summit_list summits;
    struct job_runner *runner;
    cJSON *parameters;
    double *z;
};

static int work_create(struct work *work, const struct statistics_bench *bench, struct error *err) {
    const struct grid grid = {SIDE, SIDE, SIDE / 8.0, SIDE / 8.0};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.8,
                                      .wavelength_long = SIDE / 64.0,
                                      .wavelength_rolloff = SIDE / 64.0,
                                      .wavelength_short = 1};
    work->z = array_create((size_t)SIDE * SIDE, sizeof *work->z);
    work->parameters = cJSON_Parse(bench->parameters);
    if (work->z == NULL || work->parameters == NULL)
        return error_memory(err, (size_t)SIDE * SIDE * sizeof *work->z, "heights");
    int status = generator_create(&work->generator, &spectrum, &grid, &bench->options, err);
    if (status == 0)
        status = summit_finder_create(&work->finder, &grid, SUMMITS_NINE_POINT,
                                      CURVATURE_FINITE_DIFFERENCE, SIDE / 8, SIDE / 8, err);
    if (status == 0)
        status = runner_create(&work->runner, kind_find("statistics"), work->parameters, NULL, 1, 0,
                               err);
    return status;
}

static void work_clear(struct work *work) {
    generator_destroy(&work->generator);
    summit_finder_destroy(&work->finder);
    summit_list_clear(&work->summits);
    runner_destroy(&work->runner);
    cJSON_Delete(work->parameters);
    free(work->z);
}

/* Fills the times a realisation of generation with summits, and of the same block of a study. */
static int work_measure(struct work *work, uint64_t block, double *alone, double *study,
                        struct error *err) {
    struct block_result result = {0};
    double start = cpu_ms();
    int status = 0;
    for (uint64_t r = 1; r <= block && status == 0; r++) {
        status = generator_run(work->generator, (struct random_key){1, 0, r}, work->z, NULL, err);
        if (status == 0)
            status = summits_find(work->finder, work->z, &work->summits, err);
    }
    double middle = cpu_ms();
    if (status == 0)
        status = runner_run(work->runner, 1, block, NULL, &result, err);
    *alone = (middle - start) / (double)block;
    *study = (cpu_ms() - middle) / (double)block;
    block_result_clear(&result);
    return status;
}

static int bench_run(const struct statistics_bench *bench, struct error *err) {
    struct work work = {0};
    double alone[REPEATS_MOST], study[REPEATS_MOST], first[2];
    int status = work_create(&work, bench, err);
    if (status == 0) /* touches all memory */
        status = work_measure(&work, bench->block, &first[0], &first[1], err);
    for (size_t r = 0; r < bench->repeats && status == 0; r++)
        status = work_measure(&work, bench->block, &alone[r], &study[r], err);
    work_clear(&work);
    if (status != 0)
        return status;
    qsort(alone, bench->repeats, sizeof *alone, by_value);
    qsort(study, bench->repeats, sizeof *study, by_value);
    size_t last = bench->repeats - 1, half = bench->repeats / 2;
    printf("%12s  %9.2f (%.2f-%.2f)  %9.2f (%.2f-%.2f)  %6.2f\n", bench->name, alone[half],
           alone[0], alone[last], study[half], study[0], study[last], study[half] / alone[half]);
    return 0;
}

/* --- fixed and random amplitudes, and translated surfaces --- */

struct amplitude_bench {
    int dimension;
    size_t side, points_per_wave;
    uint64_t block;
};
enum { FIXED, RANDOM, TRANSLATED, KINDS };
static const char FIXED_AMPLITUDES[] = "\"amplitudes\":\"fixed\"";
static const char RANDOM_AMPLITUDES[] = "\"amplitudes\":\"random\"";
static const char TRANSLATED_HEIGHTS[] =
    "\"amplitudes\":\"random\",\"heights\":{\"distribution\":\"weibull_min\",\"shape\":1,"
    "\"law\":\"translation\"}";
static const char *const KIND_PARAMETERS[KINDS] = {FIXED_AMPLITUDES, RANDOM_AMPLITUDES,
                                                   TRANSLATED_HEIGHTS};

static int runner_make(struct job_runner **out, const struct amplitude_bench *bench, int kind,
                       double *expected, struct error *err) {
    char text[300];
    struct fault_list faults = {0};
    struct study_cost cost = {0};
    size_t ratio = bench->side / bench->points_per_wave / 8;
    snprintf(text, sizeof text,
             "{\"surface\":{\"dimension\":%d,\"hurst\":0.8,\"wavelength_ratio\":%zu,"
             "\"length_ratio\":8,\"points_per_wavelength\":%zu,%s}}",
             bench->dimension, ratio, bench->points_per_wave, KIND_PARAMETERS[kind]);
    cJSON *parameters = cJSON_Parse(text);
    const struct job_kind *statistics = kind_find("statistics");
    int status = parameters != NULL
                     ? kind_check(&statistics->study, parameters, 0, &faults, &cost, err)
                     : error_memory(err, sizeof text, "parameters");
    if (status == 0)
        status = runner_create(out, statistics, parameters, NULL, 1, 0, err);
    *expected = 1e3 * cost.seconds;
    fault_list_clear(&faults);
    cJSON_Delete(parameters);
    return status;
}

/* Realisations from here on are without pairs of the other law, but for each 1024th. */
enum { REALISATION_FIRST = 33 };

/* Fills the times a realisation of a block of each kind, one behind the other. */
static int pair_measure(struct job_runner *const runners[], uint64_t block, double *times,
                        struct error *err) {
    int status = 0;
    for (int kind = 0; kind < KINDS && status == 0; kind++) {
        struct block_result result = {0};
        double start = cpu_ms();
        status = runner_run(runners[kind], REALISATION_FIRST, block, NULL, &result, err);
        times[kind] = (cpu_ms() - start) / (double)block;
        block_result_clear(&result);
    }
    return status;
}

static double sorted_median(double *values) {
    qsort(values, REPEATS_MOST, sizeof *values, by_value);
    return values[REPEATS_MOST / 2];
}

static int amplitudes_run(const struct amplitude_bench *bench, struct error *err) {
    struct job_runner *runners[KINDS] = {NULL};
    double times[KINDS], expected[KINDS], of[KINDS][REPEATS_MOST], ratio[KINDS][REPEATS_MOST];
    int status = 0;
    for (int kind = 0; kind < KINDS && status == 0; kind++)
        status = runner_make(&runners[kind], bench, kind, &expected[kind], err);
    if (status == 0) /* touches all memory */
        status = pair_measure(runners, bench->block, times, err);
    for (size_t r = 0; r < REPEATS_MOST && status == 0; r++) {
        status = pair_measure(runners, bench->block, times, err);
        for (int kind = 0; kind < KINDS; kind++) {
            of[kind][r] = times[kind];
            ratio[kind][r] = times[kind] / times[kind > FIXED ? kind - 1 : FIXED];
        }
    }
    for (int kind = 0; kind < KINDS; kind++)
        runner_destroy(&runners[kind]);
    if (status != 0)
        return status;
    printf("%3dD  %6zu  %6zu", bench->dimension, bench->side, bench->points_per_wave);
    for (int kind = 0; kind < KINDS; kind++) {
        printf("  %9.3f (%.3f)", sorted_median(of[kind]), expected[kind]);
        double middle = sorted_median(ratio[kind]);
        if (kind > FIXED)
            printf("  %5.2f (%.2f-%.2f)", middle, ratio[kind][0], ratio[kind][REPEATS_MOST - 1]);
    }
    printf("\n");
    return 0;
}

static int amplitudes_bench(struct error *err) {
    static const struct amplitude_bench BENCHES[] = {{2, 512, 8, 40},    {2, 1024, 8, 10},
                                                     {2, 512, 2, 10},    {1, 4096, 8, 100},
                                                     {1, 65536, 8, 100}, {1, 16384, 2, 100}};
    int status = 0;
    printf("\n      points  a wave  fixed ms (estimate)  random ms (estimate)  ratio (spread)  "
           "translated ms (estimate)  ratio (spread)\n");
    for (size_t b = 0; b < sizeof BENCHES / sizeof *BENCHES && status == 0; b++)
        status = amplitudes_run(&BENCHES[b], err);
    return status;
}

int main(void) {
    struct statistics_bench benches[] = {
        {"gaussian", "{\"surface\":{" SURFACE "}}", SURFACE_DEFAULTS, 15, 7},
        {"weibull_max",
         "{\"surface\":{" SURFACE ",\"heights\":{\"distribution\":\"weibull_max\",\"shape\":1}}}",
         SURFACE_DEFAULTS, 5, 1},
    };
    struct error err = {0};
    benches[1].options.heights = (struct heights){.type = HEIGHTS_WEIBULL_MAX, .shape = 1};
    printf("%12s  %s  %s  %s\n", "heights", "generation, summits ms (spread)",
           "realisation of a study ms (spread)", "ratio");
    for (size_t b = 0; b < sizeof benches / sizeof *benches; b++)
        if (bench_run(&benches[b], &err) != 0) {
            fprintf(stderr, "bench_statistics: %s\n", err.text);
            return 1;
        }
    if (amplitudes_bench(&err) != 0) {
        fprintf(stderr, "bench_statistics: %s\n", err.text);
        return 1;
    }
    return 0;
}
