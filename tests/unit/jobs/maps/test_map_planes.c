/* Protects: the planes of autocorrelation and spectral density of a map: the lag and the wave
 * vector 0 in the middle, symmetry, and that both hold the mean square height. */
#include "core/random.h"
#include "jobs/maps/map_planes.h"
#include "tests/support/check.h"
#include <stdlib.h>

enum { POINTS_MOST = 32 * 32 };

/* Random heights, or a wave of amplitude 2 along (2, 1). */
static void heights_fill(double *z, const struct grid *grid, bool wave) {
    size_t n = grid_points(grid);
    random_uniform((struct random_key){5, 0, 0}, STREAM_HEIGHTS, 0, n, z);
    for (size_t a = 0; a < n && wave; a++) {
        size_t i = a % grid->nx, j = a / grid->nx;
        double x = (double)i / (double)grid->nx, y = (double)j / (double)grid->ny;
        z[a] = 2 * cos(2 * M_PI * (2 * x + y));
    }
}

static double variance_of(const double *z, size_t n) {
    double mean = 0, square = 0;
    for (size_t a = 0; a < n; a++)
        mean += z[a] / (double)n;
    for (size_t a = 0; a < n; a++)
        square += (z[a] - mean) * (z[a] - mean) / (double)n;
    return square;
}

static void check_symmetric(const struct map_plane *plane) {
    size_t n = grid_points(&plane->grid);
    assert_true(plane->grid.nx % 2 == 1 && plane->grid.ny % 2 == 1);
    for (size_t a = 0; a < n; a++)
        check_close(plane->values[a], plane->values[n - 1 - a], 1e-12);
}

/* Of periodic maps of even and odd sides, and of profiles. */
static void planes_hold_the_mean_square(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {
        {32, 32, 4, 4}, {31, 16, 3.1, 3.2}, {16, 31, 2, 5}, {32, 1, 4, 1}, {31, 1, 4, 1}};
    static double z[POINTS_MOST];
    for (size_t n = 0; n < sizeof GRIDS / sizeof *GRIDS; n++) {
        const struct grid *grid = &GRIDS[n];
        struct measured_map map = {grid, z, BOUNDARY_PERIODIC};
        struct map_plane acf, psd;
        heights_fill(z, grid, false);
        double variance = variance_of(z, grid_points(grid)), sum = 0;
        assert_int_equal(map_acf_plane(&acf, &map, NULL), 0);
        assert_int_equal(map_psd_plane(&psd, &map, NULL), 0);
        check_symmetric(&acf);
        check_symmetric(&psd);
        check_relative(acf.values[grid_points(&acf.grid) / 2], variance, 1e-12);
        for (size_t a = 0; a < grid_points(&psd.grid); a++)
            sum += psd.values[a];
        double area = grid_dx(&psd.grid) * (grid_is_profile(grid) ? 1 : grid_dy(&psd.grid));
        check_relative(sum * area, variance, 1e-12);
        map_plane_clear(&acf);
        map_plane_clear(&psd);
        assert_null(acf.values);
    }
}

static void a_wave_is_where_it_is(void **state) {
    (void)state;
    static double z[POINTS_MOST];
    const struct grid grid = {32, 32, 4, 4};
    struct measured_map map = {&grid, z, BOUNDARY_PERIODIC};
    struct map_plane acf, psd;
    heights_fill(z, &grid, true);
    assert_int_equal(map_acf_plane(&acf, &map, NULL), 0);
    assert_int_equal(map_psd_plane(&psd, &map, NULL), 0);
    for (size_t j = 0; j < acf.grid.ny; j++)
        for (size_t i = 0; i < acf.grid.nx; i++) {
            double x = ((double)i - 16) / 32, y = ((double)j - 16) / 32;
            check_close(acf.values[j * acf.grid.nx + i], 2 * cos(2 * M_PI * (2 * x + y)), 1e-12);
        }
    size_t middle_x = psd.grid.nx / 2, middle_y = psd.grid.ny / 2;
    double cell = grid_dx(&psd.grid) * grid_dy(&psd.grid);
    check_relative(grid_dx(&psd.grid), 2 * M_PI / 4, 1e-14);
    check_relative(psd.values[(middle_y + 1) * psd.grid.nx + middle_x + 2] * cell, 1, 1e-12);
    check_close(psd.values[(middle_y - 1) * psd.grid.nx + middle_x + 2], 0, 1e-12);
    map_plane_clear(&acf);
    map_plane_clear(&psd);
}

/* Holes of an open map lack pairs, and no plane is made of holes alone. */
static void open_maps_and_holes(void **state) {
    (void)state;
    static double z[POINTS_MOST];
    const struct grid grid = {32, 32, 4, 4};
    struct measured_map map = {&grid, z, BOUNDARY_OPEN};
    struct map_plane plane;
    struct error err = {0};
    heights_fill(z, &grid, true);
    z[5] = NAN;
    assert_int_equal(map_psd_plane(&plane, &map, &err), 0);
    check_symmetric(&plane);
    map_plane_clear(&plane);
    for (size_t a = 0; a < POINTS_MOST; a++)
        z[a] = NAN;
    assert_int_equal(map_psd_plane(&plane, &map, &err), ERROR_INPUT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_hold_the_mean_square),
        cmocka_unit_test(a_wave_is_where_it_is),
        cmocka_unit_test(open_maps_and_holes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
