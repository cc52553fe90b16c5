/* Protects: theories of asperities by the summits of translated surfaces. A field that is its own
 * translation has the theories of Gaussian surfaces; others have the sums over drawn summits, each
 * pressed by Hertz's own solution; and heights with a bound that summits flatten
 * against have no area, rather than one of the quadrature. */
#include "core/theory/contact.h"
#include "core/theory/translated_asperities.h"
#include "tests/support/drawn_summits.h"
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>

/* A field of unit variance and this alpha, translated; z has the deviation 1. */
static struct translated_surface surface_of(const struct height_function *function, double alpha,
                                            bool mirrored) {
    const struct hermite_powers *powers = height_function_powers(function);
    struct translated_surface surface = {.dimension = 2, .heights = {function, mirrored}};
    surface.gaussian = (struct moments){.m0 = 1, .m2 = 1, .m4 = alpha, .nayak_alpha = alpha};
    surface.reached = (struct moments){
        .m0 = 1, .m2 = powers->slope, .m4 = powers->slope * alpha + 3 * powers->curvature};
    return surface;
}

static struct height_function *function_of(enum heights_type type, double shape) {
    const struct heights heights = {.type = type, .shape = shape};
    struct height_function *function = NULL;
    assert_int_equal(height_function_create(&function, &heights, NULL), 0);
    return function;
}

static struct translated_asperities *theory_of(const struct translated_surface *surface,
                                               enum translated_theory theory) {
    struct translated_asperities *asperities = NULL;
    assert_int_equal(translated_asperities_create(&asperities, surface, theory, NULL), 0);
    return asperities;
}

/* f is exact to 1e-10 here, which counts in the integrals of the lightest loads. */
static void gaussian_fields_have_the_gaussian_theories(void **state) {
    (void)state;
    static const double ALPHAS[] = {1.52, 2, 5.34, 40}, LOADS[] = {1e-8, 1e-4, 0.01, 0.1, 1};
    struct height_function *function = function_of(HEIGHTS_GAUSSIAN, 0);
    for (size_t a = 0; a < sizeof ALPHAS / sizeof *ALPHAS; a++) {
        struct translated_surface surface = surface_of(function, ALPHAS[a], a % 2 == 1);
        struct translated_asperities *bgt = theory_of(&surface, TRANSLATED_BGT);
        struct translated_asperities *gw = theory_of(&surface, TRANSLATED_GW);
        for (size_t k = 0; k < sizeof LOADS / sizeof *LOADS; k++) {
            double elliptic = bgt_area(LOADS[k], ALPHAS[a]);
            double spheres = gw_mccool_area(LOADS[k], ALPHAS[a]);
            check_close(translated_asperities_area(bgt, LOADS[k]), elliptic, 1e-8 * elliptic);
            check_close(translated_asperities_area(gw, LOADS[k]), spheres, 1e-8 * spheres);
        }
        translated_asperities_destroy(&bgt);
        translated_asperities_destroy(&gw);
    }
    height_function_destroy(&function);
}

static void drawn_summits(const struct translated_surface *surface, uint64_t number,
                          double separation) {
    enum { DRAWS = 1000000 };
    double load, fraction;
    struct translated_asperities *bgt = theory_of(surface, TRANSLATED_BGT);
    translated_asperities_curve(bgt, 1, &separation, &load, &fraction);
    drawn_summits_check(DRAWS, number, surface->gaussian.nayak_alpha, &surface->heights,
                        surface->reached.m2, separation, fraction, load);
    check_close(translated_asperities_area(bgt, load), fraction, 1e-8 * fraction);
    translated_asperities_destroy(&bgt);
}

static void others_are_sums_over_summits(void **state) {
    (void)state;
    static const struct {
        double shape, separation;
        enum heights_type type;
        bool mirrored;
    } CASES[] = {{1, 1.5, HEIGHTS_WEIBULL_MIN, false},
                 {3.602, 0.5, HEIGHTS_WEIBULL_MIN, true},
                 {0.5, 1, HEIGHTS_LOGNORMAL, false},
                 {0.5, 0.3, HEIGHTS_LOGNORMAL, true}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct height_function *function = function_of(CASES[c].type, CASES[c].shape);
        struct translated_surface surface = surface_of(function, 4, CASES[c].mirrored);
        drawn_summits(&surface, c, CASES[c].separation);
        height_function_destroy(&function);
    }
}

