/* Protects: fits of contact curves return the parameters they were made with, choose their points
 * as stated, and give standard errors that hold; no input makes them loop or lie. */
#include "core/random.h"
#include "core/statistics/fit.h"
#include "tests/support/check.h"
#include <string.h>

enum { POINTS = 12, DRAWS = 40000 };

/* Loads whose Persson-like fractions run from 1 to 9 %. */
static void light_loads(double *load) {
    for (int i = 0; i < POINTS; i++)
        load[i] = 0.005 + 0.0045 * i;
}

/* 1e-13: rounding of a dozen terms. */
static void parameters_return(void **state) {
    (void)state;
    double load[POINTS], line[POINTS], power[POINTS], curve[POINTS];
    for (int i = 0; i < POINTS; i++) {
        load[i] = 0.001 * pow(1.4, i);
        line[i] = 1.7 * load[i];
        power[i] = 2.1 * pow(load[i], 0.93);
        curve[i] = erf(sqrt(M_PI) / 2 * 1.9 * 20 * load[i]);
    }
    struct fit fit;
    struct error err;
    assert_int_equal(fit_light_load(POINTS, load, line, &fit, &err), 0);
    check_relative(fit.a, 1.7, 1e-13);
    check_close(fit.error_a, 0, 1e-13);
    assert_true(isnan(fit.b) && isnan(fit.error_b));
    assert_int_equal(fit.points, POINTS);
    assert_int_equal(fit_power_law(POINTS, load, power, &fit, &err), 0);
    check_relative(fit.a, 2.1, 1e-13);
    check_relative(fit.b, 0.93, 1e-13);
    check_close(fit.error_a, 0, 1e-12);
    check_close(fit.error_b, 0, 1e-12);
    assert_int_equal(fit_erf(POINTS, load, curve, &fit, &err), 0);
    check_relative(fit.a, 38, 1e-13);
    check_close(fit.error_a, 0, 1e-12);
    assert_true(isnan(fit.b) && isnan(fit.error_b));
}

/* Computed apart: scipy.optimize.curve_fit and linregress on the same eight points; its printed
 * digits, and 1e-7 for curve_fit's own tolerance and derivatives. */
static void values_of_another_program(void **state) {
    (void)state;
    static const double LOAD[] = {0.01, 0.02, 0.04, 0.08, 0.15, 0.3, 0.5, 0.8};
    static const double FRACTION[] = {0.021, 0.039, 0.075, 0.141, 0.259, 0.464, 0.68, 0.87};
    struct fit fit;
    assert_int_equal(fit_light_load(8, LOAD, FRACTION, &fit, NULL), 0);
    check_relative(fit.a, 1.9, 1e-12);
    check_relative(fit.error_a, 0.037796447300923, 1e-10);
    assert_int_equal(fit.points, 3);
    assert_int_equal(fit_power_law(8, LOAD, FRACTION, &fit, NULL), 0);
    check_relative(fit.a, 1.4323751536097, 1e-12);
    check_relative(fit.b, 0.91755984386882, 1e-12);
    check_relative(fit.error_a, 0.031994522875327, 1e-10);
    check_relative(fit.error_b, 0.0071656894027509, 1e-10);
    assert_int_equal(fit.points, 6);
    assert_int_equal(fit_erf(8, LOAD, FRACTION, &fit, NULL), 0);
    check_relative(fit.a, 1.608483321515, 1e-7);
    check_relative(fit.error_a, 0.030322922219816, 1e-6);
    assert_int_equal(fit.points, 8);
}

/* The points of draw number `draw`, with normal noise: a factor exp(noise g) or a term noise g. */
static void noisy(uint64_t draw, const double *exact, double noise, int factor, double *out) {
    double u[2 * POINTS];
    random_uniform((struct random_key){11, 0, 0}, STREAM_HEIGHTS, draw * 2 * POINTS, 2 * POINTS, u);
    for (int i = 0; i < POINTS; i++) {
        double g = sqrt(-2 * log1p(-u[2 * i])) * cos(2 * M_PI * u[2 * i + 1]);
        out[i] = factor ? exact[i] * exp(noise * g) : exact[i] + noise * g;
    }
}

