/* Protects: height distributions by quantiles and by samples: that they are those of the numbers
 * given, to stated errors those of known distributions, and that no other numbers are taken. */
#include "core/surface/heights.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

enum { PERCENTS = 99 };

/* The probabilities of 1 to 99 %, and towards the ends four more each. */
enum { COUNT = PERCENTS + 8 };
static void probabilities(double p[COUNT]) {
    static const double ENDS[] = {1e-4, 5e-4, 1e-3, 3e-3};
    for (size_t a = 0; a < 4; a++) {
        p[a] = ENDS[a];
        p[COUNT - 1 - a] = 1 - ENDS[a];
    }
    for (size_t a = 0; a < PERCENTS; a++)
        p[4 + a] = (double)(a + 1) / (PERCENTS + 1);
}

static struct height_table *quantiles(size_t n, const double *p, const double *height) {
    struct height_table *table = NULL;
    struct error err = {0};
    if (height_table_of_quantiles(&table, n, p, height, &err) != 0)
        fail_msg("%s", err.text);
    return table;
}

static struct height_table *samples(size_t n, const double *sample) {
    struct height_table *table = NULL;
    struct error err = {0};
    if (height_table_of_samples(&table, n, sample, &err) != 0)
        fail_msg("%s", err.text);
    return table;
}

static struct height_moments moments_of(const struct heights *heights) {
    struct height_moments moments;
    assert_int_equal(heights_moments(heights, &moments, NULL), 0);
    return moments;
}

/* Makes the table of a known distribution's quantiles, in another unit and about another zero. */
static struct height_table *table_of(const struct heights *known) {
    double p[COUNT], height[COUNT];
    struct height_moments moments = moments_of(known);
    probabilities(p);
    for (size_t a = 0; a < COUNT; a++)
        height[a] = 1000 + 1e-3 * heights_quantile(known, &moments, p[a]);
    return quantiles(COUNT, p, height);
}

/* Gaussian quantiles lie on a line over the score, so that nothing is lost, not even beyond the
 * table. */
static void gaussian_tables_are_exact(void **state) {
    (void)state;
    struct heights gaussian = {.type = HEIGHTS_GAUSSIAN}, own = {.type = HEIGHTS_TABLE};
    struct height_table *table = table_of(&gaussian);
    own.table = table;
    struct height_moments exact = moments_of(&gaussian), moments = moments_of(&own);
    check_close(moments.skewness, 0, 1e-8);
    check_close(moments.kurtosis, 3, 1e-8);
    assert_true(isinf(moments.lowest) && isinf(moments.highest));
    for (double p = 1e-12; p < 0.5; p *= 1.7) {
        double z = heights_quantile(&gaussian, &exact, p);
        check_close(heights_quantile(&own, &moments, p), z, 1e-8 * fabs(z));
        check_close(heights_quantile(&own, &moments, 1 - p), -z, 1e-4); /* of 1 - p's digits */
        check_close(heights_cdf(&own, &moments, z), p, 1e-6 * p);
    }
    height_table_destroy(&table);
    assert_null(table);
}

/* Heights are those of the distribution to 0.001 standard deviations between the percents and 0.02
 * in the tails of the table; skewness and kurtosis hold what lies beyond it, too. */
static void weibull_tables_are_near(void **state) {
    (void)state;
    static const struct {
        enum heights_type type;
        double shape, skewness, kurtosis; /* errors */
    } CASES[] = {{HEIGHTS_WEIBULL_MIN, 1, 0.005, 0.08},
                 {HEIGHTS_WEIBULL_MAX, 1, 0.005, 0.08},
                 {HEIGHTS_WEIBULL_MIN, 2, 2e-4, 1e-3},
                 {HEIGHTS_WEIBULL_MAX, 3.602, 2e-4, 1e-3},
                 {HEIGHTS_LOGNORMAL, 0.3, 3e-3, 0.03}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct heights known = {.type = CASES[c].type, .shape = CASES[c].shape};
        struct height_table *table = table_of(&known);
        struct heights own = {.type = HEIGHTS_TABLE, .table = table};
        struct height_moments exact = moments_of(&known), moments = moments_of(&own);
        check_close(moments.skewness, exact.skewness, CASES[c].skewness);
        check_close(moments.kurtosis, exact.kurtosis, CASES[c].kurtosis);
        for (size_t a = 1; a < 10000; a++) {
            double p = (double)a / 10000, z = heights_quantile(&known, &exact, p);
            bool within = a >= 100 && a <= 9900;
            check_close(heights_quantile(&own, &moments, p), z, within ? 1e-3 : 0.02);
        }
        height_table_destroy(&table);
    }
}

