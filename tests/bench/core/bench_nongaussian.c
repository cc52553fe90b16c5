/* Non-Gaussian surfaces: what an iteration costs, and what surfaces each kind of iteration finds.
 * CPU time, one core.
 *
 *   bench_nongaussian            N = 1024, C = 1 maximum (ratio 16, 8 points a shortest wave)
 *   bench_nongaussian paths [n]  n (8) surfaces of 256 x 256 a case: Weibull minimum and maximum, H
 *                                0.2 and 0.8, ratio 4 and 8, C = 1 and 2; in percent against 1500
 *                                plain iterations, in pairs
 *   bench_nongaussian drift [n]  n (16) surfaces: C = 1, H = 0.8, ratio 4, more iterations, against
 *                                6000 plain ones */
#include "core/statistics/summits/summits.h"
#include "core/surface/iteration/rank.h"
#include "core/surface/surface.h"
#include "tests/support/timing.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static struct spectrum self_affine(double hurst, double ratio) {
    return (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                             .hurst = hurst,
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

/* Cells of `length` longest waves, 8 points a shortest wave. */
static int bench_create(struct nongaussian_bench *bench, double hurst, double ratio, double length,
                        const struct surface_options *options, struct error *err) {
    size_t n = (size_t)(8 * ratio * length);
    struct spectrum spectrum = self_affine(hurst, ratio);
    *bench = (struct nongaussian_bench){.grid = {n, n, length * ratio, length * ratio}};
    bench->z = array_create(n * n, sizeof *bench->z);
    int status = bench->z != NULL ? 0 : error_memory(err, n * n * sizeof *bench->z, "heights");
    if (status == 0)
        status = generator_create(&bench->generator, &spectrum, &bench->grid, options, err);
    if (status == 0)
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
    if (status == 0)
        status = summits_find(bench->finder, bench->z, &bench->summits, err);
    if (status != 0)
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

/* iterations: 0: as many as it takes by default; else so many. */
static struct surface_options iterated(enum surface_iteration iteration, size_t iterations) {
    struct surface_options options = SURFACE_DEFAULTS;
    options.heights = (struct heights){.type = HEIGHTS_WEIBULL_MAX, .shape = 1};
    options.iteration = iteration;
    if (iterations > 0) {
        options.max_iterations = iterations;
        options.tolerance = 0;
        options.stall_iterations = iterations; /* never stuck before the limit */
    }
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
    int status = bench_create(&bench, 0.8, 16, 8, &options, err);
    if (status == 0)
        status = bench_surface(&bench, 0, figures, err);
    if (status == 0)
        status = ranker_create(&ranker, n, err);
    if (status == 0) {
        memcpy(sorted, bench.z, n * sizeof *sorted);
        status = rank_sort(ranker, sorted, err);
    }
    for (int r = 0; !status && r < REPEATS; r++) {
        double start = cpu_ms();
        status = rank_order(ranker, bench.z, sorted, placed, err);
        times[r] = cpu_ms() - start;
    }
    if (status == 0) {
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
    int status = bench_create(&bench, 0.8, 16, 8, options, err);
    int repeats =
        options->max_iterations > 100 && options->iteration == ITERATION_PLAIN ? 1 : REPEATS;
    for (int r = 0; !status && r < repeats; r++) {
        status = bench_surface(&bench, (uint64_t)r, figures, err);
        times[r] = bench.ms;
        counts += figures[COUNT] / repeats;
    }
    if (status == 0) {
        double ms = median(times, (size_t)repeats);
        const struct surface_report *report = &bench.report;
        printf("%-24s %4zu %9.1f %9.2f %9.0f   %.1e %.1e %.1e\n", name, report->iterations, ms,
               ms / (double)report->iterations, counts, report->eps_h, report->eps_s,
               report->eps_s0);
    }
    bench_destroy(&bench);
    return status;
}

struct variant {
    const char *name;
    enum surface_iteration iteration;
    size_t iterations;
};

static int short_bench(struct error *err) {
    static const struct variant VARIANTS[] = {{"relaxed", ITERATION_RELAXED, 0},
                                              {"reflections", ITERATION_REFLECTIONS, 0},
                                              {"reflections, 63", ITERATION_REFLECTIONS, 63},
                                              {"momentum", ITERATION_MOMENTUM, 0},
                                              {"plain, 10", ITERATION_PLAIN, 10},
                                              {"plain, 120", ITERATION_PLAIN, 120},
                                              {"plain, stall rule", ITERATION_PLAIN, 0}};
    int status = time_rank(err);
    printf("%-24s %4s %9s %9s %9s   %s\n", "C = 1 maximum, N = 1024", "its", "ms", "ms/it",
           "summits", "eps_h eps_s eps_s0 (of the last surface)");
    for (size_t v = 0; status == 0 && v < sizeof VARIANTS / sizeof *VARIANTS; v++) {
        struct surface_options options = iterated(VARIANTS[v].iteration, VARIANTS[v].iterations);
        status = time_variant(VARIANTS[v].name, &options, err);
    }
    return status;
}

/* --- the long benches --- */

/* One kind of surfaces, and the figures of those that others are compared with. */
struct path_case {
    enum heights_type type;
    double hurst, ratio, length, shape;
    size_t surfaces;
    double *limit; /* surfaces x FIGURES */
};

static struct surface_options case_options(const struct path_case *one_case,
                                           const struct variant *variant) {
    struct surface_options options = iterated(variant->iteration, variant->iterations);
    options.heights = (struct heights){.type = one_case->type, .shape = one_case->shape};
    return options;
}

/* Runs the surfaces of a variant into the limit, or prints what they differ from it. */
static int path_run(struct path_case *one_case, const struct variant *variant, bool into_limit,
                    struct error *err) {
    struct nongaussian_bench bench;
    struct surface_options options = case_options(one_case, variant);
    double sum[FIGURES] = {0}, square[FIGURES] = {0}, eps_h = 0, ms = 0, iterations = 0;
    double n = (double)one_case->surfaces;
    int status =
        bench_create(&bench, one_case->hurst, one_case->ratio, one_case->length, &options, err);
    for (size_t r = 0; status == 0 && r < one_case->surfaces; r++) {
        double figures[FIGURES], *limit = one_case->limit + r * FIGURES;
        status = bench_surface(&bench, r, figures, err);
        eps_h += bench.report.eps_h / n;
        iterations += (double)bench.report.iterations / n;
        ms += bench.ms / n;
        for (int f = 0; f < FIGURES; f++) {
            double percent = 100 * (figures[f] / limit[f] - 1);
            sum[f] += percent / n;
            square[f] += percent * percent / n;
            if (into_limit)
                limit[f] = figures[f];
        }
    }
    printf("%-16s %-16s %4g %4g %3g %5.0f %8.1f %8.4f", variant->name,
           one_case->type == HEIGHTS_WEIBULL_MAX ? "maximum" : "minimum", one_case->hurst,
           one_case->ratio, one_case->shape, iterations, ms, eps_h);
    for (int f = 0; f < FIGURES && !into_limit; f++)
        printf("  %+5.1f (%.1f)", sum[f], sqrt((square[f] - sum[f] * sum[f]) / (n - 1)));
    printf("\n");
    fflush(stdout);
    bench_destroy(&bench);
    return status;
}

static int path_case_run(struct path_case *one_case, size_t count, const struct variant *variants,
                         struct error *err) {
    one_case->limit = array_create(one_case->surfaces * FIGURES, sizeof *one_case->limit);
    if (one_case->limit == NULL)
        return error_memory(err, one_case->surfaces * FIGURES * sizeof(double), "figures");
    int status = path_run(one_case, &variants[0], true, err);
    for (size_t v = 1; status == 0 && v < count; v++)
        status = path_run(one_case, &variants[v], false, err);
    free(one_case->limit);
    return status;
}

static void print_head(size_t surfaces) {
    printf("%zu surfaces of 256 x 256 each, percent against the first row of a case (standard "
           "error)\n%-16s %-16s %4s %4s %3s %5s %8s %8s",
           surfaces, "path", "distribution", "H", "rat.", "C", "its", "ms", "eps_h");
    for (int f = 0; f < FIGURES; f++)
        printf("  %s", NAMES[f]);
    printf("\n");
}

static int paths_bench(size_t surfaces, struct error *err) {
    static const struct variant VARIANTS[] = {{"plain, 1500", ITERATION_PLAIN, 1500},
                                              {"relaxed", ITERATION_RELAXED, 0},
                                              {"reflections", ITERATION_REFLECTIONS, 0},
                                              {"momentum", ITERATION_MOMENTUM, 0}};
    int status = 0;
    print_head(surfaces);
    for (int c = 0; status == 0 && c < 16; c++) {
        double ratio = c & 4 ? 8 : 4;
        struct path_case one_case = {.type = c & 1 ? HEIGHTS_WEIBULL_MIN : HEIGHTS_WEIBULL_MAX,
                                     .hurst = c & 2 ? 0.2 : 0.8,
                                     .ratio = ratio,
                                     .length = 32 / ratio,
                                     .shape = c & 8 ? 2 : 1,
                                     .surfaces = surfaces};
        status = path_case_run(&one_case, sizeof VARIANTS / sizeof *VARIANTS, VARIANTS, err);
    }
    return status;
}

static int drift_bench(size_t surfaces, struct error *err) {
    static const struct variant VARIANTS[] = {{"plain, 6000", ITERATION_PLAIN, 6000},
                                              {"plain, 1500", ITERATION_PLAIN, 1500},
                                              {"plain, stall", ITERATION_PLAIN, 0},
                                              {"relaxed", ITERATION_RELAXED, 0},
                                              {"reflections", ITERATION_REFLECTIONS, 0},
                                              {"reflections, 140", ITERATION_REFLECTIONS, 140},
                                              {"reflections, 500", ITERATION_REFLECTIONS, 500},
                                              {"momentum", ITERATION_MOMENTUM, 0},
                                              {"momentum, 140", ITERATION_MOMENTUM, 140},
                                              {"momentum, 500", ITERATION_MOMENTUM, 500}};
    int status = 0;
    print_head(surfaces);
    for (int c = 0; status == 0 && c < 2; c++) {
        struct path_case one_case = {.type = c == 1 ? HEIGHTS_WEIBULL_MIN : HEIGHTS_WEIBULL_MAX,
                                     .hurst = 0.8,
                                     .ratio = 4,
                                     .length = 8,
                                     .shape = 1,
                                     .surfaces = surfaces};
        status = path_case_run(&one_case, sizeof VARIANTS / sizeof *VARIANTS, VARIANTS, err);
    }
    return status;
}

int main(int argc, char **argv) {
    struct error err = {0};
    const char *which = argc > 1 ? argv[1] : "";
    size_t surfaces = argc > 2 ? strtoul(argv[2], NULL, 10) : 0;
    int status;
    if (strcmp(which, "paths") == 0)
        status = paths_bench(surfaces > 1 ? surfaces : 8, &err);
    else if (strcmp(which, "drift") == 0)
        status = drift_bench(surfaces > 1 ? surfaces : 16, &err);
    else
        status = short_bench(&err);
    if (status != 0)
        fprintf(stderr, "bench_nongaussian: %s\n", err.text);
    return status != 0 ? 1 : 0;
}
