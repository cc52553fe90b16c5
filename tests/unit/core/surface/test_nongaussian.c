/* Protects: what non-Gaussian generation promises of every surface: the exact spectrum or the exact
 * heights, errors that are those of the returned pair, an end for every tolerance, refusals instead
 * of NaN. */
#include "core/surface/iteration/height_error.h"
#include "core/surface/iteration/nongaussian.h"
#include "core/surface/iteration/rank.h"
#include "core/surface/iteration/target_heights.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct random_key KEY = {11, 3, 5};

static struct spectrum self_affine(double longest, double shortest) {
    return (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                             .hurst = 0.8,
                             .wavelength_long = longest,
                             .wavelength_rolloff = longest,
                             .wavelength_short = shortest,
                             .scale = SCALE_RMS_HEIGHT,
                             .scale_value = 2.5e-7};
}

static const enum surface_iteration ITERATIONS[] = {ITERATION_RELAXED, ITERATION_PLAIN,
                                                    ITERATION_REFLECTIONS, ITERATION_MOMENTUM};
enum { ITERATION_COUNT = sizeof ITERATIONS / sizeof *ITERATIONS };

static struct surface_options weibull(enum heights_type type, double shape) {
    struct surface_options options = SURFACE_DEFAULTS;
    options.heights = (struct heights){.type = type, .shape = shape};
    return options;
}

/* One surface and all that made it. */
struct height_sample {
    struct grid grid;
    struct generator *generator;
    double *z;
    struct surface_report report;
};

static int sample_create(struct height_sample *s, struct grid grid, const struct spectrum *spectrum,
                         const struct surface_options *options, struct error *err) {
    *s = (struct height_sample){.grid = grid};
    int status = generator_create(&s->generator, spectrum, &grid, options, err);
    if (status)
        return status;
    s->z = malloc(grid_points(&grid) * sizeof *s->z);
    assert_non_null(s->z);
    return generator_run(s->generator, KEY, s->z, &s->report, err);
}

static void sample_destroy(struct height_sample *s) {
    generator_destroy(&s->generator);
    free(s->z);
}

/* Largest |(power of z) / (power of modes) - 1|, and the power elsewhere over the whole one. */
static double spectrum_departure(const struct height_sample *s, double *elsewhere) {
    const struct modes *modes = generator_modes(s->generator);
    const struct grid *grid = &s->grid;
    struct transform *transform = NULL;
    assert_int_equal(transform_create(&transform, grid, grid->nx / 2, grid->ny / 2, NULL), 0);
    transform_forward(transform, s->z);
    const double complex *spectrum = transform_spectrum(transform);
    double worst = 0, whole = 0;
    *elsewhere = 0;
    for (size_t mx = 0; mx <= grid->nx / 2; mx++)
        for (size_t row = 0; row < grid->ny; row++) {
            long my = row <= grid->ny / 2 ? (long)row : (long)row - (long)grid->ny;
            bool inside = mx <= modes->mode_x && (size_t)labs(my) <= modes->mode_y;
            double wanted = inside ? modes_power(modes, mx, my) : 0;
            double had = pow(cabs(spectrum[mx * grid->ny + row]), 2);
            whole += had;
            if (wanted > 0)
                worst = fmax(worst, fabs(had / wanted - 1));
            else
                *elsewhere += had;
        }
    *elsewhere /= whole;
    transform_destroy(&transform);
    return worst;
}

static void check_report(const struct surface_report *report) {
    const double errors[] = {report->eps_h, report->eps_s, report->eps_s0, report->eps_s_amplitude,
                             report->eps_s0_amplitude};
    for (size_t e = 0; e < sizeof errors / sizeof *errors; e++)
        assert_true(errors[e] >= 0 && isfinite(errors[e]));
    assert_true(report->end == END_CONVERGED || report->end == END_STALLED ||
                report->end == END_LIMIT);
    assert_true(report->iterations > 0);
}