static double quantile_of(double probability, const void *table) {
    return height_table_quantile(table, probability);
}

static const double LEVELS[] = {0, 0.02, 0.3, 0.31, 0.5, 0.9, 1};
static const double HEIGHTS[] = {-7, -4, -1, -0.3, 0.2, 0.9, 1.5};
static const double PLATEAU[] = {-7, -4, -1, -1, 0.2, 0.9, 0.9};
static const double SAMPLES[] = {3, 1, 2, 2, 7, 5, 9, 4, 8, 2};
enum { LEVEL_COUNT = sizeof LEVELS / sizeof *LEVELS, SAMPLE_COUNT = 10, TABLES = 4 };

static struct height_table *one_of(size_t number) {
    switch (number) {
    case 0:
        return quantiles(LEVEL_COUNT, LEVELS, HEIGHTS);
    case 1:
        return quantiles(LEVEL_COUNT - 2, LEVELS + 1, HEIGHTS + 1);
    case 2:
        return quantiles(LEVEL_COUNT, LEVELS, PLATEAU);
    default:
        return samples(SAMPLE_COUNT, SAMPLES);
    }
}

/* Against the moments of the same function by the rule for any quantile function, which has 3
 * digits at flat parts. */
static void moments_are_integrals(void **state) {
    (void)state;
    for (size_t c = 0; c < TABLES; c++) {
        struct height_table *table = one_of(c);
        struct heights own = {.type = HEIGHTS_TABLE, .table = table};
        struct heights other = {
            .type = HEIGHTS_QUANTILE, .quantile = quantile_of, .context = table};
        struct height_moments moments = moments_of(&own), again = moments_of(&other);
        check_close(moments.mean, again.mean, 2e-4 * again.deviation);
        check_close(moments.deviation, again.deviation, 2e-4 * again.deviation);
        check_close(moments.skewness, again.skewness, 2e-3);
        check_close(moments.kurtosis, again.kurtosis, 5e-3);
        height_table_destroy(&table);
    }
}

static void quantiles_rise_and_invert(void **state) {
    (void)state;
    for (size_t c = 0; c < TABLES; c++) {
        struct height_table *table = one_of(c);
        double last = -INFINITY;
        for (double p = 1e-5; p < 1; p += 3.1e-4) {
            double raw = height_table_quantile(table, p);
            assert_true(raw >= last);
            last = raw;
            /* On flat ground the share up to a height is that of its end. */
            double up_to = height_table_cdf(table, raw),
                   below = height_table_cdf(table, raw - 1e-9);
            assert_true(below <= p + 1e-9 && p - 1e-9 <= up_to);
            if (c == 1)
                check_close(up_to, p, 1e-9);
        }
        height_table_destroy(&table);
    }
}

