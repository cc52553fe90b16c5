/* Protects: standard errors of parameters of independent Gaussian heights are those of the
 * textbook, as means over many maps; those of scattered summits, too. Errors of surfaces whose
 * heights are alike: tests/validation/core/test_height_statistics.c. */
#include "core/statistics/uncertainty/scalar_errors.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <stdlib.h>

enum { SIDE = 48, POINTS = SIDE * SIDE, TRIALS = 300 };
static const struct grid GRID = {SIDE, SIDE, SIDE, SIDE};

/* Mean over maps of squared errors by 20 degrees of freedom: four of its own standard errors. */
static double tolerance(double freedom) {
    return 4 * sqrt(2 / freedom / TRIALS);
}

static void independent_heights(void **state) {
    (void)state;
    uint64_t seed = seed_or(5);
    static struct low_modes modes;
    static double z[POINTS];
    const struct measured_map map = {&GRID, z, BOUNDARY_PERIODIC};
    double sa = 0, sq = 0, ssk = 0, sku = 0, m0 = 0, m2 = 0, slope = 0;
    assert_true(low_modes_fill(&map, NULL, &modes));
    for (int trial = 0; trial < TRIALS; trial++) {
        struct cell_heights *heights = NULL;
        static struct cell_differences differences;
        struct scalar_errors errors;
        noise_fill(&seed, POINTS, z);
        assert_int_equal(cell_heights_create(&heights, &map, &modes, NULL), 0);
        cell_differences_measure(&map, &modes, 1, &differences);
        scalar_errors_heights(heights, &modes, &errors);
        scalar_errors_differences(&differences, heights, &modes, &errors);
        sa += errors.sa * errors.sa * POINTS / TRIALS;
        sq += errors.sq * errors.sq * POINTS / TRIALS;
        ssk += errors.ssk * errors.ssk * POINTS / TRIALS;
        sku += errors.sku * errors.sku * POINTS / TRIALS;
        m0 += errors.m0 * errors.m0 * POINTS / TRIALS;
        m2 += errors.m2 * errors.m2 * POINTS / TRIALS;
        slope += errors.slope * errors.slope * POINTS / TRIALS;
        cell_heights_destroy(&heights);
    }
    check_relative(sa, 1 - 2 / M_PI, tolerance(20));
    check_relative(sq, 0.5, tolerance(20));
    check_relative(ssk, 6, tolerance(20) + 0.02); /* and terms of 1/n */
    check_relative(sku, 24 * 1.15 * 1.15, tolerance(20) + 0.02);
    check_relative(m0, 2, tolerance(20));
    /* Squares of differences of neighbours: 8 of their own, 2 with each of 2 along the line, and
     * 2 with each of 4 across, of both directions; over the square of their sum, 4. */
    check_relative(m2, (2 * (8 + 4) + 2 * 8) / 16.0, tolerance(20) + 0.05);
    check_relative(slope, m2 / 4, 1e-9);
}

/* Over a quarter of the area errors are twice as large; alpha's has its heights from all of it. */
static void errors_inside(void **state) {
    (void)state;
    const struct scalar_errors all = {
        .sq = 1, .slope = 0.1, .curvature = 0.2, .m2 = 0.2, .m4 = 0.4, .alpha = 0.5, .bends = 0.1};
    struct scalar_errors inside;
    scalar_errors_inside(&all, 0.25, &inside);
    check_close(inside.sq, 1, 0);
    check_relative(inside.slope, 0.2, 1e-12);
    check_relative(inside.curvature, 0.4, 1e-12);
    check_relative(inside.m4, 0.8, 1e-12);
    check_relative(inside.alpha, sqrt(0.25 + 3 * 0.01), 1e-12);
}

/* Heights that are the quantiles of a distribution have its influences; without the farthest ones
 * errors are raised, most where the fourth power counts. */
static void far_heights(void **state) {
    (void)state;
    static double z[POINTS];
    const struct measured_map map = {&GRID, z, BOUNDARY_OPEN};
    const struct heights law = {.type = HEIGHTS_WEIBULL_MIN, .shape = 2};
    struct height_moments moments;
    struct scalar_errors whole = {.sq = 1, .m0 = 1, .ssk = 1, .sku = 1.15}, cut = whole;
    assert_int_equal(heights_moments(&law, &moments, NULL), 0);
    for (size_t point = 0; point < POINTS; point++)
        z[point] = 3 * heights_quantile(&law, &moments, ((double)point + 0.5) / POINTS);
    scalar_errors_by_law(&whole, &map, &law, &moments);
    check_relative(whole.sq, 1, 0.01);
    check_relative(whole.ssk, 1, 0.05);
    check_relative(whole.sku, 1, 0.2); /* eighth powers lack what is beyond the last of 2304 */
    for (size_t point = POINTS - POINTS / 100; point < POINTS; point++)
        z[point] = z[POINTS - POINTS / 100 - 1];
    scalar_errors_by_law(&cut, &map, &law, &moments);
    assert_true(cut.sq > 1.02 * whole.sq && cut.ssk > 1.1 * whole.ssk);
    assert_true(cut.sku > 1.2 * whole.sku);
}