/* 1e-12: rounding of one transform pair, relative to the smallest mode kept. */
static void kept_spectrum_is_exact(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {
        {128, 128, 1, 1}, {97, 61, 1, 1}, {60, 250, 1, 2}, {2048, 1, 1, 1}, {32, 32, 1, 1}};
    struct spectrum spectrum = self_affine(0.5, 1. / 16); /* 32 x 32: two points a wave */
    for (int iteration = 0; iteration < ITERATION_COUNT; iteration++)
        for (size_t g = 0; g < sizeof GRIDS / sizeof *GRIDS; g++) {
            struct surface_options options = weibull(HEIGHTS_WEIBULL_MAX, 1);
            options.iteration = ITERATIONS[iteration];
            struct height_sample s;
            assert_int_equal(sample_create(&s, GRIDS[g], &spectrum, &options, NULL), 0);
            double elsewhere;
            check_close(spectrum_departure(&s, &elsewhere), 0, 1e-12);
            check_close(elsewhere, 0, 1e-24);
            check_report(&s.report);
            sample_destroy(&s);
        }
}

/* With random amplitudes the spectrum to be had is that of the Gaussian start of the same key, and
 * so changes from run to run, to rounding. */
static void random_amplitudes_are_those_of_the_start(void **state) {
    (void)state;
    struct grid grid = {64, 48, 1, 1};
    struct spectrum spectrum = self_affine(0.5, 1. / 8);
    struct surface_options options = weibull(HEIGHTS_WEIBULL_MAX, 1), gaussian = SURFACE_DEFAULTS;
    struct height_sample s, start;
    struct transform *transform = NULL, *other = NULL;
    options.amplitudes = gaussian.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(sample_create(&s, grid, &spectrum, &options, NULL), 0);
    assert_int_equal(sample_create(&start, grid, &spectrum, &gaussian, NULL), 0);
    assert_int_equal(transform_create(&transform, &grid, 32, 24, NULL), 0);
    assert_int_equal(transform_create(&other, &grid, 32, 24, NULL), 0);
    for (uint64_t r = 0; r < 3; r++) {
        const struct random_key key = {11, 3, r};
        double largest = 0;
        assert_int_equal(generator_run(s.generator, key, s.z, &s.report, NULL), 0);
        assert_int_equal(generator_run(start.generator, key, start.z, NULL, NULL), 0);
        check_report(&s.report);
        transform_forward(transform, s.z);
        transform_forward(other, start.z);
        for (size_t k = 0; k < 33 * 48; k++)
            largest = fmax(largest, cabs(transform_spectrum(other)[k]));
        for (size_t k = 0; k < 33 * 48; k++)
            check_close(cabs(transform_spectrum(transform)[k]), cabs(transform_spectrum(other)[k]),
                        1e-12 * largest);
    }
    transform_destroy(&transform);
    transform_destroy(&other);
    sample_destroy(&s);
    sample_destroy(&start);
}

