/* Protects: x and y are exchanged, and maps turned by right angles, bit for bit and in the stated
 * direction. By other angles a map has the heights of its surface at the turned points, in the
 * largest rectangle inside, to what a spline of degree 7 leaves of waves of 4 points and more;
 * planes come back to rounding, holes stay holes, and the change of slopes covers the error. */
#include "core/map/preparation/map_turn.h"
#include "core/statistics/measured_map.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

enum { NX = 90, NY = 70 };
static const double DX = 0.5, DY = 0.4;

typedef double surface(double x, double y, double points);

/* Waves of so many of the wider points in three directions, about the middle of the map. */
static double waves(double x, double y, double points) {
    const double k = 2 * M_PI / (points * DX);
    return sin(k * x + 0.3) + cos(k * (0.6 * x + 0.8 * y)) + 0.7 * sin(k * (y - 0.2 * x) + 1);
}
static double plane(double x, double y, double points) {
    return 3 + 0.2 * x - 0.7 * y + 0 * points;
}

static void make(struct height_map *map, surface *height, double points) {
    *map = (struct height_map){.grid = {NX, NY, NX * DX, NY * DY}};
    map->z = array_create((size_t)NX * NY, sizeof *map->z);
    assert_non_null(map->z);
    for (size_t j = 0; j < NY; j++)
        for (size_t i = 0; i < NX; i++)
            map->z[j * NX + i] = height(((double)i - (NX - 1) / 2.0) * DX,
                                        ((double)j - (NY - 1) / 2.0) * DY, points);
}

static void right_angles_are_exact(void **state) {
    (void)state;
    struct height_map map, turned;
    make(&map, waves, 7);
    make(&turned, waves, 7);
    assert_int_equal(map_transpose(&turned, NULL), 0);
    assert_int_equal(turned.grid.nx, NY);
    check_relative(grid_dx(&turned.grid), DY, 1e-15);
    for (size_t j = 0; j < NX; j++)
        for (size_t i = 0; i < NY; i++)
            assert_true(turned.z[j * NY + i] == map.z[i * NX + j]);
    assert_int_equal(map_transpose(&turned, NULL), 0);
    assert_memory_equal(turned.z, map.z, NX * NY * sizeof *map.z);
    for (unsigned quarter = 1; quarter <= 4; quarter++) {
        assert_int_equal(map_turn_right(&turned, 1, NULL), 0);
        assert_int_equal(turned.grid.nx, quarter % 2 == 1 ? NY : NX);
        /* the first point of the first row goes to the end of it, and on around the corners */
        const size_t nx = turned.grid.nx, ny = turned.grid.ny;
        const size_t corner[] = {0, nx - 1, nx * ny - 1, (ny - 1) * nx};
        assert_true(turned.z[corner[quarter % 4]] == map.z[0]);
        assert_true(turned.z[corner[(quarter + 1) % 4]] == map.z[NX - 1]);
    }
    assert_memory_equal(turned.z, map.z, NX * NY * sizeof *map.z);
    assert_int_equal(map_turn_right(&turned, 3, NULL), 0);
    assert_int_equal(map_turn_right(&turned, 2, NULL), 0);
    assert_int_equal(map_turn_right(&turned, 3, NULL), 0);
    assert_memory_equal(turned.z, map.z, NX * NY * sizeof *map.z);
    height_map_clear(&map);
    height_map_clear(&turned);
}

/* Errors over the RMS height (rms[0]) and over the RMS slope (rms[1]) at points whose old position
 * lies so many points inside the old sides. */
static void errors_of(const struct height_map *map, double angle, surface *height, double points,
                      double inside, double rms[2]) {
    const struct grid *grid = &map->grid;
    struct average error = {0}, square = {0}, slope_error = {0}, slope = {0};
    double before = 0, true_before = 0;
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++) {
            const double u = ((double)i - (double)(grid->nx - 1) / 2) * grid_dx(grid);
            const double v = ((double)j - (double)(grid->ny - 1) / 2) * grid_dy(grid);
            const double x = cos(angle) * u + sin(angle) * v, y = cos(angle) * v - sin(angle) * u;
            const double z = map->z[j * grid->nx + i], right = height(x, y, points);
            assert_true(fabs(x) <= (NX - 1) * DX / 2 * (1 + 1e-9));
            assert_true(fabs(y) <= (NY - 1) * DY / 2 * (1 + 1e-9));
            if (fabs(x) <= ((NX - 1) / 2.0 - inside) * DX &&
                fabs(y) <= ((NY - 1) / 2.0 - inside) * DY) {
                average_add(&error, (z - right) * (z - right));
                average_add(&square, right * right);
                if (i > 0) {
                    average_add(&slope_error, pow(z - before - (right - true_before), 2));
                    average_add(&slope, pow(right - true_before, 2));
                }
            }
            before = z;
            true_before = right;
        }
    assert_true(error.count > 200);
    rms[0] = sqrt(average_value(&error) / average_value(&square));
    rms[1] = sqrt(average_value(&slope_error) / average_value(&slope));
}

