/* Protects: points in any order are put on the grid on which they lie, with holes where there are
 * none, and points that lie on none are refused. */
#include "tests/support/check.h"

#include "core/instrument/point_grid.h"
#include "tests/support/seed.h"
#include <string.h>

enum { NX = 13, NY = 9, N = NX * NY };

/* All points of a grid in an order of their own, scattered by a share of a step; returns how many
 * are left when each `drop`th place has none. */
static size_t scattered(double *x, double *y, double *z, double share, size_t drop, uint64_t seed) {
    size_t n = 0;
    for (size_t point = 0; point < N; point++) {
        size_t place = point * 50 % N;
        if (drop > 0 && place % drop == 1)
            continue;
        const size_t column = place % NX, row = place / NX;
        double off = share * ((double)(next_word(&seed) >> 11) * 0x1p-53 - 0.5) * 2;
        x[n] = 1e-3 + 2e-6 * ((double)column + off);
        y[n] = -7 + 3e-6 * ((double)row + off);
        z[n++] = (double)place;
    }
    return n;
}

static void any_order(void **state) {
    (void)state;
    const double shares[] = {0, 0.005};
    uint64_t seed = seed_or(3);
    double x[N], y[N], z[N];
    for (size_t pass = 0; pass < 4; pass++) {
        size_t drop = pass < 2 ? 0 : 7, n = scattered(x, y, z, shares[pass % 2], drop, seed);
        struct height_map map = {0};
        struct error err = {0};
        if (point_grid_map(&map, x, y, z, n, &err) != 0)
            fail_msg("%s", err.text);
        assert_true(map.grid.nx == NX && map.grid.ny == NY);
        check_relative(grid_dx(&map.grid), 2e-6, 2e-3);
        check_relative(grid_dy(&map.grid), 3e-6, 2e-3);
        assert_int_equal(height_map_holes(&map), N - n);
        for (size_t place = 0; place < N; place++)
            assert_true(drop > 0 && place % drop == 1 ? isnan(map.z[place])
                                                      : map.z[place] == (double)place);
        height_map_clear(&map);
    }
}

static void refuse(const double *x, const double *y, size_t n, const char *told) {
    double z[N] = {0};
    struct height_map map = {0};
    struct error err = {0};
    int status = point_grid_map(&map, x, y, z, n, &err);
    if (status != ERROR_INPUT || strstr(err.text, told) == NULL)
        fail_msg("%d, \"%s\" in place of \"%s\"", status, err.text, told);
    assert_null(map.z);
}

static void no_grid(void **state) {
    (void)state;
    uint64_t seed = seed_or(5);
    double x[N], y[N], z[N];
    size_t n = scattered(x, y, z, 0, 0, seed);
    x[5] += 0.3e-6;
    refuse(x, y, n, "lies on no regular grid");
    x[5] = x[6];
    y[5] = y[6];
    refuse(x, y, n, "lies where another one does");
    x[5] = INFINITY;
    refuse(x, y, n, "point 6 has no finite x");
    for (size_t point = 0; point < N; point++) {
        x[point] = (double)(next_word(&seed) >> 11);
        y[point] = (double)(next_word(&seed) >> 11);
    }
    refuse(x, y, N, "no regular grid");
    for (size_t point = 0; point < N; point++) /* a slanted line fills a map badly */
        x[point] = y[point] = (double)point;
    refuse(x, y, N, "one of 117 x 117 would be needed");
    x[1] = -1e308; /* their distance is above all numbers */
    x[0] = 1e308;
    refuse(x, y, N, "no regular grid");
    refuse(x, y, 1, "1 points make no map");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(any_order), cmocka_unit_test(no_grid)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