static int by_value(const void *a, const void *b) {
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* Sorted, the surface is the standardised quantiles times the RMS height. */
static void kept_heights_are_exact(void **state) {
    (void)state;
    struct grid grid = {81, 64, 1, 1};
    struct spectrum spectrum = self_affine(0.5, 1. / 12);
    struct surface_options options = weibull(HEIGHTS_WEIBULL_MIN, 1.5);
    options.keep = KEEP_HEIGHTS;
    options.draw = DRAW_QUANTILES;
    struct height_sample s;
    assert_int_equal(sample_create(&s, grid, &spectrum, &options, NULL), 0);
    size_t n = grid_points(&grid);
    qsort(s.z, n, sizeof *s.z, by_value);
    struct height_moments moments;
    struct ranker *ranker = NULL;
    double *target = malloc(n * sizeof *target);
    assert_non_null(target);
    assert_int_equal(heights_moments(&options.heights, &moments, NULL), 0);
    assert_int_equal(ranker_create(&ranker, n, NULL), 0);
    assert_int_equal(target_heights_draw(&options.heights, &moments, DRAW_QUANTILES, KEY, n, ranker,
                                         target, NULL),
                     0);
    for (size_t i = 0; i < n; i++)
        check_close(s.z[i], 2.5e-7 * target[i], 1e-13 * 2.5e-7 * fmax(1, fabs(target[i])));
    ranker_destroy(&ranker);
    free(target);
    sample_destroy(&s);
}

/* Drawn heights have zero mean and unit deviation as a sample, rise, and repeat. */
static void drawn_heights_are_standardised(void **state) {
    (void)state;
    enum { N = 30011 };
    struct heights heights = {.type = HEIGHTS_WEIBULL_MAX, .shape = 0.5};
    struct height_moments moments;
    struct ranker *ranker = NULL;
    double *first = malloc(N * sizeof *first), *again = malloc(N * sizeof *again);
    assert_true(first && again);
    assert_int_equal(heights_moments(&heights, &moments, NULL), 0);
    assert_int_equal(ranker_create(&ranker, N, NULL), 0);
    for (int draw = DRAW_RANDOM; draw <= DRAW_QUANTILES; draw++) {
        enum surface_draw kind = draw ? DRAW_QUANTILES : DRAW_RANDOM;
        assert_int_equal(target_heights_draw(&heights, &moments, kind, KEY, N, ranker, first, NULL),
                         0);
        assert_int_equal(target_heights_draw(&heights, &moments, kind, KEY, N, ranker, again, NULL),
                         0);
        assert_memory_equal(first, again, N * sizeof *first);
        double mean = 0, square = 0;
        for (size_t i = 0; i < N; i++) {
            assert_true(i == 0 || first[i] >= first[i - 1]);
            mean += first[i] / N;
            square += first[i] * first[i] / N;
        }
        check_close(mean, 0, 1e-13); /* rounding of N naive additions of this test */
        check_close(square, 1, 1e-12);
    }
    ranker_destroy(&ranker);
    free(first);
    free(again);
}

/* What lets cases of other shapes be compared: drawn heights of every distribution are quantiles of
 * the same uniform numbers, those of the key. Weibull heights are (-log(1 - p))^(1/C); shift and
 * scale, which the sample sets, drop out of the ratio. */
static void shapes_are_drawn_by_the_same_numbers(void **state) {
    (void)state;
    enum { N = 500 };
    static const double SHAPES[] = {0.8, 1, 2, 3.602};
    double p[N], drawn[N];
    struct ranker *ranker = NULL;
    random_uniform(KEY, STREAM_HEIGHTS, 0, N, p);
    qsort(p, N, sizeof *p, by_value);
    assert_int_equal(ranker_create(&ranker, N, NULL), 0);
    for (size_t c = 0; c < sizeof SHAPES / sizeof *SHAPES; c++) {
        struct heights heights = {.type = HEIGHTS_WEIBULL_MIN, .shape = SHAPES[c]};
        struct height_moments moments;
        double z[N];
        assert_int_equal(heights_moments(&heights, &moments, NULL), 0);
        assert_int_equal(
            target_heights_draw(&heights, &moments, DRAW_RANDOM, KEY, N, ranker, drawn, NULL), 0);
        for (size_t i = 0; i < N; i++)
            z[i] = pow(-log1p(-p[i]), 1 / SHAPES[c]);
        for (size_t i = 0; i < N; i++)
            check_close((drawn[i] - drawn[0]) / (drawn[N - 1] - drawn[0]),
                        (z[i] - z[0]) / (z[N - 1] - z[0]), 1e-9);
    }
    ranker_destroy(&ranker);
}

/* The errors from their definitions (3.33, 3.34), by a transform of the whole grid and a histogram
 * of its own, for the pair of which KEEP_SPECTRUM and KEEP_HEIGHTS return one each. */
static void errors_are_those_of_the_pair(void **state) {
    (void)state;
    struct grid grid = {96, 80, 1, 1};
    struct spectrum spectrum = self_affine(0.5, 0.1);
    struct surface_options options = weibull(HEIGHTS_WEIBULL_MAX, 1);
    struct height_sample s, h;
    assert_int_equal(sample_create(&s, grid, &spectrum, &options, NULL), 0);
    options.keep = KEEP_HEIGHTS;
    assert_int_equal(sample_create(&h, grid, &spectrum, &options, NULL), 0);
    const struct modes *modes = generator_modes(s.generator);
    size_t n = grid_points(&grid);
    struct transform *transform = NULL;
    assert_int_equal(transform_create(&transform, &grid, grid.nx / 2, grid.ny / 2, NULL), 0);
    transform_forward(transform, h.z);
    double band = 0, band_amplitude = 0, powers = 0, amplitudes = 0, null = 0, null_power = 0;
    double counted = 0;
    for (size_t mx = 0; mx <= grid.nx / 2; mx++)
        for (size_t row = 0; row < grid.ny; row++) {
            long my = row <= grid.ny / 2 ? (long)row : (long)row - (long)grid.ny;
            double weight = mx == 0 || 2 * mx == grid.nx ? 1 : 2;
            bool inside = mx <= modes->mode_x && (size_t)labs(my) <= modes->mode_y;
            double wanted = inside ? modes_power(modes, mx, my) : 0;
            double had = pow(cabs(transform_spectrum(transform)[mx * grid.ny + row]), 2);
            if (wanted > 0) {
                counted += weight;
                powers += weight * wanted;
                amplitudes += weight * sqrt(wanted);
                band += weight * pow(had / wanted - 1, 2);
                band_amplitude += weight * pow(sqrt(had / wanted) - 1, 2);
            } else {
                null += weight * had * had;
                null_power += weight * had;
            }
        }
    double nulls = (double)n - counted;
    check_close(counted, (double)modes->count, 0);
    check_relative(s.report.eps_s, sqrt(band / counted), 1e-9);
    check_relative(s.report.eps_s_amplitude, sqrt(band_amplitude / counted), 1e-9);
    check_relative(s.report.eps_s0, sqrt(null / nulls) / (powers / counted), 1e-9);
    check_relative(s.report.eps_s0_amplitude, sqrt(null_power / nulls) / (amplitudes / counted),
                   1e-6); /* by Parseval: a difference from 1 */
    double deviation = 2.5e-7, width = 3.49 / cbrt((double)n), distance = 0;
    int counts[2][4001] = {{0}};
    for (size_t i = 0; i < n; i++) {
        counts[0][(int)floor((s.z[i] / deviation - 1) / width) + 2000]++;
        counts[1][(int)floor((h.z[i] / deviation - 1) / width) + 2000]++;
    }
    for (int b = 0; b <= 4000; b++)
        distance += fabs((double)(counts[0][b] - counts[1][b])) / (double)n;
    /* A height on an edge may be counted on either side of it. */
    check_close(s.report.eps_h, distance, 4.0 / (double)n);
    assert_memory_equal(&s.report, &h.report, sizeof s.report);
    transform_destroy(&transform);
    sample_destroy(&s);
    sample_destroy(&h);
}

/* Surfaces with no good answer still get one, with errors that are numbers. */
static void hard_cases_end(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{2, 1, 1, 1},  {2, 2, 1, 1},    {3, 1, 1, 1},
                                        {3, 3, 1, 1},  {5, 2, 1, 1},    {7, 31, 1, 1},
                                        {64, 1, 1, 1}, {16, 128, 1, 1}, {64, 64, 1, 1}};
    static const double SHAPES[] = {0.5, 1, 20};
    struct spectrum spectrum = self_affine(1, 1); /* one wave, or one ring */
    for (size_t g = 0; g < sizeof GRIDS / sizeof *GRIDS; g++)
        for (size_t c = 0; c < 6 * ITERATION_COUNT; c++) {
            struct surface_options options =
                weibull(c % 2 ? HEIGHTS_WEIBULL_MIN : HEIGHTS_WEIBULL_MAX, SHAPES[c / 2 % 3]);
            options.iteration = ITERATIONS[c / 6];
            options.tolerance = 0;
            struct height_sample s;
            assert_int_equal(sample_create(&s, GRIDS[g], &spectrum, &options, NULL), 0);
            double square = 0;
            for (size_t i = 0; i < grid_points(&s.grid); i++)
                square += s.z[i] * s.z[i] / (double)grid_points(&s.grid);
            check_relative(sqrt(square), 2.5e-7, 1e-12);
            check_report(&s.report);
            assert_true(s.report.iterations <= options.max_iterations);
            sample_destroy(&s);
        }
}