/* The heights given are met, on whatever scale; bounds are where they were given. */
static void given_heights_are_met(void **state) {
    (void)state;
    struct height_table *table = one_of(0);
    struct heights own = {.type = HEIGHTS_TABLE, .table = table};
    struct height_moments moments = moments_of(&own);
    double low = height_table_quantile(table, LEVELS[1]);
    double unit = (height_table_quantile(table, LEVELS[5]) - low) / (HEIGHTS[5] - HEIGHTS[1]);
    for (size_t a = 1; a + 1 < LEVEL_COUNT; a++) {
        check_close(height_table_quantile(table, LEVELS[a]) - low, unit * (HEIGHTS[a] - HEIGHTS[1]),
                    1e-12);
        check_close(height_table_cdf(table, low + unit * (HEIGHTS[a] - HEIGHTS[1])), LEVELS[a],
                    1e-9);
    }
    check_close(moments.lowest * moments.deviation + moments.mean - low,
                unit * (HEIGHTS[0] - HEIGHTS[1]), 1e-12);
    check_close(moments.highest * moments.deviation + moments.mean - low,
                unit * (HEIGHTS[6] - HEIGHTS[1]), 1e-12);
    check_close(height_table_quantile(table, LEVELS[1] / 4) - low,
                unit * 0.75 * (HEIGHTS[0] - HEIGHTS[1]), 1e-12);
    assert_true(heights_cdf(&own, &moments, moments.lowest) < 1e-12);
    assert_true(heights_cdf(&own, &moments, moments.highest) == 1);
    height_table_destroy(&table);
}

/* Equal heights are flat ground of their share, in the middle as at an end. */
static void equal_heights_are_flat_ground(void **state) {
    (void)state;
    struct height_table *table = one_of(2);
    double top = height_table_quantile(table, 0.95), middle = height_table_quantile(table, 0.305);
    check_close(height_table_cdf(table, top), 1, 0);
    check_close(height_table_cdf(table, top - 1e-7), 0.9, 1e-3);
    check_close(height_table_cdf(table, middle), 0.31, 1e-3);
    check_close(height_table_cdf(table, middle - 1e-7), 0.3, 1e-3);
    height_table_destroy(&table);
    double sample[20];
    for (size_t a = 0; a < 20; a++) /* half of them on a plateau */
        sample[a] = fmin((double)a, 10);
    table = samples(20, sample);
    struct height_moments moments;
    height_table_moments(table, &moments);
    assert_true(isfinite(moments.highest) && isinf(moments.lowest));
    check_close(height_table_cdf(table, height_table_quantile(table, 0.75) - 1e-7), 0.525, 1e-3);
    height_table_destroy(&table);
}

static void order_and_unit_do_not_matter(void **state) {
    (void)state;
    double other[SAMPLE_COUNT];
    struct height_table *table = samples(SAMPLE_COUNT, SAMPLES);
    static const double UNITS[] = {1e-90, 1e98, 3};
    for (size_t u = 0; u < 3; u++) {
        for (size_t a = 0; a < SAMPLE_COUNT; a++)
            other[a] = UNITS[u] * (SAMPLES[SAMPLE_COUNT - 1 - a] - 5);
        struct height_table *again = samples(SAMPLE_COUNT, other);
        for (double p = 0.001; p < 1; p += 0.01)
            check_close(height_table_quantile(again, p), height_table_quantile(table, p), 1e-12);
        height_table_destroy(&again);
    }
    height_table_destroy(&table);
}

static void surface_of(const struct heights *heights, uint64_t realisation, double *z) {
    static const struct spectrum SPECTRUM = {.type = SPECTRUM_SELF_AFFINE,
                                             .hurst = 0.8,
                                             .wavelength_short = 1,
                                             .wavelength_long = 4,
                                             .wavelength_rolloff = 4};
    static const struct grid GRID = {64, 64, 16, 16};
    struct surface_options options = SURFACE_DEFAULTS;
    options.heights = *heights;
    struct generator *generator = NULL;
    struct error err = {0};
    if (generator_create(&generator, &SPECTRUM, &GRID, &options, &err) != 0 ||
        generator_run(generator, (struct random_key){5, 0, realisation}, z, NULL, &err) != 0)
        fail_msg("%s", err.text);
    generator_destroy(&generator);
}

static int compare(const void *a, const void *b) {
    double one = *(const double *)a, other = *(const double *)b;
    return (one > other) - (one < other);
}