struct spread { /* over draws: of the value, and of its stated variance */
    double value, square, variance;
};
static void spread_add(struct spread *spread, double value, double error) {
    spread->value += value / DRAWS;
    spread->square += value * value / DRAWS;
    spread->variance += error * error / DRAWS;
}
/* Variances of 40000 draws are known to sqrt(2/40000) = 0.7 %, the mean of the stated ones to a
 * third of that: 3 % is four standard errors, and less than one degree of freedom of twelve. */
static void spread_check(const struct spread *spread, double truth) {
    double variance = spread->square - spread->value * spread->value;
    check_close(spread->value, truth, 4 * sqrt(variance / DRAWS));
    check_relative(spread->variance, variance, 0.03);
}

/* Errors that a fit states are those it makes; Philox key 11, fixed. Noise small enough that no
 * fraction leaves its range and that the fits are linear in it (relative bias of its square). */
static void errors_are_right_in_the_mean(void **state) {
    (void)state;
    double load[POINTS], exact[POINTS], drawn[POINTS];
    struct spread line = {0}, factor = {0}, exponent = {0}, curve = {0};
    struct fit fit;
    light_loads(load);
    for (uint64_t draw = 0; draw < DRAWS; draw++) {
        for (int i = 0; i < POINTS; i++)
            exact[i] = 1.6 * load[i];
        noisy(draw, exact, 5e-4, 0, drawn);
        assert_int_equal(fit_light_load(POINTS, load, drawn, &fit, NULL), 0);
        assert_int_equal(fit.points, POINTS);
        spread_add(&line, fit.a, fit.error_a);

        for (int i = 0; i < POINTS; i++)
            exact[i] = 2 * pow(load[i], 0.95);
        noisy(draw, exact, 2e-3, 1, drawn);
        assert_int_equal(fit_power_law(POINTS, load, drawn, &fit, NULL), 0);
        spread_add(&factor, fit.a, fit.error_a);
        spread_add(&exponent, fit.b, fit.error_b);

        for (int i = 0; i < POINTS; i++)
            exact[i] = erf(sqrt(M_PI) / 2 * 16 * load[i]);
        noisy(draw, exact, 2e-3, 0, drawn);
        assert_int_equal(fit_erf(POINTS, load, drawn, &fit, NULL), 0);
        spread_add(&curve, fit.a, fit.error_a);
    }
    spread_check(&line, 1.6);
    spread_check(&factor, 2);
    spread_check(&exponent, 0.95);
    spread_check(&curve, 16);
}

typedef int fit_of(size_t, const double *, const double *, struct fit *, struct error *);
static fit_of *const FITS[] = {fit_light_load, fit_power_law, fit_erf};

/* Points out of range, not positive or not finite change nothing. */
static void points_out_of_range_are_left_out(void **state) {
    (void)state;
    static const double LOAD[] = {0.01, 0.02, 0.03,     0.04,  -0.02, 0,    NAN,  0.02, 0.02,
                                  0.02, 0.02, INFINITY, -0.01, 0.02,  0.02, 0.02, 0.02};
    double fraction[] = {0.02,  0.041,    0.059, 0.08,  0.03, 0.03, 0.03,      NAN,  0,
                         -0.04, INFINITY, 0.03,  -0.01, 1,    2,    -INFINITY, 1e300};
    for (size_t f = 0; f < 3; f++) {
        struct fit clean, dirty;
        assert_int_equal(FITS[f](4, LOAD, fraction, &clean, NULL), 0);
        assert_int_equal(FITS[f](17, LOAD, fraction, &dirty, NULL), 0);
        assert_int_equal(dirty.points, 4);
        check_close(dirty.a, clean.a, 0);
        check_close(dirty.error_a, clean.error_a, 0);
    }
    /* The upper ends: 0.1 and 0.5 belong to the range, 1 does not. */
    static const double EDGE[] = {0.1, 0.1000001, 0.5, 0.5000001, 0.9999999, 1};
    static const double ONES[] = {1, 2, 3, 4, 5, 6};
    static const size_t IN[] = {1, 3, 5};
    for (size_t f = 0; f < 3; f++) {
        struct fit fit;
        assert_int_equal(FITS[f](6, ONES, EDGE, &fit, NULL), 0);
        assert_int_equal(fit.points, IN[f]);
    }
}