/* The stall rule ends plain runs; a wide tolerance ends them at once; a limit is kept to. */
static void runs_end_as_they_should(void **state) {
    (void)state;
    struct grid grid = {64, 64, 1, 1};
    struct spectrum spectrum = self_affine(0.5, 1. / 8);
    struct surface_options options = weibull(HEIGHTS_WEIBULL_MAX, 1);
    options.iteration = ITERATION_PLAIN;
    struct height_sample s;
    assert_int_equal(sample_create(&s, grid, &spectrum, &options, NULL), 0);
    assert_int_equal(s.report.end, END_STALLED);
    assert_true(s.report.iterations > options.stall_iterations);
    sample_destroy(&s);
    options.tolerance = 100;
    assert_int_equal(sample_create(&s, grid, &spectrum, &options, NULL), 0);
    assert_int_equal(s.report.end, END_CONVERGED);
    assert_int_equal(s.report.iterations, 1);
    sample_destroy(&s);
    options.tolerance = 0;
    for (size_t limit = 1; limit < 8; limit++)
        for (int iteration = 0; iteration < ITERATION_COUNT; iteration++) {
            options.iteration = ITERATIONS[iteration];
            options.max_iterations = limit;
            assert_int_equal(sample_create(&s, grid, &spectrum, &options, NULL), 0);
            assert_int_equal(s.report.end, END_LIMIT);
            assert_int_equal(s.report.iterations, limit);
            sample_destroy(&s);
        }
}

