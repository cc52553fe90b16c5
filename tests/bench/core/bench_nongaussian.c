/* Non-Gaussian surfaces: what an iteration costs, and what relaxed reflections buy. CPU time, one
 * core.
 *
 *   bench_nongaussian            N = 1024, C = 1 maximum (ratio 16, 8 points a shortest wave)
 *   bench_nongaussian long [n]   n (200) small surfaces: default against 1500 plain iterations, in
 * standard errors of the paired differences */
#include "core/statistics/summits.h"
#include "core/surface/rank.h"
#include "core/surface/surface.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double cpu_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

static int by_value(const void *a, const void *b) {
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static double median(double *values, size_t n) {
    qsort(values, n, sizeof *values, by_value);
    return values[n / 2];
}

static struct spectrum self_affine(double ratio) {
    return (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                             .hurst = 0.8,
                             .wavelength_long = ratio,
                             .wavelength_rolloff = ratio,
                             .wavelength_short = 1};
}

/* Summit statistics of one surface. */
enum { COUNT, HEIGHT, DEVIATION, CURVATURE, FIGURES };
static const char *const NAMES[FIGURES] = {"number of summits", "mean height",
                                           "deviation of height", "mean curvature"};

struct nongaussian_bench {
    struct grid grid;
    struct generator *generator;
    struct summit_finder *finder;
    struct summit_list summits;
    double *z;
    double ms; /* of the last generation */
    struct surface_report report;
};

static int bench_create(struct nongaussian_bench *bench, double ratio, double points,
                        const struct surface_options *options, struct error *err) {
    size_t n = (size_t)(8 * ratio * points);
    struct spectrum spectrum = self_affine(ratio);
    *bench = (struct nongaussian_bench){.grid = {n, n, 8 * ratio, 8 * ratio}};
    bench->z = array_create(n * n, sizeof *bench->z);
    int status = bench->z ? 0 : error_memory(err, n * n * sizeof *bench->z, "heights");
    if (!status)
        status = generator_create(&bench->generator, &spectrum, &bench->grid, options, err);
    if (!status)
        status = summit_finder_create(&bench->finder, &bench->grid, SUMMITS_NINE_POINT,
                                      CURVATURE_FINITE_DIFFERENCE, n / 2, n / 2, err);
    return status;
}

static void bench_destroy(struct nongaussian_bench *bench) {
    generator_destroy(&bench->generator);
    summit_finder_destroy(&bench->finder);
    summit_list_clear(&bench->summits);
    free(bench->z);
}

static int bench_surface(struct nongaussian_bench *bench, uint64_t realisation, double *figures,
                         struct error *err) {
    struct random_key key = {1, 0, realisation};
    double start = cpu_ms();
    int status = generator_run(bench->generator, key, bench->z, &bench->report, err);
    bench->ms = cpu_ms() - start;
    if (!status)
        status = summits_find(bench->finder, bench->z, &bench->summits, err);
    if (status)
        return status;
    double n = (double)bench->summits.count, sums[FIGURES] = {0};
    for (size_t s = 0; s < bench->summits.count; s++) {
        const struct summit *summit = &bench->summits.summits[s];
        sums[HEIGHT] += summit->height;
        sums[DEVIATION] += summit->height * summit->height;
        sums[CURVATURE] += summit->curvature;
    }
    figures[COUNT] = n;
    figures[HEIGHT] = sums[HEIGHT] / n;
    figures[DEVIATION] = sqrt(sums[DEVIATION] / n - figures[HEIGHT] * figures[HEIGHT]);
    figures[CURVATURE] = sums[CURVATURE] / n;
    return 0;
}

static struct surface_options maximum(void) {
    struct surface_options options = SURFACE_DEFAULTS;
    options.heights = (struct heights){.type = HEIGHTS_WEIBULL_MAX, .shape = 1};
    return options;
}

static struct surface_options plain(size_t iterations) {
    struct surface_options options = maximum();
    options.iteration = ITERATION_PLAIN;
    options.max_iterations = iterations;
    options.tolerance = 0;
    options.stall_iterations = iterations; /* never stuck before the limit */
    return options;
}

/* --- the short bench --- */

enum { REPEATS = 5 };

static int time_rank(struct error *err) {
    size_t n = 1024 * 1024;
    struct surface_options options = SURFACE_DEFAULTS;
    struct nongaussian_bench bench;
    struct ranker *ranker = NULL;
    double figures[FIGURES], times[REPEATS];
    double *sorted = array_create(n, sizeof *sorted), *placed = array_create(n, sizeof *placed);
    if (!sorted || !placed) {
        free(sorted);
        free(placed);
        return error_memory(err, 2 * n * sizeof *sorted, "heights");
    }
    int status = bench_create(&bench, 16, 8, &options, err);
    if (!status)
        status = bench_surface(&bench, 0, figures, err);
    if (!status)
        status = ranker_create(&ranker, n, err);
    if (!status) {
        memcpy(sorted, bench.z, n * sizeof *sorted);
        status = rank_sort(ranker, sorted, err);
    }
    for (int r = 0; !status && r < REPEATS; r++) {
        double start = cpu_ms();
        status = rank_place(ranker, bench.z, sorted, placed, err);
        times[r] = cpu_ms() - start;
    }
    if (!status) {
        size_t wrong = 0; /* the ranking of a surface's own heights gives the surface back */
        for (size_t i = 0; i < n; i++)
            wrong += placed[i] != bench.z[i];
        printf("rank of 1024 x 1024 heights: %.1f ms, %zu out of place\n", median(times, REPEATS),
               wrong);
    }
    bench_destroy(&bench);
    ranker_destroy(&ranker);
    free(sorted);
    free(placed);
    return status;
}

static int time_variant(const char *name, const struct surface_options *options,
                        struct error *err) {
    struct nongaussian_bench bench;
    double figures[FIGURES] = {0}, times[REPEATS], counts = 0;
    int status = bench_create(&bench, 16, 8, options, err);
    int repeats =
        options->max_iterations > 100 && options->iteration == ITERATION_PLAIN ? 1 : REPEATS;
    for (int r = 0; !status && r < repeats; r++) {
        status = bench_surface(&bench, (uint64_t)r, figures, err);
        times[r] = bench.ms;
        counts += figures[COUNT] / repeats;
    }
    if (!status) {
        double ms = median(times, (size_t)repeats);
        const struct surface_report *report = &bench.report;
        printf("%-24s %4zu %9.1f %9.2f %9.0f   %.1e %.1e %.1e\n", name, report->iterations, ms,
               ms / (double)report->iterations, counts, report->eps_h, report->eps_s,
               report->eps_s0);
    }
    bench_destroy(&bench);
    return status;
}

static int short_bench(struct error *err) {
    struct surface_options relaxed = maximum(), twice = maximum(), stalled = maximum();
    struct surface_options ten = plain(10), hundred = plain(120);
    twice.relaxed_iterations *= 2;
    stalled.iteration = ITERATION_PLAIN;
    int status = time_rank(err);
    printf("%-24s %4s %9s %9s %9s   %s\n", "C = 1 maximum, N = 1024", "its", "ms", "ms/it",
           "summits", "eps_h eps_s eps_s0 (of the last surface)");
    if (!status)
        status = time_variant("relaxed (default)", &relaxed, err);
    if (!status)
        status = time_variant("relaxed, doubled", &twice, err);
    if (!status)
        status = time_variant("plain, 10", &ten, err);
    if (!status)
        status = time_variant("plain, 120", &hundred, err);
    if (!status)
        status = time_variant("plain, stall rule", &stalled, err);
    return status;
}

/* --- the long bench --- */

static int compare(const char *name, const struct surface_options *options, const double *limit,
                   size_t surfaces, struct error *err) {
    struct nongaussian_bench bench;
    double sum[FIGURES] = {0}, square[FIGURES] = {0}, mean[FIGURES] = {0}, ms = 0;
    int status = bench_create(&bench, 4, 8, options, err);
    for (size_t r = 0; !status && r < surfaces; r++) {
        double figures[FIGURES];
        status = bench_surface(&bench, r, figures, err);
        ms += bench.ms;
        for (int f = 0; f < FIGURES; f++) {
            double difference = figures[f] - limit[r * FIGURES + (size_t)f];
            sum[f] += difference;
            square[f] += difference * difference;
            mean[f] += limit[r * FIGURES + (size_t)f];
        }
    }
    double n = (double)surfaces;
    for (int f = 0; !status && f < FIGURES; f++) {
        double difference = sum[f] / n;
        double error = sqrt((square[f] / n - difference * difference) / (n - 1));
        printf("%-20s %-20s %+8.3f %% +- %.3f %%   %+5.1f standard errors   %7.1f ms\n", name,
               NAMES[f], 100 * difference / (mean[f] / n), 100 * error / (mean[f] / n),
               difference / error, ms / n);
    }
    bench_destroy(&bench);
    return status;
}

static int long_bench(size_t surfaces, struct error *err) {
    struct nongaussian_bench bench;
    struct surface_options limit_options = plain(1500), relaxed = maximum(), twice = maximum();
    struct surface_options stalled = maximum(), plain_400 = plain(400);
    double *limit = array_create(surfaces * FIGURES, sizeof *limit);
    if (!limit)
        return error_memory(err, surfaces * FIGURES * sizeof *limit, "figures");
    int status = bench_create(&bench, 4, 8, &limit_options, err);
    for (size_t r = 0; !status && r < surfaces; r++)
        status = bench_surface(&bench, r, limit + r * FIGURES, err);
    twice.relaxed_iterations *= 4;
    stalled.iteration = ITERATION_PLAIN;
    printf("%zu surfaces of 256 x 256 (ratio 4), C = 1 maximum, against 1500 plain iterations\n",
           surfaces);
    if (!status)
        status = compare("relaxed (default)", &relaxed, limit, surfaces, err);
    if (!status)
        status = compare("relaxed, 4 times", &twice, limit, surfaces, err);
    if (!status)
        status = compare("plain, stall rule", &stalled, limit, surfaces, err);
    if (!status)
        status = compare("plain, 400", &plain_400, limit, surfaces, err);
    bench_destroy(&bench);
    free(limit);
    return status;
}

int main(int argc, char **argv) {
    struct error err = {0};
    bool is_long = argc > 1 && strcmp(argv[1], "long") == 0;
    int status =
        is_long ? long_bench(argc > 2 ? strtoul(argv[2], NULL, 10) : 200, &err) : short_bench(&err);
    if (status)
        fprintf(stderr, "bench_nongaussian: %s\n", err.text);
    return status ? 1 : 0;
}