/* Returns the height of which a share of a stratified face lies above. */
static double height_above(const struct plateau_law *law, double share) {
    double low = -100, high = 100;
    for (int n = 0; n < 60; n++) {
        const double middle = (low + high) / 2;
        if (plateau_ratio(law, middle) > share)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* The same of a stratified face, whose far heights are its valleys. */
static void far_valleys(void **state) {
    (void)state;
    static double z[POINTS];
    const struct measured_map map = {&GRID, z, BOUNDARY_OPEN};
    const struct plateau_law law = {
        .plateau_mean = 1, .plateau_rms = 0.5, .valley_mean = 2, .valley_rms = 2};
    struct scalar_errors whole = {.sq = 1, .m0 = 1, .ssk = 1, .sku = 1}, cut = whole;
    for (size_t point = 0; point < POINTS; point++)
        z[point] = height_above(&law, ((double)point + 0.5) / POINTS);
    scalar_errors_by_strata(&whole, &map, &law);
    check_relative(whole.sq, 1, 0.01);
    check_relative(whole.ssk, 1.1, 0.1); /* 2304 heights lack what is beyond the last ones */
    assert_true(whole.sku >= 1 && whole.sku < 1.4);
    for (size_t point = POINTS - POINTS / 100; point < POINTS; point++)
        z[point] = z[POINTS - POINTS / 100 - 1];
    scalar_errors_by_strata(&cut, &map, &law);
    assert_true(cut.sq > 1.02 * whole.sq && cut.ssk > 1.1 * whole.ssk);
    assert_true(cut.sku > 1.2 * whole.sku);
}

/* Differences over a lag as by their definition, of a wave. */
static void differences_of_a_wave(void **state) {
    (void)state;
    static double z[POINTS];
    static struct low_modes modes;
    static struct cell_differences d;
    const struct measured_map map = {&GRID, z, BOUNDARY_PERIODIC};
    const double k = 2 * M_PI / 12;
    for (size_t point = 0; point < POINTS; point++)
        z[point] = cos(k * (double)(point % SIDE));
    assert_true(low_modes_fill(&map, NULL, &modes));
    for (size_t lag = 1; lag <= 8; lag *= 2) {
        double count = 0, slope = 0, bend = 0, squares = 0, across = 0, along = 0, gradient = 0;
        double length = (double)lag, sine = 2 * sin(k * length / 2);
        cell_differences_measure(&map, &modes, lag, &d);
        for (size_t cell = 0; cell < LOW_CELLS_MOST; cell++) {
            count += d.count[cell];
            slope += d.slope[cell];
            bend += d.bend[cell];
            squares += d.squares[cell];
            across += d.across[cell];
            along += d.along[cell];
            gradient += d.gradient[cell];
        }
        size_t every = lag > 4 ? lag / 4 : 1;
        check_close(count, POINTS / (double)(every * every), 0);
        check_relative(slope / count, sine * sine / 2 / (length * length), 1e-9);
        check_relative(bend / count, pow(sine / length, 4) / 2, 1e-9);
        check_close(squares, POINTS, 0);
        check_relative(gradient / squares, slope / count, 1e-9);
        check_relative(along, gradient, 1e-9);
        check_close(across, 0, 1e-9);
    }
}

static void scattered_summits(void **state) {
    (void)state;
    uint64_t seed = seed_or(6);
    enum { SUMMITS = 500 };
    static double z[POINTS];
    static struct low_modes modes;
    const struct measured_map map = {&GRID, z, BOUNDARY_OPEN};
    struct cell_heights *heights = NULL;
    double searched[LOW_CELLS_MOST], density = 0, height = 0, curvature = 0, deviation = 0;
    assert_true(low_modes_fill(&map, NULL, &modes));
    assert_int_equal(cell_heights_create(&heights, &map, &modes, NULL), 0);
    assert_int_equal(summit_cells_count(&map, &modes, 0, 0, searched, NULL), 0);
    for (int trial = 0; trial < TRIALS; trial++) {
        struct summit_list list = {0};
        struct summit_errors errors;
        for (int n = 0; n < SUMMITS; n++) {
            double height_and_curvature[2];
            noise_fill(&seed, 2, height_and_curvature);
            const struct summit summit = {SIDE * noise_uniform(&seed), SIDE * noise_uniform(&seed),
                                          height_and_curvature[0], height_and_curvature[1]};
            assert_int_equal(summit_list_add(&list, &summit, NULL), 0);
        }
        summit_errors_measure(&list, 1, &GRID, searched, heights, &modes, &errors);
        density += errors.density * errors.density * SUMMITS / TRIALS;
        height += errors.height_mean * errors.height_mean * SUMMITS / TRIALS;
        curvature += errors.curvature_mean * errors.curvature_mean * SUMMITS / TRIALS;
        deviation += errors.height_deviation * errors.height_deviation * SUMMITS / TRIALS;
        summit_list_clear(&list);
    }
    check_relative(density, 1, tolerance(19));
    check_relative(height, 1, tolerance(19));
    check_relative(curvature, 1, tolerance(19));
    check_relative(deviation, 0.5, tolerance(19) + 0.02);
    cell_heights_destroy(&heights);
}

/* Of a map that was cut short the number of points searched in each cell is reported. */
static void searched_points(void **state) {
    (void)state;
    static double z[POINTS];
    static struct low_modes modes;
    const struct measured_map map = {&GRID, z, BOUNDARY_OPEN};
    double searched[LOW_CELLS_MOST];
    assert_true(low_modes_fill(&map, NULL, &modes));
    assert_int_equal(summit_cells_count(&map, &modes, 1, 1, searched, NULL), 0);
    check_close(searched[0], 4, 0);
    check_close(searched[1], 6, 0);
    check_close(searched[17], 9, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(independent_heights),   cmocka_unit_test(errors_inside),
        cmocka_unit_test(far_heights),           cmocka_unit_test(far_valleys),
        cmocka_unit_test(differences_of_a_wave), cmocka_unit_test(scattered_summits),
        cmocka_unit_test(searched_points)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