/* Slopes of heights by samples jump at each of them. */
static void samples_are_sums_over_summits(void **state) {
    (void)state;
    enum { SAMPLES = 40, SEED = 9 };
    double sample[SAMPLES];
    struct height_table *table = NULL;
    struct height_function *function = NULL;
    gsl_rng *random = gsl_rng_alloc(gsl_rng_ranlxd1);
    assert_non_null(random);
    gsl_rng_set(random, SEED);
    for (size_t n = 0; n < SAMPLES; n++)
        sample[n] = gsl_ran_lognormal(random, 0, 0.4);
    assert_int_equal(height_table_of_samples(&table, SAMPLES, sample, NULL), 0);
    const struct heights heights = {.type = HEIGHTS_TABLE, .table = table};
    struct error err = {0};
    if (height_function_create(&function, &heights, &err) != 0)
        fail_msg("%s", err.text);
    struct translated_surface surface = surface_of(function, 4, false);
    drawn_summits(&surface, 10, 1);
    surface = surface_of(function, 4, true);
    drawn_summits(&surface, 11, 0.5);
    height_function_destroy(&function);
    height_table_destroy(&table);
    gsl_rng_free(random);
}

/* Spheres of one curvature: their area at a load is that of equal heights f, whatever f' is. */
static void spheres_have_the_mean_curvature(void **state) {
    (void)state;
    static const double SEPARATION = 0.8;
    struct height_function *function = function_of(HEIGHTS_LOGNORMAL, 0.4);
    struct translated_surface surface = surface_of(function, 6, false);
    struct summit_expectation all = translated_summits_expectation(&surface);
    struct translated_asperities *gw = theory_of(&surface, TRANSLATED_GW);
    double mean = nayak_summit_mean(6), deviation = sqrt(nayak_summit_variance(6)), load, area;
    double curvature = all.curvature * sqrt(surface.reached.m4), areas = 0, loads = 0;
    for (double t = -8; t < 8; t += 1e-4) {
        double z = translated_heights_at(&surface.heights, mean + deviation * t).height;
        double over = fmax(z - SEPARATION, 0), share = 1e-4 * exp(-t * t / 2) / sqrt(2 * M_PI);
        areas += share * M_PI * over / curvature;
        loads += share * 4 / 3.0 * over * sqrt(over / curvature) / sqrt(2 * surface.reached.m2);
    }
    translated_asperities_curve(gw, 1, &SEPARATION, &load, &area);
    check_close(area, all.density * areas, 1e-6 * area);
    check_close(load, all.density * loads, 1e-6 * load);
    translated_asperities_destroy(&gw);
    height_function_destroy(&function);
}

static void flattened_summits_have_no_area(void **state) {
    (void)state;
    static const double SEPARATION = 0.2;
    for (int mirrored = 0; mirrored <= 1; mirrored++) {
        struct height_function *function =
            function_of(mirrored ? HEIGHTS_WEIBULL_MIN : HEIGHTS_WEIBULL_MAX, 1);
        struct translated_surface surface = surface_of(function, 5, mirrored);
        struct translated_asperities *bgt = theory_of(&surface, TRANSLATED_BGT);
        struct translated_asperities *gw = theory_of(&surface, TRANSLATED_GW);
        double load, area;
        translated_asperities_curve(bgt, 1, &SEPARATION, &load, &area);
        assert_true(isnan(area) && load > 0 && isfinite(load));
        assert_true(isnan(translated_asperities_area(bgt, 0.01)));
        assert_true(translated_asperities_area(gw, 0.01) > 0.01);
        translated_asperities_destroy(&bgt);
        translated_asperities_destroy(&gw);
        height_function_destroy(&function);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gaussian_fields_have_the_gaussian_theories),
        cmocka_unit_test(others_are_sums_over_summits),
        cmocka_unit_test(samples_are_sums_over_summits),
        cmocka_unit_test(spheres_have_the_mean_curvature),
        cmocka_unit_test(flattened_summits_have_no_area),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