static void other_angles_hold_heights_and_slopes(void **state) {
    (void)state;
    /* By the spline's response a wave of n points has a share of about sqrt(2) (n - 1)^-8 of others
     * in it: 2.2e-4 at 4 points, 2.5e-7 at 8; slopes of these shorter waves are n - 1 times as
     * steep. Longer waves have what comes in from the sides. */
    static const struct {
        double degrees, points, heights, slopes;
    } CASES[] = {{30, 4, 4e-4, 8e-4},   {30, 8, 5e-7, 4e-6},  {-8.5, 4, 4e-4, 8e-4},
                 {45, 5, 4e-5, 1.2e-4}, {100, 8, 5e-7, 4e-6}, {-160, 6, 5e-6, 2e-5},
                 {0.01, 4, 4e-4, 8e-4}, {300, 16, 5e-8, 3e-7}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct height_map map;
        struct map_turn_result done;
        double rms[2], all[2];
        const double angle = CASES[c].degrees * M_PI / 180;
        make(&map, waves, CASES[c].points);
        assert_int_equal(map_turn(&map, angle, &done, NULL), 0);
        check_relative(grid_dx(&map.grid), DY, 1e-12);
        check_relative(grid_dy(&map.grid), DY, 1e-12);
        errors_of(&map, angle, waves, CASES[c].points, 16, rms);
        errors_of(&map, angle, waves, CASES[c].points, 0, all);
        print_message("%g degrees, %g points a wave: heights %.2g, slopes %.2g, to the sides %.2g "
                      "%.2g; by degree 5 %.2g\n",
                      CASES[c].degrees, CASES[c].points, rms[0], rms[1], all[0], all[1],
                      done.slope_change);
        assert_true(rms[0] < CASES[c].heights && rms[1] < CASES[c].slopes);
        assert_true(done.slope_change > rms[1]);
        assert_true(all[1] < 0.05);
        height_map_clear(&map);
    }
}

/* The largest rectangle inside has two corners on the longer sides, or four; its area is known. */
static void the_rectangle_is_the_largest(void **state) {
    (void)state;
    const double w = (NX - 1) * DX, h = (NY - 1) * DY;
    for (int degrees = 5; degrees < 90; degrees += 10) {
        struct height_map map;
        struct map_turn_result done;
        const double angle = degrees * M_PI / 180;
        double most = 0;
        for (double aspect = 0.01; aspect < 100; aspect *= 1.001) { /* width over height */
            const double high = fmin(w / (aspect * cos(angle) + sin(angle)),
                                     h / (aspect * sin(angle) + cos(angle)));
            most = fmax(most, aspect * high * high);
        }
        make(&map, plane, 0);
        assert_int_equal(map_turn(&map, angle, &done, NULL), 0);
        const double wide = (double)(map.grid.nx - 1) * DY, high = (double)(map.grid.ny - 1) * DY;
        assert_true(wide * high <= most * (1 + 1e-9));
        assert_true((wide + DY) * (high + DY) > most * (1 - 1e-5));
        double rms[2];
        errors_of(&map, angle, plane, 0, 0, rms);
        assert_true(rms[0] < 1e-12 && done.slope_change < 1e-10);
        height_map_clear(&map);
    }
}

static double level(double x, double y, double points) {
    return 3 + 0 * (x + y + points);
}

/* Nothing changes where there is nothing: a share of no slope is none. */
static void level_maps_stay_level(void **state) {
    (void)state;
    struct height_map map;
    struct map_turn_result done;
    make(&map, level, 0);
    assert_int_equal(map_turn(&map, 0.3, &done, NULL), 0);
    for (size_t n = 0; n < grid_points(&map.grid); n++)
        check_close(map.z[n], 3, 1e-12);
    height_map_clear(&map);
    make(&map, level, 0);
    for (size_t n = 0; n < grid_points(&map.grid); n++)
        map.z[n] = 0;
    assert_int_equal(map_turn(&map, 0.3, &done, NULL), 0);
    check_close(done.slope_change, 0, 0);
    height_map_clear(&map);
}

static void holes_stay_holes(void **state) {
    (void)state;
    struct height_map map, whole;
    struct map_turn_result done;
    make(&whole, waves, 8);
    make(&map, waves, 8);
    for (size_t j = 30; j < 36; j++)
        for (size_t i = 40; i < 45; i++)
            map.z[j * NX + i] = (double)NAN;
    assert_int_equal(map_turn(&whole, 0.5, &done, NULL), 0);
    assert_int_equal(map_turn(&map, 0.5, &done, NULL), 0);
    double most = 0, area = 0;
    for (size_t point = 0; point < grid_points(&map.grid); point++)
        if (isnan(map.z[point]))
            area += DY * DY;
        else
            most = fmax(most, fabs(map.z[point] - whole.z[point]));
    check_relative(area, 6 * DX * 7 * DY, 0.15); /* the cells with a hole */
    print_message("beside holes heights differ by %.2g\n", most);
    assert_true(most < 0.2 && most > 0);
    height_map_clear(&map);
    height_map_clear(&whole);
}

static void what_cannot_be_turned_is_refused(void **state) {
    (void)state;
    double z[8] = {0};
    struct height_map profile = {.grid = {8, 1, 8, 8}, .z = z};
    struct height_map narrow = {.grid = {4, 2, 4, 2}, .z = z};
    struct map_turn_result done;
    struct error err = {0};
    z[0] = 1;
    assert_int_equal(map_transpose(&profile, &err), ERROR_INPUT);
    assert_int_equal(map_turn_right(&profile, 1, &err), ERROR_INPUT);
    assert_int_equal(map_turn(&profile, 1, &done, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "a profile has no second axis"));
    assert_int_equal(map_turn_right(&profile, 2, &err), 0);
    assert_true(profile.z == z && z[7] == 1 && z[0] == 0);
    assert_int_equal(map_turn(&narrow, 0.7, &done, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "allowed: 2 by 2 at least"));
    assert_true(narrow.z == z && narrow.grid.nx == 4);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(right_angles_are_exact),
        cmocka_unit_test(other_angles_hold_heights_and_slopes),
        cmocka_unit_test(the_rectangle_is_the_largest),
        cmocka_unit_test(level_maps_stay_level),
        cmocka_unit_test(holes_stay_holes),
        cmocka_unit_test(what_cannot_be_turned_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
