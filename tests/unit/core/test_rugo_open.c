/* Protects: the public functions of rugo.h for maps that do not repeat: each is the one that its
 * name says, holes are left out, and wrong arguments are reported. */
#include "core/rugo.h"
#include "tests/support/check.h"
#include "tests/support/cut.h"
#include <string.h>

enum { NX = 90, NY = 80 };
static const struct rugo_grid OPEN = {NX, NY, 11.25, 10};

/* A sub-map of a surface of 8 points a shortest wave, tilted. */
static double *piece_create(void) {
    const struct grid whole = {256, 256, 32, 32};
    struct grid piece;
    double *z = whole_surface(&whole, 0.8, 4), *part = cut(&whole, z, 9, 17, NX, NY, &piece);
    for (size_t point = 0; point < (size_t)NX * NY; point++)
        part[point] += 0.5 * (double)(point % NX);
    free(z);
    return part;
}

static void a_piece_is_measured(void **state) {
    (void)state;
    double *z = piece_create(), seam = 0, searched = 0;
    struct rugo_roughness tilted, level;
    struct rugo_moments moments;
    struct rugo_error err = {0};
    assert_int_equal(rugo_seam(&OPEN, z, &seam, &err), 0);
    assert_true(seam > 5);
    assert_int_equal(rugo_open_roughness(&OPEN, z, &tilted, &err), 0);
    assert_int_equal(rugo_detrend(&OPEN, z, RUGO_PLANE, &err), 0);
    assert_int_equal(rugo_open_roughness(&OPEN, z, &level, &err), 0);
    check_relative(level.rms_curvature, tilted.rms_curvature, 1e-9);
    assert_true(level.rms_slope < tilted.rms_slope);
    check_close(level.mean, 0, 1e-12);
    assert_int_equal(rugo_open_moments(&OPEN, z, &moments, &err), 0);
    check_relative(moments.rms_slope, level.rms_slope, 0.1);
    assert_true(moments.rms_curvature > level.rms_curvature); /* differences underestimate */
    z[40 * NX + 40] = NAN;
    struct rugo_summits all, some;
    assert_int_equal(rugo_open_summits_find(&some, &searched, &OPEN, z, RUGO_NINE_POINT, &err), 0);
    check_relative(searched, (88 * 78 - 9) * 0.125 * 0.125, 1e-12);
    assert_int_equal(rugo_open_summits_find(&all, &searched, &OPEN, z, RUGO_FIVE_POINT, &err), 0);
    assert_true(all.count > some.count && some.count > 10);
    rugo_summits_clear(&some);
    assert_int_equal(rugo_open_summits_find(&some, &searched, &OPEN, z, RUGO_REFINED, &err), 0);
    check_relative(searched, (73 * 63 - 18 * 18) * 0.125 * 0.125, 1e-12);
    assert_true(some.count > 5 && some.count < all.count);
    rugo_summits_clear(&some);
    rugo_summits_clear(&all);
    free(z);
}

/* Periodic maps have all heights; of a map without any nothing is known. */
static void holes_are_refused_where_none_may_be(void **state) {
    (void)state;
    double z[64], wave_number[64], density[64];
    const struct rugo_grid grid = {8, 8, 1, 1};
    struct rugo_roughness roughness;
    struct rugo_moments moments;
    struct rugo_summits summits = {0};
    struct rugo_error err = {0};
    for (size_t point = 0; point < 64; point++)
        z[point] = point == 19 ? (double)NAN : (double)(point % 7);
    assert_int_equal(rugo_roughness(&grid, z, &roughness, &err), RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "1 of 64 heights are holes (NaN), the first in row 3"));
    assert_int_equal(rugo_moments(&grid, z, &moments, &err), RUGO_ERROR_INPUT);
    assert_true(rugo_psd_size(&grid) <= 64);
    assert_int_equal(rugo_psd(&grid, z, wave_number, density, &err), RUGO_ERROR_INPUT);
    assert_int_equal(rugo_summits_find(&summits, &grid, z, RUGO_NINE_POINT, &err),
                     RUGO_ERROR_INPUT);
    for (size_t point = 0; point < 64; point++)
        z[point] = NAN;
    assert_int_equal(rugo_open_roughness(&grid, z, &roughness, &err), 0);
    assert_true(isnan(roughness.lowest) && isnan(roughness.highest) && isnan(roughness.mean));
}

/* Heights that were not measured are read where they are asked for alone, and can be measured on.
 */
static void a_map_with_holes_is_read(void **state) {
    (void)state;
    static const struct rugo_grid GRID = {4, 3, 2, 1.5};
    const double z[12] = {0, 1, 0, NAN, 2, 0, 1, 0, 0, 0, 1, 0};
    static const char *const NAMES[] = {"hole.npy", "hole.csv", "hole.xyz"};
    for (size_t n = 0; n < 3; n++) {
        struct rugo_map map = {.z = NULL};
        struct rugo_error err = {0};
        struct rugo_roughness roughness;
        assert_int_equal(rugo_map_write(NAMES[n], &GRID, z, &err), 0);
        assert_int_equal(rugo_map_read(&map, NAMES[n], 0.5, &err), RUGO_ERROR_INPUT);
        assert_non_null(strstr(err.text, "hole"));
        assert_null(map.z);
        assert_int_equal(rugo_open_map_read(&map, NAMES[n], 0.5, &err), 0);
        assert_true(map.grid.nx == 4 && map.grid.ny == 3 && map.grid.lx == 2);
        for (size_t a = 0; a < 12; a++)
            assert_true(isnan(z[a]) ? isnan(map.z[a]) : map.z[a] == z[a]);
        assert_int_equal(rugo_open_roughness(&map.grid, map.z, &roughness, &err), 0);
        check_close(roughness.mean, 5 / 11.0, 1e-12);
        rugo_map_clear(&map);
    }
    struct rugo_map none = {.z = NULL};
    assert_int_equal(rugo_open_map_read(&none, "absent.npy", 0, NULL), RUGO_ERROR_SYSTEM);
}

