/* Protects: quantities with units are read and printed as people write them; the loads of `press`
 * in each of their forms, and what is refused; its solver against Hertz, mirrored and open. */
#include "server/command/press_error.h"
#include "server/command/press_loads.h"
#include "server/command/press_solver.h"
#include "server/command/quantity.h"
#include "tests/support/check.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void quantities_are_read(void **state) {
    (void)state;
    static const struct {
        const char *text, *unit;
        double value; /* 0: refused */
    } READ[] = {{"210GPa", "Pa", 210e9},   {"1 MPa", "Pa", 1e6},
                {"3e2Pa", "Pa", 300},      {".5kPa", "Pa", 500},
                {"2mN", "N", 2e-3},        {"7uN", "N", 7e-6},
                {"7\xc2\xb5N", "N", 7e-6}, {"10N/m", "N/m", 10},
                {"10kN/m", "N/m", 1e4},    {"210", "Pa", 0},
                {"210Gpa", "Pa", 0},       {"-1Pa", "Pa", 0},
                {"0Pa", "Pa", 0},          {"nanPa", "Pa", 0},
                {"infPa", "Pa", 0},        {"1e999Pa", "Pa", 0},
                {"1Pa,", "Pa", 0},         {"1N", "N/m", 0},
                {"1N/m", "N", 0},          {"0x1Pa", "Pa", 1},
                {"Pa", "Pa", 0},           {"", "Pa", 0}};
    for (size_t n = 0; n < sizeof READ / sizeof *READ; n++) {
        double value = 0;
        bool read = quantity_parse(READ[n].text, strlen(READ[n].text), READ[n].unit, &value);
        assert_int_equal(read, READ[n].value > 0);
        check_relative(value, READ[n].value, 1e-15);
    }
    double list[3];
    size_t count;
    assert_true(quantities_parse("1kPa,1MPa", "Pa", 3, list, &count));
    assert_int_equal(count, 2);
    check_close(list[1], 1e6, 1e-6);
    assert_false(quantities_parse("1MPa,1kPa", "Pa", 3, list, &count));
    assert_false(quantities_parse("1Pa,", "Pa", 3, list, &count));
    assert_false(quantities_parse("1Pa,2Pa,3Pa,4Pa", "Pa", 3, list, &count));
}

static void values_have_readable_prefixes(void **state) {
    (void)state;
    static const struct {
        double value, scale;
        const char *prefix;
    } SHOWN[] = {{210e9, 1e9, "G"},        {1, 1, ""},          {999, 1, ""},
                 {0.02, 1e-3, "m"},        {1e-15, 1e-12, "p"}, {-2e6, 1e6, "M"},
                 {3e-6, 1e-6, "\xc2\xb5"}, {0, 1, ""},          {NAN, 1, ""}};
    for (size_t n = 0; n < sizeof SHOWN / sizeof *SHOWN; n++) {
        double scale;
        assert_string_equal(quantity_prefix(SHOWN[n].value, &scale), SHOWN[n].prefix);
        check_close(scale, SHOWN[n].scale, 0);
    }
}

static void loads_are_read(void **state) {
    (void)state;
    struct press_loads loads;
    struct error err = {0};
    struct height_map map = {.grid = {10, 10, 1e-3, 2e-3}, .xy_unit = "m", .z_unit = "m"};
    struct press_words words = {.poisson = 0.3};
    assert_int_equal(press_loads_parse(&loads, &words, &err), 0);
    assert_int_equal(loads.count, 6);
    check_close(press_loads_mean(&loads, 0, 0.5, 7), 0.005, 1e-15);
    words = (struct press_words){.pressure = "1MPa,2MPa", .modulus = "91GPa", .poisson = 0.3};
    assert_int_equal(press_loads_parse(&loads, &words, &err), 0);
    check_relative(loads.modulus, 100e9, 1e-14);
    check_relative(press_loads_mean(&loads, 1, 0.5, 7), 2e-5, 1e-14);
    words = (struct press_words){.force = "1N,5N", .effective_modulus = "1GPa"};
    assert_int_equal(press_loads_parse(&loads, &words, &err), 0);
    assert_int_equal(press_loads_of_map(&loads, &map, &err), 0);
    check_relative(press_loads_mean(&loads, 1, 0.5, 2e-6), 2.5e-3, 1e-14);
    map.grid.ny = 1;
    assert_int_equal(press_loads_of_map(&loads, &map, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "such as 10N/m, as a profile has them"));
    map.xy_unit[0] = '\0';
    assert_int_equal(press_loads_of_map(&loads, &map, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "say --unit and --z-unit"));
}

