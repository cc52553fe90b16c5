/* Protects: a surface with a counter face is the sum of two independent faces, with the sum of
 * their spectra; and a surface without one is as it was. */
#include "core/surface/counter_face.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static struct spectrum self_affine(double hurst, double longest, double shortest, double slope) {
    return (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                             .hurst = hurst,
                             .wavelength_long = longest,
                             .wavelength_rolloff = longest,
                             .wavelength_short = shortest,
                             .scale = SCALE_RMS_SLOPE,
                             .scale_value = slope};
}

static double *generate(const struct spectrum *spectrum, const struct grid *grid,
                        struct random_key key, struct generator **generator) {
    double *z = malloc(grid_points(grid) * sizeof *z);
    assert_non_null(z);
    assert_int_equal(generator_create(generator, spectrum, grid, &SURFACE_DEFAULTS, NULL), 0);
    assert_int_equal(generator_run(*generator, key, z, NULL, NULL), 0);
    return z;
}

static const struct grid GRIDS[] = {{64, 64, 8, 8}, {96, 32, 12, 4}, {512, 1, 32, 1}};

/* Heights are the sum of both faces, each of which a generator of its own makes; powers and moments
 * are sums, and the drawn spectrum is that of the heights. */
static void sum_of_both(void **state) {
    (void)state;
    for (size_t g = 0; g < 3; g++) {
        const struct grid *grid = &GRIDS[g];
        const struct random_key key = {7, 3, 2};
        struct random_key other_key = key;
        other_key.sequence ^= UINT64_C(1) << COUNTER_BIT;
        const struct spectrum one = self_affine(0.8, 4, 1, 0.1);
        const struct counter_face counter = {self_affine(0.3, 4, 0.5, 0.2), SURFACE_DEFAULTS};
        struct spectrum both = one;
        both.counter = &counter;
        struct generator *of_one = NULL, *of_other = NULL, *of_both = NULL;
        double *a = generate(&one, grid, key, &of_one);
        double *b = generate(&counter.spectrum, grid, other_key, &of_other);
        double *z = generate(&both, grid, key, &of_both);
        struct moments m, n, sum, drawn, asked;
        double square = 0, mean = 0;
        for (size_t i = 0; i < grid_points(grid); i++) {
            assert_true(z[i] == a[i] + b[i]);
            square += z[i] * z[i] / (double)grid_points(grid);
            mean += z[i] / (double)grid_points(grid);
        }
        modes_moments(generator_modes(of_one), &m);
        modes_moments(generator_modes(of_other), &n);
        modes_moments(generator_modes(of_both), &sum);
        modes_moments(generator_drawn(of_both), &drawn);
        assert_int_equal(spectrum_moments(&both, grid, &asked, NULL), 0);
        check_close(sum.m00, m.m00 + n.m00, 1e-14 * sum.m00);
        check_close(sum.rms_slope, hypot(0.1, 0.2), 1e-14);
        check_close(sum.m40, m.m40 + n.m40, 1e-13 * sum.m40);
        check_close(asked.m40, sum.m40, 1e-14 * sum.m40);
        check_close(drawn.m00, square - mean * mean, 1e-12 * square);
        assert_true(generator_modes(of_both)->count == generator_modes(of_other)->count);
        generator_destroy(&of_one);
        generator_destroy(&of_other);
        generator_destroy(&of_both);
        free(a);
        free(b);
        free(z);
    }
}

/* Faces of equal spectra are uncorrelated. The correlation of two fields of m independent waves of
 * random phase is the mean of cosines: its variance is 1/m for equal amplitudes, and the sum of
 * squares of powers over the square of their sum in general. The mean square over n realisations is
 * within 5 standard deviations, sqrt(2/n), of that. */
static void faces_are_independent(void **state) {
    (void)state;
    enum { REALISATIONS = 400 };
    const struct grid *grid = &GRIDS[0];
    const struct spectrum one = self_affine(0.8, 4, 1, 0.1);
    const struct counter_face counter = {one, SURFACE_DEFAULTS};
    struct spectrum both = one;
    both.counter = &counter;
    struct generator *of_one = NULL, *of_both = NULL;
    const struct random_key key = {1, 0, 0};
    double *a = generate(&one, grid, key, &of_one), *z = generate(&both, grid, key, &of_both);
    const struct modes *modes = generator_modes(of_one);
    double powers = 0, squares = 0, sum = 0;
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (long my = -(long)modes->mode_y; my <= (long)modes->mode_y; my++) {
            powers += modes_weight(grid, mx) * modes_power(modes, mx, my);
            squares += modes_weight(grid, mx) * pow(modes_power(modes, mx, my), 2);
        }
    for (uint64_t r = 0; r < REALISATIONS; r++) {
        double product = 0;
        struct random_key at = {1, 0, r};
        assert_int_equal(generator_run(of_one, at, a, NULL, NULL), 0);
        assert_int_equal(generator_run(of_both, at, z, NULL, NULL), 0);
        for (size_t i = 0; i < grid_points(grid); i++)
            product += a[i] * (z[i] - a[i]) / (double)grid_points(grid);
        sum += pow(product / powers, 2);
    }
    double expected = squares / (powers * powers);
    print_message("mean square of the correlation: %g of %g expected\n", sum / REALISATIONS,
                  expected);
    check_close(sum / REALISATIONS, expected, 5 * sqrt(2.0 / REALISATIONS) * expected);
    generator_destroy(&of_one);
    generator_destroy(&of_both);
    free(a);
    free(z);
}

/* Both report: iterations of both faces. */
static void iterated_faces_report(void **state) {
    (void)state;
    const struct grid *grid = &GRIDS[2];
    struct counter_face counter = {self_affine(0.5, 4, 1, 0.1), SURFACE_DEFAULTS};
    struct spectrum both = self_affine(0.8, 4, 1, 0.1);
    struct generator *generator = NULL;
    struct surface_report report;
    counter.options.heights = (struct heights){.type = HEIGHTS_WEIBULL_MIN, .shape = 2};
    both.counter = &counter;
    double *z = generate(&both, grid, (struct random_key){1, 0, 0}, &generator);
    assert_int_equal(generator_run(generator, (struct random_key){1, 0, 0}, z, &report, NULL), 0);
    assert_true(report.iterations > 0 && report.end != END_DIRECT && report.eps_h > 0);
    generator_destroy(&generator);
    free(z);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sum_of_both),
        cmocka_unit_test(faces_are_independent),
        cmocka_unit_test(iterated_faces_report),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
