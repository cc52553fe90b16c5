/* Protects: hills that stand out are those of a search from each peak, with ties, holes and sides.
 */
#include "core/statistics/summits/hills.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <math.h>

enum { SIDE_MOST = 14, WIDER = 64, POINTS_MOST = SIDE_MOST * (SIDE_MOST + WIDER) };

/* Higher, or as high and before it: as hills.c ranks peaks of one height. */
static bool outranks(const struct measured_map *map, long a, long b) {
    return map->z[a] > map->z[b] || (map->z[a] == map->z[b] && a < b);
}

static long wrapped(long i, long n) {
    return i < 0 ? i + n : i >= n ? i - n : i;
}

/* Visits all points that can be reached from a peak without going `least` below it; returns whether
 * one of them outranks it. */
static bool reaches_higher(const struct measured_map *map, long peak_i, long peak_j, double least) {
    long nx = (long)map->grid->nx, ny = (long)map->grid->ny, count = 1, peak = peak_j * nx + peak_i;
    bool seen[POINTS_MOST] = {false};
    struct {
        long i, j;
    } stack[POINTS_MOST] = {{peak_i, peak_j}};
    seen[peak] = true;
    while (count > 0) {
        long i = stack[--count].i, j = stack[count].j;
        if (outranks(map, j * nx + i, peak))
            return true;
        for (long step = 0; step < 9; step++) {
            long x = i + step % 3 - 1, y = j + step / 3 - 1;
            double z = map_height(map, x, y);
            long beside = wrapped(y, ny) * nx + wrapped(x, nx);
            if (isnan(z) || seen[beside] || !(z > map->z[peak] - least))
                continue;
            seen[beside] = true;
            stack[count].i = wrapped(x, nx);
            stack[count++].j = wrapped(y, ny);
        }
    }
    return false;
}

/* Whole numbers for heights, so that there are many ties. Some maps are wider than the blocks that
 * rows are searched in. */
static void hills_as_by_search(void **state) {
    (void)state;
    uint64_t seed = seed_or(4);
    size_t found = 0;
    for (int trial = 0; trial < 400; trial++) {
        size_t more = trial % 8 == 5 || trial % 8 == 6 ? WIDER : 0;
        const struct grid grid = {3 + next_word(&seed) % 12 + more, 3 + next_word(&seed) % 12, 2,
                                  3};
        double z[POINTS_MOST], least = (double)(1 + next_word(&seed) % 8);
        unsigned char whole[POINTS_MOST];
        bool open = trial % 2 == 0;
        for (size_t point = 0; point < grid_points(&grid); point++)
            z[point] = (double)(next_word(&seed) % 12);
        if (trial % 4 == 0)
            z[next_word(&seed) % grid_points(&grid)] = NAN;
        const struct measured_map map = {&grid, z, open ? BOUNDARY_OPEN : BOUNDARY_PERIODIC};
        struct hills hills;
        size_t marked = map_mark_whole(&map, 1, 1, whole), expected = 0;
        for (size_t j = 0; j < grid.ny; j++)
            for (size_t i = 0; i < grid.nx; i++)
                if (whole[j * grid.nx + i] != 0 && !reaches_higher(&map, (long)i, (long)j, least))
                    expected++;
        assert_int_equal(hills_find(&map, least, NULL, &hills, NULL), 0);
        assert_int_equal(hills.count, expected);
        if (marked > 0)
            check_relative(hills.density + 1,
                           1 + (double)expected / ((double)marked * 6 / (double)grid_points(&grid)),
                           1e-12);
        found += expected;
    }
    assert_true(found > 100);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(hills_as_by_search)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