/* The fast iterations work down to the tolerance: a lower one takes more of them and is reached,
 * until they stall, whatever is asked beyond. */
static void tolerances_are_reached(void **state) {
    (void)state;
    static const double TOLERANCES[] = {0.3, 0.1, 0.05, 0.03, 1e-3, 1e-6};
    enum { REACHED = 4, COUNT = sizeof TOLERANCES / sizeof *TOLERANCES };
    struct grid grid = {128, 128, 1, 1};
    struct spectrum spectrum = self_affine(0.25, 1. / 16);
    for (int iteration = 2; iteration < ITERATION_COUNT; iteration++) {
        size_t iterations[COUNT];
        for (size_t a = 0; a < COUNT; a++) {
            struct surface_options options = weibull(HEIGHTS_WEIBULL_MIN, 1);
            options.iteration = ITERATIONS[iteration];
            options.tolerance = TOLERANCES[a];
            struct height_sample s;
            assert_int_equal(sample_create(&s, grid, &spectrum, &options, NULL), 0);
            double worst = fmax(s.report.eps_h, fmax(s.report.eps_s, s.report.eps_s0));
            assert_int_equal(s.report.end, a < REACHED ? END_CONVERGED : END_STALLED);
            assert_true(a >= REACHED || worst <= TOLERANCES[a]);
            assert_true(a == 0 || s.report.iterations >= iterations[a - 1]);
            iterations[a] = s.report.iterations;
            sample_destroy(&s);
        }
        assert_true(iterations[REACHED] > 2 * iterations[1]);
        assert_int_equal(iterations[COUNT - 1], iterations[REACHED]);
    }
}

