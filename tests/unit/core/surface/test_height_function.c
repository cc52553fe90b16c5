/* Protects: the height function of a translation field, its inverse and its Hermite series, in both
 * tails of every distribution; and the refusal of heights that have none. */
#include "core/surface/translation/height_function.h"
#include "tests/support/check.h"
#include <gsl/gsl_cdf.h>
#include <string.h>

static struct height_function *function_of(enum heights_type type, double shape) {
    const struct heights heights = {.type = type, .shape = shape};
    struct height_function *function = NULL;
    assert_int_equal(height_function_create(&function, &heights, NULL), 0);
    return function;
}

static const struct {
    enum heights_type type;
    double shape;
} HEIGHTS[] = {{HEIGHTS_GAUSSIAN, 0},        {HEIGHTS_WEIBULL_MIN, 1},
               {HEIGHTS_WEIBULL_MAX, 1},     {HEIGHTS_WEIBULL_MIN, 2},
               {HEIGHTS_WEIBULL_MAX, 3.602}, {HEIGHTS_LOGNORMAL, 0.7},
               {HEIGHTS_GAMMA, 4},           {HEIGHTS_BETA, 3}};
enum { HEIGHTS_COUNT = sizeof HEIGHTS / sizeof *HEIGHTS };

/* Against quantiles, which lose their digits near probabilities of 1: hence |g| < 4. */
static void heights_are_quantiles(void **state) {
    (void)state;
    for (size_t a = 0; a < HEIGHTS_COUNT; a++) {
        const struct heights heights = {.type = HEIGHTS[a].type, .shape = HEIGHTS[a].shape};
        struct height_function *function = function_of(heights.type, heights.shape);
        struct height_moments moments;
        assert_int_equal(heights_moments(&heights, &moments, NULL), 0);
        for (double g = -4; g < 4; g += 0.0371) {
            double expected = heights_quantile(&heights, &moments, gsl_cdf_ugaussian_P(g));
            check_close(height_function_at(function, g).height, expected, 1e-10);
        }
        height_function_destroy(&function);
    }
}

/* The tolerance of the inverse is that of heights, 1e-13, over the slope. */
static void slopes_and_inverse_belong_to_it(void **state) {
    (void)state;
    for (size_t a = 0; a < HEIGHTS_COUNT; a++) {
        struct height_function *function = function_of(HEIGHTS[a].type, HEIGHTS[a].shape);
        for (double g = -5; g < 5; g += 0.0173) {
            struct height_slope at = height_function_at(function, g);
            double step = 1e-5;
            double slope = (height_function_at(function, g + step).height -
                            height_function_at(function, g - step).height) /
                           (2 * step);
            check_close(at.slope, slope, 1e-8 * (1 + fabs(slope)));
            check_close(height_function_inverse(function, at.height), g, 1e-12 + 1e-13 / at.slope);
        }
        height_function_destroy(&function);
    }
}

static void many_points_are_as_one(void **state) {
    (void)state;
    struct height_function *function = function_of(HEIGHTS_WEIBULL_MAX, 1);
    double z[5] = {-9.5, -3, 0, 2.5, 10}, g[5];
    memcpy(g, z, sizeof g);
    height_function_apply(function, 0.25, 5, z);
    for (size_t i = 0; i < 5; i++)
        check_close(z[i], 0.25 * height_function_at(function, g[i]).height, 0);
    height_function_undo(function, 0.25, 5, z);
    for (size_t i = 0; i < 4; i++) /* the last one lies at the bound */
        check_close(z[i], g[i], 1e-9);
    height_function_destroy(&function);
}

/* Rows of a surface, within the table and with jumps farther than neighbours differ. */
static void rows_are_as_points(void **state) {
    (void)state;
    enum { POINTS = 1000 };
    double z[POINTS], g[POINTS];
    for (size_t a = 0; a < HEIGHTS_COUNT; a++) {
        struct height_function *function = function_of(HEIGHTS[a].type, HEIGHTS[a].shape);
        for (size_t i = 0; i < POINTS; i++)
            z[i] = g[i] = 4 * sin(0.02 * (double)i) * (i % 100 == 7 ? -1 : 1);
        height_function_apply(function, 0.25, POINTS, z);
        for (size_t i = 0; i < POINTS; i++)
            assert_true(z[i] == 0.25 * height_function_at(function, g[i]).height);
        height_function_undo(function, 0.25, POINTS, z);
        for (size_t i = 0; i < POINTS; i++)
            check_close(z[i], g[i], 1e-12 + 1e-13 / height_function_at(function, g[i]).slope);
        height_function_destroy(&function);
    }
}

/* Second derivatives against those of exp, and against differences of slopes. Steps make errors of
 * 1e-6 f'''', which is some 100 f'' in the tails. */
