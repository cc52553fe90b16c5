/* Protects: the trend that is taken out of a height map is the one of least squares, in the unit of
 * the grid, whatever its size; holes have no part in it. */
#include "core/map/preparation/detrend.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <string.h>

enum { NX = 13, NY = 9 };

static const struct grid GRID = {NX, NY, NX * 0.5, NY * 2.0};

static double noise(uint64_t *state) {
    return (double)(next_word(state) >> 11) * 0x1p-53 - 0.5;
}

/* x and y from the middle of the points. */
static double place_x(size_t i) {
    return ((double)i - (NX - 1) / 2.0) * 0.5;
}
static double place_y(size_t j) {
    return ((double)j - (NY - 1) / 2.0) * 2;
}

static double trend_at(const struct trend *t, double x, double y) {
    return t->height + t->slope_x * x + t->slope_y * y +
           (t->bend_xx * x * x + 2 * t->bend_xy * x * y + t->bend_yy * y * y) / 2;
}

static void trends_are_found(void **state) {
    (void)state;
    static const struct trend TREND = {3, -2e3, 0.5, 0.25, -0.125, 7};
    double z[NX * NY];
    struct trend found;
    for (size_t point = 0; point < NX * NY; point++)
        z[point] = point % 7 == 3 ? (double)NAN
                                  : trend_at(&TREND, place_x(point % NX), place_y(point / NX));
    assert_int_equal(detrend(&GRID, z, DETREND_QUADRATIC, &found, NULL), 0);
    check_relative(found.height, TREND.height, 1e-9);
    check_relative(found.slope_x, TREND.slope_x, 1e-12);
    check_relative(found.slope_y, TREND.slope_y, 1e-9);
    check_relative(found.bend_xx, TREND.bend_xx, 1e-9);
    check_relative(found.bend_xy, TREND.bend_xy, 1e-9);
    check_relative(found.bend_yy, TREND.bend_yy, 1e-9);
    for (size_t point = 0; point < NX * NY; point++) {
        assert_int_equal(isnan(z[point]) != 0, point % 7 == 3);
        if (!isnan(z[point]))
            check_close(z[point], 0, 1e-11);
    }
}

/* What is left has no part of any term: the condition of least squares. */
static void what_is_left_is_orthogonal(void **state) {
    (void)state;
    uint64_t seed = seed_or(5);
    double noisy[NX * NY], z[NX * NY];
    for (size_t point = 0; point < NX * NY; point++)
        noisy[point] = point % 11 == 5 ? (double)NAN : noise(&seed) + 1e6 * (double)(point % NX);
    for (enum detrend kind = DETREND_MEAN; kind <= DETREND_QUADRATIC; kind++) {
        struct trend found;
        double sums[6] = {0};
        memcpy(z, noisy, sizeof z);
        assert_int_equal(detrend(&GRID, z, kind, &found, NULL), 0);
        for (size_t point = 0; point < NX * NY; point++) {
            double x = place_x(point % NX), y = place_y(point / NX), left = z[point];
            if (isnan(left))
                continue;
            check_close(left + trend_at(&found, x, y), noisy[point], 1e-8);
            const double terms[] = {1, x, y, x * x, x * y, y * y};
            for (size_t t = 0; t < 6; t++)
                sums[t] += left * terms[t];
        }
        size_t fitted = kind == DETREND_MEAN ? 1 : kind == DETREND_PLANE ? 3 : 6;
        double scale = kind == DETREND_MEAN ? 1e-3 : 1e-7; /* of 1e6 that are left, and of 1 */
        for (size_t t = 0; t < fitted; t++)
            check_close(sums[t], 0, scale);
    }
}

static void nothing_is_left_alone(void **state) {
    (void)state;
    const double heights[] = {1, 4, NAN, 2};
    const struct grid profile = {4, 1, 4, 4};
    double z[4];
    struct trend found;
    memcpy(z, heights, sizeof z);
    assert_int_equal(detrend(&profile, z, DETREND_NONE, &found, NULL), 0);
    assert_memory_equal(z, heights, sizeof z);
    assert_true(found.height == 0 && found.slope_x == 0);
    assert_int_equal(detrend(&profile, z, DETREND_PLANE, &found, NULL), 0);
    check_close(z[0] + z[1] + z[3], 0, 1e-14);
    assert_true(found.slope_y == 0);
}

static void too_little_is_told(void **state) {
    (void)state;
    const double two[] = {1, 2, NAN, NAN}, none[] = {NAN, NAN, NAN, NAN};
    const double line[] = {1, 2, 3, NAN, NAN, NAN, NAN, NAN, NAN};
    const struct grid profile = {4, 1, 4, 4}, square = {3, 3, 3, 3};
    double z[9];
    struct trend found;
    struct error err = {0};
    memcpy(z, two, sizeof two);
    assert_int_equal(detrend(&profile, z, DETREND_QUADRATIC, &found, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "too few"));
    assert_memory_equal(z, two, sizeof two);
    memcpy(z, none, sizeof none);
    assert_int_equal(detrend(&profile, z, DETREND_MEAN, &found, &err), ERROR_INPUT);
    memcpy(z, line, sizeof line);
    assert_int_equal(detrend(&square, z, DETREND_PLANE, &found, &err), ERROR_INPUT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trends_are_found),
        cmocka_unit_test(what_is_left_is_orthogonal),
        cmocka_unit_test(nothing_is_left_alone),
        cmocka_unit_test(too_little_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