/* Where heights are nearly Gaussian, spectrum and heights are both had to 0.4 %: measured 0.2. */
static void easy_heights_converge(void **state) {
    (void)state;
    struct grid grid = {512, 512, 1, 1};
    struct spectrum spectrum = self_affine(0.125, 1. / 64);
    struct surface_options options = weibull(HEIGHTS_WEIBULL_MAX, 3.602);
    options.iteration = ITERATION_REFLECTIONS;
    options.tolerance = 4e-3;
    struct height_sample s;
    assert_int_equal(sample_create(&s, grid, &spectrum, &options, NULL), 0);
    assert_int_equal(s.report.end, END_CONVERGED);
    assert_true(s.report.eps_h <= 4e-3 && s.report.iterations < 60);
    sample_destroy(&s);
}

/* A second run of a generator has the bits of a first one: nothing of a run stays behind. */
static void runs_repeat(void **state) {
    (void)state;
    struct grid grid = {64, 48, 1, 1};
    struct spectrum spectrum = self_affine(0.5, 1. / 8);
    struct surface_options options = weibull(HEIGHTS_WEIBULL_MIN, 1.2);
    struct height_sample s;
    assert_int_equal(sample_create(&s, grid, &spectrum, &options, NULL), 0);
    size_t n = grid_points(&grid);
    double *again = malloc(n * sizeof *again);
    assert_non_null(again);
    struct surface_report report;
    struct random_key other = {1, 2, 3};
    assert_int_equal(generator_run(s.generator, other, again, NULL, NULL), 0);
    assert_memory_not_equal(again, s.z, n * sizeof *again);
    assert_int_equal(generator_run(s.generator, KEY, again, &report, NULL), 0);
    assert_memory_equal(again, s.z, n * sizeof *again);
    assert_memory_equal(&report, &s.report, sizeof report);
    free(again);
    sample_destroy(&s);
}

static double three_values(double p, const void *context) {
    (void)context;
    return p < 0.3 ? -1 : p < 0.9 ? 0 : 4;
}
static double normal_but_for_the_middle(double p, const void *context) {
    (void)context;
    return p == 0.5 ? NAN : log(p / (1 - p));
}

/* Heights with ties are assigned; a quantile function that fails only where it is used is
 * reported. */
static void quantile_functions_are_used(void **state) {
    (void)state;
    struct grid grid = {63, 63, 1, 1};
    struct spectrum spectrum = self_affine(0.5, 1. / 8);
    struct surface_options options = SURFACE_DEFAULTS;
    options.heights = (struct heights){.type = HEIGHTS_QUANTILE, .quantile = three_values};
    options.keep = KEEP_HEIGHTS;
    options.draw = DRAW_QUANTILES;
    struct height_sample s;
    assert_int_equal(sample_create(&s, grid, &spectrum, &options, NULL), 0);
    check_report(&s.report);
    qsort(s.z, grid_points(&grid), sizeof *s.z, by_value);
    size_t different = 1;
    for (size_t i = 1; i < grid_points(&grid); i++)
        different += s.z[i] != s.z[i - 1];
    assert_int_equal(different, 3);
    sample_destroy(&s);
    struct error err;
    options.heights.quantile = normal_but_for_the_middle; /* (i + 1/2)/63^2 meets 1/2 */
    int status = sample_create(&s, grid, &spectrum, &options, &err);
    assert_true(status == ERROR_NUMERIC || status == ERROR_INPUT);
    sample_destroy(&s);
}

static void bad_options_are_refused(void **state) {
    (void)state;
    struct grid grid = {32, 32, 1, 1};
    struct spectrum spectrum = self_affine(0.5, 0.25);
    struct error err;
    for (int fault = 0; fault < 9; fault++) {
        struct surface_options options = weibull(HEIGHTS_WEIBULL_MAX, fault == 0 ? 0.4 : 1);
        options.tolerance = fault == 1 ? -1 : fault == 2 ? NAN : 1e-3;
        options.stall_gain = fault == 3 ? 1 : fault == 4 ? -0.1 : 0.05;
        options.stall_iterations = fault == 5 ? 0 : 10;
        options.max_iterations = fault == 6 ? 0 : 10;
        options.relaxation = fault == 7 ? 0 : fault == 8 ? 1.1 : 0.8;
        struct generator *generator = NULL;
        assert_int_equal(generator_create(&generator, &spectrum, &grid, &options, &err),
                         ERROR_INPUT);
        assert_null(generator);
        assert_true(strlen(err.text) > 10);
    }
}