static void bends_belong_to_slopes(void **state) {
    (void)state;
    const double shape = 0.7, deviation = exp(shape * shape / 2) * sqrt(expm1(shape * shape));
    struct height_function *lognormal = function_of(HEIGHTS_LOGNORMAL, shape);
    for (double g = -5; g < 5; g += 0.0173)
        check_relative(height_function_bend(lognormal, g),
                       shape * shape * exp(shape * g) / deviation, 1e-5);
    height_function_destroy(&lognormal);
    for (size_t a = 0; a < HEIGHTS_COUNT; a++) {
        struct height_function *function = function_of(HEIGHTS[a].type, HEIGHTS[a].shape);
        for (double g = -4; g < 4; g += 0.0173) {
            double step = 2e-3, slope = height_function_at(function, g).slope;
            double bend = (height_function_at(function, g + step).slope -
                           height_function_at(function, g - step).slope) /
                          (2 * step);
            check_close(height_function_bend(function, g), bend, 1e-4 * (slope + fabs(bend)));
        }
        assert_true(height_function_bend(function, 20) == 0);
        height_function_destroy(&function);
    }
}

/* Log-normal heights have closed coefficients: c_n^2 = s^2n/(n! (exp(s^2) - 1)), with sums of them
 * by n: <f'^2> = s^2 exp(s^2)/(exp(s^2) - 1), <f''^2> s^2 times as much. */
static void series_of_lognormal_heights(void **state) {
    (void)state;
    const double shape = 0.7, square = shape * shape;
    struct height_function *function = function_of(HEIGHTS_LOGNORMAL, shape);
    const struct hermite_powers *powers = height_function_powers(function);
    double expected = 1 / expm1(square), sum = 0;
    for (int n = 1; n <= HERMITE_TERMS; n++) {
        expected *= square / n;
        check_close(powers->of[n], expected, 1e-12);
        sum += powers->of[n];
    }
    check_close(sum, 1, 1e-12);
    double slope = square * exp(square) / expm1(square);
    check_relative(powers->slope, slope, 1e-9);
    check_relative(powers->curvature, slope * square, 1e-5); /* by differences */
    height_function_destroy(&function);
}

static void tails_have_one_series(void **state) {
    (void)state;
    struct height_function *low = function_of(HEIGHTS_WEIBULL_MIN, 1.5);
    struct height_function *high = function_of(HEIGHTS_WEIBULL_MAX, 1.5);
    for (int n = 1; n <= HERMITE_TERMS; n++)
        check_close(height_function_powers(low)->of[n], height_function_powers(high)->of[n], 1e-14);
    height_function_destroy(&low);
    height_function_destroy(&high);
}

static void correlations_and_their_inverse(void **state) {
    (void)state;
    struct height_function *function = function_of(HEIGHTS_WEIBULL_MIN, 1);
    const struct hermite_powers *powers = height_function_powers(function);
    double batch[200];
    check_close(hermite_correlation(powers, 1), 1, 1e-12);
    check_close(hermite_gaussian_correlation(powers, 1), 1, 0);
    for (int i = 0; i < 200; i++)
        batch[i] = (i - 99.5) / 100;
    hermite_correlations_beyond(powers, 200, batch);
    for (int i = 0; i < 200; i++) {
        double gaussian = (i - 99.5) / 100, z = hermite_correlation(powers, gaussian);
        check_close(batch[i], z - powers->of[1] * gaussian, 1e-14);
        if (gaussian > 0)
            check_close(hermite_gaussian_correlation(powers, z), gaussian, 1e-13);
    }
    height_function_destroy(&function);
}

static void flat_ground_is_refused(void **state) {
    (void)state;
    static const double probability[] = {0, 0.1, 0.3, 0.5, 0.9, 1};
    static const double height[] = {-2, -1, 0, 0, 1, 2};
    struct height_table *table = NULL;
    struct height_function *function = NULL;
    struct error err = {0};
    assert_int_equal(height_table_of_quantiles(&table, 6, probability, height, NULL), 0);
    const struct heights heights = {.type = HEIGHTS_TABLE, .table = table};
    assert_int_equal(height_function_create(&function, &heights, &err), ERROR_INPUT);
    assert_null(function);
    assert_non_null(strstr(err.text, "are equal"));
    height_table_destroy(&table);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heights_are_quantiles),
        cmocka_unit_test(many_points_are_as_one),
        cmocka_unit_test(rows_are_as_points),
        cmocka_unit_test(bends_belong_to_slopes),
        cmocka_unit_test(slopes_and_inverse_belong_to_it),
        cmocka_unit_test(tails_have_one_series),
        cmocka_unit_test(series_of_lognormal_heights),
        cmocka_unit_test(flat_ground_is_refused),
        cmocka_unit_test(correlations_and_their_inverse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