static void too_few_points_give_no_number(void **state) {
    (void)state;
    static const double LOAD[] = {0.01, 0.02}, FRACTION[] = {0.02, 0.03};
    struct fit fit;
    for (size_t f = 0; f < 3; f++) {
        assert_int_equal(FITS[f](0, NULL, NULL, &fit, NULL), 0);
        assert_int_equal(fit.points, 0);
        assert_true(isnan(fit.a) && isnan(fit.b) && isnan(fit.error_a) && isnan(fit.error_b));
        assert_int_equal(FITS[f](1, LOAD, FRACTION, &fit, NULL), 0);
        assert_int_equal(fit.points, 1);
        assert_true(isnan(fit.error_a) && isnan(fit.error_b));
        assert_true(isnan(fit.a) == (FITS[f] == fit_power_law));
    }
    /* Two points are a power law without an error; two at one load are none. */
    assert_int_equal(fit_power_law(2, LOAD, FRACTION, &fit, NULL), 0);
    check_relative(fit.b, log(1.5) / log(2), 1e-14);
    assert_true(isnan(fit.error_a) && isnan(fit.error_b));
    static const double SAME[] = {0.02, 0.02, 0.02}, APART[] = {0.02, 0.03, 0.04};
    assert_int_equal(fit_power_law(3, SAME, APART, &fit, NULL), 0);
    assert_true(isnan(fit.b) && isnan(fit.a));
}

/* Tiny and huge loads scale; fractions a hair from 0 and 1, and points far from any curve, end. */
static void hard_points_end(void **state) {
    (void)state;
    static const double SCALES[] = {1e-200, 1e-12, 1, 1e12, 1e200};
    for (size_t s = 0; s < 5; s++) {
        double load[POINTS], fraction[POINTS];
        for (int i = 0; i < POINTS; i++) {
            load[i] = SCALES[s] * (i + 1) / 10;
            fraction[i] = erf(sqrt(M_PI) / 2 * 1.6 * (i + 1) / 10);
        }
        struct fit fit;
        assert_int_equal(fit_erf(POINTS, load, fraction, &fit, NULL), 0);
        check_relative(fit.a * SCALES[s], 1.6, 1e-13);
    }
    static const double WILD_LOAD[] = {1e-300, 1e300, 1, 1e-5, 3};
    static const double WILD_FRACTION[] = {1 - 1.2e-16, 5e-324, 1e-300, 0.99, 0.01};
    for (size_t n = 1; n <= 5; n++)
        for (size_t f = 0; f < 3; f++) {
            struct fit fit;
            assert_int_equal(FITS[f](n, WILD_LOAD, WILD_FRACTION, &fit, NULL), 0);
        }
    /* One point: the curve passes through it. */
    struct fit fit;
    double load = 2, fraction = 0.999999;
    assert_int_equal(fit_erf(1, &load, &fraction, &fit, NULL), 0);
    check_close(erf(sqrt(M_PI) / 2 * fit.a * load), fraction, 1e-14);
}

static void no_memory_is_an_error(void **state) {
    (void)state;
    for (size_t f = 0; f < 3; f++) {
        struct error err;
        struct fit fit = {.a = 5};
        assert_int_equal(FITS[f](SIZE_MAX / 4, NULL, NULL, &fit, &err), ERROR_MEMORY);
        assert_non_null(strstr(err.text, "the points of a fit"));
        check_close(fit.a, 5, 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parameters_return),
        cmocka_unit_test(values_of_another_program),
        cmocka_unit_test(errors_are_right_in_the_mean),
        cmocka_unit_test(points_out_of_range_are_left_out),
        cmocka_unit_test(too_few_points_give_no_number),
        cmocka_unit_test(hard_points_end),
        cmocka_unit_test(no_memory_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
