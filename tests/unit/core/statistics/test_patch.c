/* Protects: what is measured of a patch, on surfaces whose values are known; the same in any unit;
 * profiles; pits as summits upside down. */
#include "core/statistics/patch.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 128, WAVE = 16 };

/* sin x sin y of WAVE points a wave, less a tenth of it squared, so that pits are not as summits.
 */
static double *egg_box(struct grid *grid, size_t ny, double unit) {
    *grid = (struct grid){SIDE, ny, unit * SIDE, unit * (double)ny};
    double *z = calloc(SIDE * ny, sizeof *z);
    assert_non_null(z);
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < SIDE; i++) {
            double x = sin(2 * M_PI * ((double)i + 0.3) / WAVE);
            double y = ny == 1 ? 1 : sin(2 * M_PI * ((double)j + 0.3) / WAVE);
            z[j * SIDE + i] = unit * (x * y - 0.1 * x * y * x * y);
        }
    return z;
}

static void measure(size_t ny, double unit, double sign, double *out) {
    struct grid grid;
    double *z = egg_box(&grid, ny, unit);
    for (size_t i = 0; i < grid_points(&grid); i++)
        z[i] *= sign;
    const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
    assert_int_equal(patch_measure(&map, out, NULL), 0);
    free(z);
}

static bool near(double value, double expected, double tolerance) {
    return fabs(value - expected) <= tolerance * fabs(expected);
}

static void known_surface(void **state) {
    (void)state;
    double found[PATCH_QUANTITY_COUNT];
    measure(SIDE, 1, 1, found);
    /* mean square of s - s^2/10 - its mean, s = sin x sin y: 1/4 + (9/64 - 1/16)/100 */
    assert_true(near(found[PATCH_RMS_HEIGHT], sqrt(0.25 + (9.0 / 64 - 1.0 / 16) / 100), 1e-9));
    assert_true(found[PATCH_SKEWNESS] < 0);
    /* two summits a wave squared; those on the rim are not seen, nor is it searched */
    assert_true(near(found[PATCH_SUMMIT_DENSITY], 2.0 / (WAVE * WAVE), 0.1));
    assert_true(near(found[PATCH_PIT_DENSITY], 2.0 / (WAVE * WAVE), 0.1));
    assert_true(near(found[PATCH_SUMMIT_HEIGHT_MEAN], 0.9 + 0.025, 0.08));
    assert_true(near(found[PATCH_PIT_HEIGHT_MEAN], 1.1 - 0.025, 0.08));
    assert_true(found[PATCH_SUMMIT_HEIGHT_DEVIATION] < 0.01);
    /* cos x cos y is 0.2 at acos(0.2) along a side and at sqrt(2) acos(sqrt(0.2)) across */
    assert_true(near(found[PATCH_TEXTURE], acos(0.2) / (sqrt(2) * acos(sqrt(0.2))), 0.02));
    assert_true(near(found[PATCH_CORRELATION_LENGTH], acos(0.2) * WAVE / (2 * M_PI), 0.02));
    for (size_t a = 0; a < PATCH_QUANTITY_COUNT; a++)
        assert_true(isfinite(found[a]));
}

/* Each quantity changes with the unit of length as its power says, and with nothing else. */
static void powers_are_those_of_lengths(void **state) {
    (void)state;
    static const double UNIT = 3;
    for (int profile = 0; profile < 2; profile++) {
        double one[PATCH_QUANTITY_COUNT], other[PATCH_QUANTITY_COUNT];
        size_t ny = profile ? 1 : SIDE, told = 0;
        measure(ny, 1, 1, one);
        measure(ny, UNIT, 1, other);
        for (size_t a = 0; a < PATCH_QUANTITY_COUNT; a++) {
            double power = patch_power((enum patch_quantity)a, profile);
            assert_true(isnan(one[a]) == isnan(other[a]));
            if (isnan(one[a]))
                continue;
            told++;
            if (!near(other[a], one[a] * pow(UNIT, power), 1e-6) && fabs(one[a]) > 1e-9)
                fail_msg("%s: %g and %g", PATCH_NAMES[a], one[a], other[a]);
        }
        assert_true(told >= PATCH_QUANTITY_COUNT - 1); /* profiles have no texture */
    }
}

static void upside_down(void **state) {
    (void)state;
    double up[PATCH_QUANTITY_COUNT], down[PATCH_QUANTITY_COUNT];
    measure(SIDE, 1, 1, up);
    measure(SIDE, 1, -1, down);
    for (size_t a = 0; a < 4; a++)
        assert_true(near(down[PATCH_PIT_DENSITY + a], up[PATCH_SUMMIT_DENSITY + a], 1e-12) ||
                    fabs(up[PATCH_SUMMIT_DENSITY + a]) < 1e-12);
    assert_true(near(down[PATCH_LOWEST], -up[PATCH_HIGHEST], 1e-12));
    assert_true(near(down[PATCH_SKEWNESS], -up[PATCH_SKEWNESS], 1e-9));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_surface),
        cmocka_unit_test(powers_are_those_of_lengths),
        cmocka_unit_test(upside_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
