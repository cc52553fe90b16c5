/* Protects: points in any order are put on the grid on which they lie, with holes where there are
 * none, and points that lie on none are refused. */
#include "tests/support/check.h"

#include "core/instrument/point_grid.h"
#include "tests/support/seed.h"
#include <string.h>

enum { NX = 13, NY = 9, N = NX * NY };

/* All points of a grid in an order of their own, scattered by a share of a step; returns how many
 * are left when each `drop`th node has none. */
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

static int map_of(struct height_map *map, const double *x, const double *y, const double *z,
                  size_t n, struct error *err) {
    const struct point_list points = {.n = n, .stride = 1, .of = {x, y, z}, .measured = true};
    return point_grid_map(map, &points, (const double[]){1, 1}, err);
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
        if (map_of(&map, x, y, z, n, &err) != 0)
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

/* What printing with few digits changes of a position is not scatter, and what is printed does not
 * scatter: nodes near each other stay apart, however far the next one is. */
static void printed_coordinates(void **state) {
    (void)state;
    const double x[] = {0, 0.33, 0.67, 1, 1.33, 200}, y[] = {0, 0, 0, 0, 0, 1};
    struct point_list points = {.n = 5, .stride = 1, .of = {x, y, x}};
    struct height_map map = {0};
    struct error err = {0};
    assert_int_equal(point_grid_map(&map, &points, (const double[]){1, 1}, &err), 0);
    assert_true(map.grid.nx == 5 && map.grid.ny == 1);
    height_map_clear(&map);
    points.n = 6;
    assert_int_equal(point_grid_map(&map, &points, (const double[]){1, 1}, &err), ERROR_INPUT);
    assert_string_equal(err.text, "6 points lie on no regular grid along x");
}

/* Points of a table are every third number, and x and y have units of their own. */
static void numbers_of_a_table(void **state) {
    (void)state;
    const double table[] = {4, 0, 7, 5, 0, 8, 4, 2, 9};
    const struct point_list points = {.n = 3, .stride = 3, .of = {table, table + 1, table + 2}};
    struct height_map map = {0};
    struct error err = {0};
    assert_int_equal(point_grid_map(&map, &points, (const double[]){10, 100}, &err), 0);
    assert_true(map.grid.lx == 20 && map.grid.ly == 400);
    assert_true(map.z[0] == 7 && map.z[1] == 8 && map.z[2] == 9 && isnan(map.z[3]));
    height_map_clear(&map);
}

static void refuse(const double *x, const double *y, size_t n, const char *told) {
    double z[N] = {0};
    struct height_map map = {0};
    struct error err = {0};
    int status = map_of(&map, x, y, z, n, &err);
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
    refuse(x, y, N, "117 points lie on a grid of 117 x 117");
    x[1] = -1e308; /* their distance is above all numbers */
    x[0] = 1e308;
    refuse(x, y, N, "too far apart for a grid");
    refuse(x, y, 1, "1 points make no map");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_order), cmocka_unit_test(printed_coordinates),
        cmocka_unit_test(numbers_of_a_table), cmocka_unit_test(no_grid)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