static void areal_parameters_and_density(void **state) {
    (void)state;
    double *z = piece_create();
    double wave_number[200], density[200];
    struct rugo_roughness roughness;
    struct rugo_areal open, periodic;
    struct rugo_error err = {0};
    assert_int_equal(rugo_detrend(&OPEN, z, RUGO_QUADRATIC, &err), 0);
    assert_int_equal(rugo_open_roughness(&OPEN, z, &roughness, &err), 0);
    assert_int_equal(rugo_areal(&OPEN, z, 1, &open, &err), 0);
    check_relative(open.sq, roughness.rms_height, 1e-12);
    check_relative(open.sdq, roughness.rms_slope, 1e-12);
    check_relative(open.sz, roughness.highest - roughness.lowest, 1e-12);
    check_relative(open.ssk, roughness.skewness, 1e-9);
    check_relative(open.sku, roughness.kurtosis, 1e-12);
    assert_true(open.sa < open.sq && open.sp > 0 && open.sv > 0 && open.sdr > 0);
    assert_true(open.sal > 0.2 && open.sal < 3 && open.str <= 1 && open.spd > 0 && open.spc > 0);
    assert_int_equal(rugo_areal(&OPEN, z, 0, &periodic, &err), 0);
    assert_true(periodic.sdq > open.sdq); /* over the seam */
    assert_true(rugo_psd_size(&OPEN) <= 200);
    assert_int_equal(rugo_open_psd(&OPEN, z, wave_number, density, &err), 0);
    check_relative(wave_number[1], 2 * M_PI / 10, 1e-12);
    assert_true(density[5] > 1e3 * density[20] && density[20] > 0); /* 2 and half a wavelength */
    free(z);
}

static void wrong_arguments_are_told(void **state) {
    (void)state;
    const struct rugo_grid profile = {8, 1, 8, 1}, empty = {0, 8, 1, 1}, square = {3, 3, 3, 3};
    double z[9] = {1, 2, 3, 4, NAN, 6, 7, 8, 9}, number = -1;
    struct rugo_areal areal = {.sa = -1};
    struct rugo_roughness roughness;
    struct rugo_moments moments;
    struct rugo_summits summits;
    struct rugo_error err = {0};
    assert_int_equal(rugo_areal(&profile, z, 1, &areal, &err), RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "profile"));
    assert_int_equal(rugo_areal(&square, z, 0, &areal, &err), RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "a hole (NaN), point 4"));
    assert_true(areal.sa == -1);
    assert_int_equal(rugo_detrend(&square, z, (enum rugo_trend)7, &err), RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "trend 7"));
    assert_int_equal(
        rugo_open_summits_find(&summits, &number, &square, z, (enum rugo_summit_rule)9, &err),
        RUGO_ERROR_INPUT);
    assert_int_equal(rugo_seam(&empty, z, &number, &err), RUGO_ERROR_INPUT);
    assert_int_equal(rugo_open_roughness(&empty, z, &roughness, &err), RUGO_ERROR_INPUT);
    assert_int_equal(rugo_open_moments(&empty, z, &moments, &err), RUGO_ERROR_INPUT);
    assert_int_equal(rugo_open_psd(&empty, z, z, z, &err), RUGO_ERROR_INPUT);
    assert_true(number == -1);
}

/* Hertz's sphere: area pi a^2 and approach a^2/R of a paraboloid, a = 2 and R = 50. */
static void open_map_is_pressed(void **state) {
    (void)state;
    const struct rugo_grid grid = {60, 60, 6, 6};
    struct rugo_contact *contact = NULL;
    struct rugo_contact_state now;
    struct rugo_error err = {0};
    double z[3600], pressure = 4.0 / 3 * 8 / 50 / 36;
    for (int i = 0; i < 3600; i++)
        z[i] = -(pow(i % 60 / 10.0 - 3, 2) + pow(floor(i / 60.0) / 10 - 3, 2)) / 100;
    assert_int_equal(rugo_contact_create_open(&contact, &grid, &err), 0);
    assert_int_equal(rugo_contact_begin(contact, z, &err), 0);
    assert_true(isnan(rugo_contact_approach(contact)));
    assert_true(isnan(rugo_contact_full_pressure(contact)));
    assert_int_equal(rugo_contact_press(contact, pressure, &now, &err), 0);
    check_relative(now.area * 36, 4 * M_PI, 0.005);
    check_relative(rugo_contact_approach(contact), 4.0 / 50, 0.005);
    assert_int_equal(now.patches, 1);
    rugo_contact_destroy(&contact);
    assert_int_equal(rugo_contact_create_open(&contact, &(struct rugo_grid){1, 4, 1, 1}, &err),
                     RUGO_ERROR_INPUT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_piece_is_measured),
        cmocka_unit_test(a_map_with_holes_is_read),
        cmocka_unit_test(holes_are_refused_where_none_may_be),
        cmocka_unit_test(areal_parameters_and_density),
        cmocka_unit_test(wrong_arguments_are_told),
        cmocka_unit_test(open_map_is_pressed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
