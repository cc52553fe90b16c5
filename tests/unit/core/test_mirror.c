/* Protects: a mirrored map repeats without steps and holds the map in its first rows. */
#include "core/map/height_map.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static struct height_map map_of(size_t nx, size_t ny) {
    struct height_map map = {.grid = {nx, ny, 3, ny == 1 ? 1 : 5}, .xy_unit = "m", .z_unit = "m"};
    map.z = array_create(nx * ny, sizeof *map.z);
    assert_non_null(map.z);
    for (size_t i = 0; i < nx * ny; i++)
        map.z[i] = (double)(i * i);
    return map;
}

static void surface_is_mirrored_twice(void **state) {
    (void)state;
    struct height_map map = map_of(3, 2), before = map_of(3, 2);
    static const size_t ROW[] = {0, 1, 2, 2, 1, 0}, COLUMN[] = {0, 1, 1, 0};
    assert_int_equal(height_map_mirror(&map, NULL), 0);
    assert_int_equal(map.grid.nx, 6);
    assert_int_equal(map.grid.ny, 4);
    check_close(map.grid.lx, 6, 0);
    check_close(map.grid.ly, 10, 0);
    for (size_t j = 0; j < 4; j++)
        for (size_t i = 0; i < 6; i++)
            check_close(map.z[j * 6 + i], before.z[COLUMN[j] * 3 + ROW[i]], 0);
    assert_string_equal(map.xy_unit, "m");
    height_map_clear(&map);
    height_map_clear(&before);
}

static void profile_is_mirrored_once(void **state) {
    (void)state;
    struct height_map map = map_of(2, 1);
    static const double MIRRORED[] = {0, 1, 1, 0};
    assert_int_equal(height_map_mirror(&map, NULL), 0);
    assert_int_equal(map.grid.nx, 4);
    assert_int_equal(map.grid.ny, 1);
    check_close(map.grid.lx, 6, 0);
    assert_memory_equal(map.z, MIRRORED, sizeof MIRRORED);
    height_map_clear(&map);
}

static void too_large_a_map_stays(void **state) {
    (void)state;
    double z[1] = {0};
    struct error err = {0};
    struct height_map map = {.grid = {(size_t)1 << 30, 1, 1, 1}, .z = z};
    map.grid.ny = 2;
    assert_int_equal(height_map_mirror(&map, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "mirrored: a map of 4 rows of 2147483648 points"));
    assert_ptr_equal(map.z, z);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surface_is_mirrored_twice),
        cmocka_unit_test(profile_is_mirrored_once),
        cmocka_unit_test(too_large_a_map_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