static void loads_are_refused(void **state) {
    (void)state;
    static const struct {
        struct press_words words;
        const char *text;
    } WRONG[] = {
        {{.loads = "0.1", .force = "1N"}, "--loads, --pressure, --force: give one of the three"},
        {{.pressure = "1MPa"}, "--pressure needs the stiffness of the block: --modulus"},
        {{.force = "1N"}, "--force needs the stiffness of the block"},
        {{.modulus = "210"}, "--modulus 210: allowed is a pressure above 0 with its unit"},
        {{.modulus = "1Pa", .effective_modulus = "1Pa"}, "one of the two tells the other"},
        {{.pressure = "2MPa,1MPa", .modulus = "1GPa"}, "--pressure 2MPa,1MPa: not up to 1000"},
        {{.loads = "0.2,0.1"}, "--loads 0.2,0.1: not up to 1000 rising numbers above 0"}};
    for (size_t n = 0; n < sizeof WRONG / sizeof *WRONG; n++) {
        struct press_loads loads;
        struct error err = {0};
        assert_int_equal(press_loads_parse(&loads, &WRONG[n].words, &err), ERROR_INPUT);
        assert_non_null(strstr(err.text, WRONG[n].text));
    }
}

/* --- the solver --- */

/* A paraboloid of radius 50 on 60 x 60 points, its summit between them. */
static struct height_map summit(double x0, double y0) {
    struct height_map map = {.grid = {60, 60, 6, 6}};
    map.z = array_create(3600, sizeof *map.z);
    assert_non_null(map.z);
    for (size_t j = 0; j < 60; j++)
        for (size_t i = 0; i < 60; i++)
            map.z[j * 60 + i] =
                -(pow((double)i / 10 - x0, 2) + pow((double)j / 10 - y0, 2)) / (2 * 50);
    return map;
}

static void press_summit(const struct press_block *block, double x0, double y0,
                         double values[PRESS_VALUES], double *slope, double *height) {
    struct error err = {0};
    struct press press = {0};
    struct height_map map = summit(x0, y0);
    /* Hertz's radius is 2. */
    if (press_begin(&press, &map, block, &err) != 0 ||
        press_load(&press, 4.0 / 3 * 8 / 50 / 36, values, &err) != 0)
        fail_msg("%s", err.text);
    *slope = press.slope;
    *height = press.height;
    press_clear(&press);
    height_map_clear(&map);
}

static void open_map_is_pressed(void **state) {
    (void)state;
    const struct press_block open = {.boundary = PRESS_OPEN, .poisson = 0.3};
    double values[PRESS_VALUES] = {0}, slope = 0, height = 0;
    press_summit(&open, 3.02, 2.93, values, &slope, &height);
    check_relative(values[PRESS_EDGES] * 36, 4 * M_PI, 0.005);
    check_relative(values[PRESS_PEAK] * slope, 2 * 2 / (M_PI * 50), 0.005);
    check_relative(values[PRESS_APPROACH] * height, 4.0 / 50, 0.005);
    check_relative(values[PRESS_STIFFNESS] * slope / height * 36, 2 * 2, 0.01);
    check_close(values[PRESS_PATCHES], 1, 0);
}

/* A quarter of a summit in a corner, mirrored, is a summit, whose neighbours are twelve units off:
 * Hertz's area, and a quarter of a patch to each map. */
static void mirrored_map_is_pressed(void **state) {
    (void)state;
    const struct press_block mirrored = {.boundary = PRESS_MIRRORED, .poisson = 0.3};
    struct press_block layered = mirrored;
    double values[PRESS_VALUES] = {0}, meshed[PRESS_VALUES] = {0}, slope = 0, height = 0;
    press_summit(&mirrored, -0.05, -0.05, values, &slope, &height);
    /* The force of the map is that of a quarter: the radius grows by the cube root of four. */
    check_relative(values[PRESS_EDGES] * 36, M_PI * pow(4, 2.0 / 3), 0.08);
    check_close(values[PRESS_PATCHES], 0.25, 0);
    layered.model = PRESS_LAYERED;
    press_summit(&layered, -0.05, -0.05, meshed, &slope, &height);
    check_relative(meshed[PRESS_EDGES], values[PRESS_EDGES], 0.03);
}

/* The error of a sphere's contact lies within what every second point changes; maps that cannot be
 * thinned have none. */