static int stop_at_last(void *context) {
    size_t *left = context;
    bool last = *left == 0;
    *left -= last ? 0 : 1;
    return last;
}

/* At whichever iteration, of whichever phase; ITERATION_RELAXED has 43. */
static void runs_stop_when_told(void **state) {
    (void)state;
    const struct grid grid = {64, 64, 1, 1};
    struct spectrum spectrum = self_affine(0.5, 1. / 16);
    for (int iteration = 0; iteration < ITERATION_COUNT; iteration++)
        for (size_t most = 0; most < 43; most += 6) {
            struct surface_options options = weibull(HEIGHTS_WEIBULL_MAX, 1);
            struct height_sample s;
            struct error err = {0};
            size_t left = most;
            options.iteration = ITERATIONS[iteration];
            options.tolerance = 0;
            options.stall_gain = 0;
            options.stall_iterations = 1000;
            options.stop = stop_at_last;
            options.stop_context = &left;
            assert_int_equal(sample_create(&s, grid, &spectrum, &options, &err), ERROR_STOPPED);
            sample_destroy(&s);
        }
}

/* Errors with tolerances of their own end the run where each is within its own; the same three as
 * one do nothing. */
static void errors_have_their_own_tolerances(void **state) {
    (void)state;
    const struct grid grid = {128, 128, 1, 1};
    const struct spectrum spectrum = self_affine(0.25, 1. / 16);
    struct surface_options options = weibull(HEIGHTS_WEIBULL_MIN, 1);
    struct height_sample wide, narrow, same;
    struct error err = {0};
    options.tolerance = 0.03;
    assert_int_equal(sample_create(&narrow, grid, &spectrum, &options, &err), 0);
    options.tolerance_h = options.tolerance_s = options.tolerance_s0 = 0.03;
    assert_int_equal(sample_create(&same, grid, &spectrum, &options, &err), 0);
    assert_int_equal(same.report.iterations, narrow.report.iterations);
    assert_memory_equal(same.z, narrow.z, grid_points(&grid) * sizeof *same.z);
    options.tolerance_h = 0.3;
    options.tolerance_s = options.tolerance_s0 = 0; /* as tolerance */
    assert_int_equal(sample_create(&wide, grid, &spectrum, &options, &err), 0);
    assert_true(wide.report.end == END_CONVERGED && narrow.report.end == END_CONVERGED);
    assert_true(wide.report.iterations < narrow.report.iterations);
    assert_true(wide.report.eps_h <= 0.3 && wide.report.eps_h > 0.03);
    assert_true(wide.report.eps_s <= 0.03 && wide.report.eps_s0 <= 0.03);
    sample_destroy(&wide);
    sample_destroy(&narrow);
    sample_destroy(&same);
    options.tolerance = 0;
    assert_int_equal(sample_create(&same, grid, &spectrum, &options, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "beside a tolerance above 0"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kept_spectrum_is_exact),
        cmocka_unit_test(random_amplitudes_are_those_of_the_start),
        cmocka_unit_test(kept_heights_are_exact),
        cmocka_unit_test(drawn_heights_are_standardised),
        cmocka_unit_test(shapes_are_drawn_by_the_same_numbers),
        cmocka_unit_test(errors_are_those_of_the_pair),
        cmocka_unit_test(hard_cases_end),
        cmocka_unit_test(runs_end_as_they_should),
        cmocka_unit_test(tolerances_are_reached),
        cmocka_unit_test(errors_have_their_own_tolerances),
        cmocka_unit_test(easy_heights_converge),
        cmocka_unit_test(runs_repeat),
        cmocka_unit_test(runs_stop_when_told),
        cmocka_unit_test(quantile_functions_are_used),
        cmocka_unit_test(bad_options_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