/* Sorted heights of a surface made from the table are those of one made from the distribution. */
static void surfaces_are_the_same(void **state) {
    (void)state;
    enum { POINTS = 64 * 64 };
    static double known_z[POINTS], own_z[POINTS];
    for (int type = HEIGHTS_WEIBULL_MIN; type <= HEIGHTS_WEIBULL_MAX; type++) {
        struct heights known = {.type = (enum heights_type)type, .shape = 2};
        struct height_table *table = table_of(&known);
        struct heights own = {.type = HEIGHTS_TABLE, .table = table};
        surface_of(&known, 3, known_z);
        surface_of(&own, 3, own_z);
        double squares = 0, all = 0;
        qsort(known_z, POINTS, sizeof *known_z, compare);
        qsort(own_z, POINTS, sizeof *own_z, compare);
        for (size_t i = 0; i < POINTS; i++) {
            squares += (known_z[i] - own_z[i]) * (known_z[i] - own_z[i]);
            all += known_z[i] * known_z[i];
        }
        assert_true(all > 0);
        check_close(sqrt(squares / all), 0, 0.01);
        height_table_destroy(&table);
    }
}

static void refuse(size_t n, const double *p, const double *height, const char *words) {
    struct height_table *table = NULL;
    struct error err = {0};
    int status = p != NULL ? height_table_of_quantiles(&table, n, p, height, &err)
                           : height_table_of_samples(&table, n, height, &err);
    assert_int_equal(status, ERROR_INPUT);
    assert_null(table);
    if (strstr(err.text, words) == NULL)
        fail_msg("\"%s\" has no \"%s\"", err.text, words);
}

static void nonsense_is_refused(void **state) {
    (void)state;
    static const double P[] = {0, 0.2, 0.5, 0.8, 1}, H[] = {0, 1, 2, 3, 4, 5, 6, 7};
    refuse(4, P, H, "4 quantiles; at least 5");
    refuse(5, (const double[]){0, 0.5, 0.2, 0.8, 1}, H, "probabilities must rise; number 2");
    refuse(5, (const double[]){0, 0.5, 0.5, 0.8, 1}, H, "probabilities must rise; number 2");
    refuse(5, (const double[]){0, 0.2, 0.5, 0.8, 1.5}, H, "number 4, 1.5, is not in [0, 1]");
    refuse(5, (const double[]){NAN, 0.2, 0.5, 0.8, 1}, H, "number 0, nan, is not in [0, 1]");
    refuse(5, P, (const double[]){0, 1, 0.5, 3, 4}, "heights must not fall; number 2");
    refuse(5, P, (const double[]){0, 1, NAN, 3, 4}, "number 2, nan, is not finite");
    refuse(5, P, (const double[]){0, 1, 2, 3, INFINITY}, "number 4, inf, is not finite");
    refuse(5, P, (const double[]){2, 2, 2, 2, 2}, "heights must differ");
    refuse(5, P, (const double[]){-1e308, 0, 0, 0, 1e308}, "heights must differ");
    refuse(7, NULL, H, "7 samples; at least 8");
    refuse(8, NULL, (const double[]){3, 3, 3, 3, 3, 3, 3, 3}, "heights must differ");
    refuse(8, NULL, (const double[]){1, 2, 3, NAN, 5, 6, 7, 8}, "sample number 3, nan");
    struct heights none = {.type = HEIGHTS_TABLE};
    struct height_moments moments;
    assert_int_equal(heights_moments(&none, &moments, NULL), ERROR_INPUT);
    struct height_table *table = NULL;
    height_table_destroy(&table);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gaussian_tables_are_exact),
        cmocka_unit_test(weibull_tables_are_near),
        cmocka_unit_test(moments_are_integrals),
        cmocka_unit_test(quantiles_rise_and_invert),
        cmocka_unit_test(given_heights_are_met),
        cmocka_unit_test(equal_heights_are_flat_ground),
        cmocka_unit_test(order_and_unit_do_not_matter),
        cmocka_unit_test(surfaces_are_the_same),
        cmocka_unit_test(nonsense_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