static void points_make_an_error(void **state) {
    (void)state;
    struct press_block block = {.boundary = PRESS_OPEN, .poisson = 0.3};
    for (size_t odd = 0; odd < 3; odd++) {
        struct error err = {0};
        struct press press = {0};
        struct height_map map = summit(3.02, 2.93);
        double values[1][PRESS_VALUES], errors[1][PRESS_VALUES], load = 4.0 / 3 * 8 / 50 / 36;
        map.grid.ny -= odd; /* the last row away */
        map.grid.ly -= 0.1 * (double)odd;
        block.boundary = odd == 2 ? PRESS_MIRRORED : PRESS_OPEN;
        load *= 6 / map.grid.ly;
        if (press_begin(&press, &map, &block, &err) != 0 ||
            press_load(&press, load, values[0], &err) != 0)
            fail_msg("%s", err.text);
        press_release(&press);
        assert_int_equal(press_error(&press, &map, &block, 1, &load, values, errors, &err), 0);
        double area = values[0][PRESS_EDGES] * 6 * map.grid.ly;
        assert_true(errors[0][PRESS_EDGES] > 0 && errors[0][PRESS_EDGES] < 0.01);
        assert_true(errors[0][PRESS_PEAK] < 0.01 * values[0][PRESS_PEAK]);
        assert_true(errors[0][PRESS_MEAN_GAP] < 0.1 * values[0][PRESS_MEAN_GAP]);
        assert_true(isnan(errors[0][PRESS_NODES]));
        if (odd < 2)
            assert_true(fabs(area / (4 * M_PI) - 1) <= 2 * errors[0][PRESS_EDGES] * 36 / area);
        block.boundary = PRESS_PERIODIC;
        press.map.nx = 59;
        assert_int_equal(press_error(&press, &map, &block, 1, &load, values, errors, &err), 0);
        assert_true(isnan(errors[0][PRESS_EDGES]));
        press_clear(&press);
        height_map_clear(&map);
    }
}

static void full_model_is_pressed(void **state) {
    (void)state;
    struct press_block block = {.model = PRESS_FULL, .boundary = PRESS_MIRRORED, .poisson = 0.3};
    struct press press = {0};
    struct error err = {0};
    double values[2][PRESS_VALUES];
    for (size_t model = 0; model < 2; model++) {
        struct height_map map = {.grid = {40, 1, 10, 1}, .z = array_create(40, sizeof *map.z)};
        assert_non_null(map.z);
        for (size_t i = 0; i < 40; i++)
            map.z[i] = 0.05 * cos(2 * M_PI * ((double)i + 0.5) / 40);
        block.model = model == 0 ? PRESS_FULL : PRESS_LAYERED;
        if (press_begin(&press, &map, &block, &err) != 0 ||
            press_load(&press, 0.005, values[model], &err) != 0)
            fail_msg("%s", err.text);
        press_clear(&press);
        height_map_clear(&map);
    }
    check_relative(values[0][PRESS_EDGES], values[1][PRESS_EDGES], 0.05);
    assert_true(isnan(values[0][PRESS_APPROACH]));
}

static void meshes_of_open_maps_are_refused(void **state) {
    (void)state;
    struct press press = {0};
    struct error err = {0};
    struct height_map map = summit(3, 3);
    const struct press_block block = {.model = PRESS_FULL, .boundary = PRESS_OPEN, .poisson = 0.3};
    assert_int_equal(press_begin(&press, &map, &block, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "--model full needs a block that does: --boundary mirrored"));
    press_clear(&press);
    const struct press_block deep = {.boundary = PRESS_OPEN, .lengths = 2};
    assert_int_equal(press_begin(&press, &map, &deep, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "allowed: infinite"));
    press_clear(&press);
    memset(map.z, 0, 3600 * sizeof *map.z);
    assert_int_equal(press_begin(&press, &map, &block, &err), ERROR_INPUT);
    press_clear(&press);
    height_map_clear(&map);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quantities_are_read),
        cmocka_unit_test(values_have_readable_prefixes),
        cmocka_unit_test(loads_are_read),
        cmocka_unit_test(loads_are_refused),
        cmocka_unit_test(open_map_is_pressed),
        cmocka_unit_test(mirrored_map_is_pressed),
        cmocka_unit_test(points_make_an_error),
        cmocka_unit_test(full_model_is_pressed),
        cmocka_unit_test(meshes_of_open_maps_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
