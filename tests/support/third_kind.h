/* A kind of study in one file: Buffon's needle. Needles of ten lengths fall on boards that are 1
 * wide; a needle of length x crosses a joint with probability 2 x/pi. */
#ifndef RUGO_TESTS_SUPPORT_THIRD_KIND_H
#define RUGO_TESTS_SUPPORT_THIRD_KIND_H

#include "jobs/kind.h"
#include "jobs/realisations.h"
#include "jobs/tally.h"
#include "schema/study/values.h"
#include <math.h>

enum { LENGTHS = 10 };
static const struct parameter NEEDLE_ROWS[] = {{.path = "/needle/throws",
                                                .type = PARAMETER_INTEGER,
                                                .minimum = 1,
                                                .maximum = 1e6,
                                                .sweep = true,
                                                .default_json = "1000",
                                                .help = "needles a realisation"}};
static const struct parameter_table NEEDLE_TABLE = {"needle", NEEDLE_ROWS, 1};
static const struct parameter_table *const NEEDLE_TABLES[] = {&NEEDLE_TABLE, NULL};
/* A case is its throws, a double. */
static int needle_read(void *study, const cJSON *parameters, double memory_limit,
                       struct fault_list *faults, struct error *err) {
    (void)memory_limit;
    struct values *values = NULL;
    int status = values_create(&values, parameters, NEEDLE_TABLES, faults, err);
    if (status == 0)
        *(double *)study = values_number(values, "/needle/throws");
    values_destroy(&values);
    return status;
}
static void needle_estimate(const void *study, struct study_cost *out) {
    double throws = *(const double *)study;
    *out = (struct study_cost){.nx = 1, .ny = 1, .memory_bytes = 1e7, .seconds = 1e-7 * throws};
    out->relative_error = 1 / sqrt(throws);
}
static const char *needle_scalar(size_t at) {
    return at == 0 ? "pi" : NULL;
}
/* A tally counts crossings by length, and in a last cell realisations. */
static int needle_create(void *tally, const void *study, const struct surface_basis *basis,
                         struct error *err) {
    (void)study, (void)basis;
    return tally_create(tally, LENGTHS + 1, LENGTHS + 1, err);
}
static void needle_clear(void *tally) {
    tally_clear(tally);
}
static int needle_realise(void *workspace, const struct realisation *realisation, void *tally,
                          double *scalars, struct error *err) {
    size_t throws = (size_t) * (const double *)realisation->study;
    uint64_t crossed[LENGTHS] = {0};
    (void)workspace, (void)err;
    for (size_t n = 0; n < throws; n++) {
        double u[2]; /* distance of the middle from the next joint, and direction */
        random_uniform(realisation->key, STREAM_PHASES, 2 * n, 2, u);
        for (int x = 0; x < LENGTHS; x++)
            crossed[x] += u[0] < 0.1 * (x + 1) * fabs(sin(M_PI * u[1]));
    }
    for (size_t x = 0; x < LENGTHS; x++)
        tally_add(tally, x, crossed[x], throws);
    tally_add(tally, LENGTHS, 1, 1);
    scalars[0] = 2 * (double)throws / (double)crossed[LENGTHS - 1];
    return 0;
}
static int needle_merge(void *into, const void *from, struct error *err) {
    return tally_merge(into, from), (void)err, 0;
}
static void needle_put(struct bytes *bytes, const void *tally) {
    tally_put(bytes, tally);
}
static void needle_get(struct byte_reader *reader, void *tally) {
    tally_get(reader, tally);
}
static bool needle_belongs(const void *tally, const struct block_result *result) {
    return ((const struct tally *)tally)->count[LENGTHS] == result->count;
}
static int needle_result(const void *study, const struct surface_basis *basis, const void *tally,
                         const struct realisations *realisations, struct case_result *out,
                         struct error *err) {
    uint64_t n = realisations->count, throws = (uint64_t) * (const double *)study;
    const struct tally_total total = {n, n * throws, (fixed_point)n * throws * throws};
    struct curve curve = curve_named("crossings", "length", "share");
    double *x = result_numbers(out, 4 * LENGTHS), *pi = result_numbers(out, n);
    if (x == NULL || pi == NULL)
        return error_memory(err, n * sizeof *pi, "curves of needles");
    double *y = x + LENGTHS, *error = y + LENGTHS, *theory = error + LENGTHS;
    for (int k = 0; k < LENGTHS; k++) {
        struct estimate share = tally_share(tally, (size_t)k, &total);
        x[k] = 0.1 * (k + 1), theory[k] = 2 * x[k] / M_PI;
        y[k] = share.value, error[k] = share.standard_error;
    }
    curve_set_points(&curve, LENGTHS, x, y, error);
    curve.theories[curve.theory_count++] = (struct theory){"buffon", theory};
    realisations_column(realisations, 0, pi);
    struct estimate mean = estimate_mean(n, pi);
    (void)basis;
    struct scalar scalar = scalar_named("pi", mean.value, mean.standard_error, M_PI);
    int status = result_add_scalar(out, &scalar, err);
    return status != 0 ? status : result_add_curve(out, &curve, err);
}
static const struct job_kind NEEDLE_KIND = {
    .study = {"needle", NEEDLE_TABLES, 10, kind_check},
    .scalar = needle_scalar,
    .case_size = sizeof(double),
    .read = needle_read,
    .estimate = needle_estimate,
    .tally_size = sizeof(struct tally),
    .tally_create = needle_create,
    .tally_clear = needle_clear,
    .realise = needle_realise,
    .merge = needle_merge,
    .format = 0x4e45,
    .put = needle_put,
    .get = needle_get,
    .belongs = needle_belongs,
    .result = needle_result,
};
#endif
