/* Protects: the shape of a distribution is found again from heights that have it, the right family
 * is chosen, and too few heights give no interval and no p-value. Errors and tests over surfaces:
 * tests/validation/core/test_height_statistics.c. */
#include "core/statistics/heights/height_fit.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdlib.h>

enum { SIDE = 96, POINTS = SIDE * SIDE };
static const struct grid GRID = {SIDE, SIDE, 1, 1};

/* All quantiles at (a + 1/2)/POINTS of a distribution, scattered, times 2 and about 5. */
static void heights_scatter(struct heights heights, double *z) {
    uint64_t seed = 1;
    struct height_moments moments;
    assert_int_equal(heights_moments(&heights, &moments, NULL), 0);
    for (size_t a = 0; a < POINTS; a++)
        z[a] = 5 + 2 * heights_quantile(&heights, &moments, ((double)a + 0.5) / POINTS);
    for (size_t a = POINTS - 1; a > 0; a--) {
        size_t b = next_word(&seed) % (a + 1);
        double kept = z[a];
        z[a] = z[b];
        z[b] = kept;
    }
}

static void fit(const double *z, bool errors, struct height_fits *out) {
    static struct low_modes modes;
    struct cell_heights *heights = NULL;
    const struct measured_map map = {&GRID, z, BOUNDARY_PERIODIC};
    assert_true(low_modes_fill(&map, NULL, &modes));
    assert_int_equal(cell_heights_create(&heights, &map, &modes, NULL), 0);
    height_fit_measure(heights, errors ? &modes : NULL, out);
    cell_heights_destroy(&heights);
}

static void shapes_found_again(void **state) {
    (void)state;
    const struct heights known[] = {
        {.type = HEIGHTS_GAUSSIAN},
        {.type = HEIGHTS_WEIBULL_MIN, .shape = 1},
        {.type = HEIGHTS_WEIBULL_MIN, .shape = 2},
        {.type = HEIGHTS_WEIBULL_MAX, .shape = 1.5},
        {.type = HEIGHTS_WEIBULL_MAX, .shape = 12},
        {.type = HEIGHTS_LOGNORMAL, .shape = 0.5},
        {.type = HEIGHTS_GAMMA, .shape = 3},
        {.type = HEIGHTS_BETA, .shape = 2},
    };
    static double z[POINTS];
    for (size_t n = 0; n < sizeof known / sizeof *known; n++)
        for (int errors = 0; errors < 2; errors++) {
            struct height_fits fits;
            heights_scatter(known[n], z);
            fit(z, errors, &fits);
            const struct height_fit *found = &fits.list[fits.best];
            assert_int_equal(found->type, known[n].type);
            assert_true(found->distance < 1e-4);
            if (known[n].type != HEIGHTS_GAUSSIAN)
                check_relative(found->shape, known[n].shape, 0.01);
            assert_true(isnan(found->p_value) == (errors == 0));
            if (errors == 0)
                continue;
            /* points in any order are independent */
            assert_true(found->p_value > 0.5);
            assert_true(fits.independent > POINTS / 2.5 && fits.independent < POINTS * 2.5);
            if (known[n].type != HEIGHTS_GAUSSIAN)
                assert_true(found->shape_low < known[n].shape &&
                            found->shape_high > known[n].shape);
        }
}

/* Two heights alone, or one, determine no distribution. */
static void few_heights(void **state) {
    (void)state;
    static double z[POINTS];
    struct height_fits fits;
    for (size_t a = 0; a < POINTS; a++)
        z[a] = 7;
    fit(z, true, &fits);
    assert_true(isnan(fits.list[HEIGHTS_GAUSSIAN].distance) && isnan(fits.independent));
    z[5] = 8;
    fit(z, true, &fits);
    assert_true(isnan(fits.list[fits.best].p_value));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(shapes_found_again),
                                       cmocka_unit_test(few_heights)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
