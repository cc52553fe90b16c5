/* Protects: quantities with units are read and printed as people write them; the loads of `press`
 * in each of their forms, the path of the flat, and what is refused. */
#include "server/command/map/press/press_coating.h"
#include "server/command/map/press/press_loads.h"
#include "server/command/map/press/press_path.h"
#include "server/show/quantity.h"
#include "tests/support/check.h"
#include <math.h>
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
    static const struct {
        const char *text, *reason;
    } WRONG[] = {{"1MPa,1kPa", "must rise; 1kPa is not above 1MPa"},
                 {"100", "100 has no unit, Pa or one with a prefix"},
                 {"100mpa", "\"mpa\" is not the unit Pa"},
                 {"1Pa,", "\"\" is no number above 0 with a unit"},
                 {"-1Pa", "\"-1Pa\" is no number above 0"},
                 {"1Pa,2Pa,3Pa,4Pa", "more than 3 values"}};
    double list[3];
    size_t count;
    struct error err = {0};
    assert_int_equal(quantities_parse("1kPa,1MPa", "Pa", 3, list, &count, &err), 0);
    assert_int_equal(count, 2);
    check_close(list[1], 1e6, 1e-6);
    for (size_t n = 0; n < sizeof WRONG / sizeof *WRONG; n++) {
        assert_int_equal(quantities_parse(WRONG[n].text, "Pa", 3, list, &count, &err), ERROR_INPUT);
        assert_non_null(strstr(err.text, WRONG[n].reason));
    }
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

static void units_are_readable(void **state) {
    (void)state;
    static const struct {
        const char *unit;
        double most, scale;
        const char *text;
    } SHOWN[] = {{"Pa", 3e9, 1e9, "GPa"},
                 {"m", 2e-6, 1e-6, "\xc2\xb5m"},
                 {"m^2", 4e-12, 1e-12, "\xc2\xb5m^2"},
                 {"1/m", 5e5, 1e3, "1/mm"},
                 {"1/m", 6.7e6, 1e6, "1/\xc2\xb5m"},
                 {"1/Pa", 2e-9, 1e-9, "1/GPa"},
                 {"1/m^2", 1e11, 1e12, "1/\xc2\xb5m^2"},
                 {"N/m", 2e3, 1e3, "kN/m"},
                 {"1", 7, 1, ""},
                 {"m", 0, 1, "m"}};
    for (size_t n = 0; n < sizeof SHOWN / sizeof *SHOWN; n++) {
        char text[32];
        check_relative(unit_readable(SHOWN[n].unit, SHOWN[n].most, text, sizeof text),
                       SHOWN[n].scale, 1e-12);
        assert_string_equal(text, SHOWN[n].text);
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
        {{.pressure = "2MPa,1MPa", .modulus = "1GPa"},
         "--pressure 2MPa,1MPa (up to 1000 rising ones, such as 1MPa,2MPa): must rise; 1MPa"},
        {{.loads = "0.2,0.1"}, "--loads 0.2,0.1: not up to 1000 rising numbers above 0"}};
    for (size_t n = 0; n < sizeof WRONG / sizeof *WRONG; n++) {
        struct press_loads loads;
        struct error err = {0};
        assert_int_equal(press_loads_parse(&loads, &WRONG[n].words, &err), ERROR_INPUT);
        assert_non_null(strstr(err.text, WRONG[n].text));
    }
}

static void coatings_are_read(void **state) {
    (void)state;
    const struct press_words words = {.poisson = 0.3, .modulus = "200GPa"};
    struct height_map map = {.grid = {10, 10, 1e-3, 1e-3}, .xy_unit = "m", .z_unit = "m"};
    struct coating coating;
    struct error err = {0};
    assert_int_equal(press_coating_parse(&coating, "200nm,0.5", &words, &map, &err), 0);
    check_relative(coating.thickness, 200e-9, 1e-14);
    assert_true(coating.modulus == 0.5 && coating.poisson == 0.3);
    assert_int_equal(press_coating_parse(&coating, "1um,4GPa,0.4", &words, &map, &err), 0);
    check_relative(coating.modulus, 0.02, 1e-14);
    assert_true(coating.poisson == 0.4);
    map.xy_unit[0] = '\0';
    assert_int_equal(press_coating_parse(&coating, "0.25,2,0", &words, &map, &err), 0);
    assert_true(coating.thickness == 0.25 && coating.modulus == 2 && coating.poisson == 0);
    assert_int_equal(press_coating_parse(&coating, NULL, &words, &map, &err), 0);
    assert_true(coating.thickness == 0);
}

static void coatings_are_refused(void **state) {
    (void)state;
    static const struct {
        bool metres, modulus;
        const char *text, *reason;
    } WRONG[] = {{true, true, "200nm", "allowed is THICKNESS,MODULUS or"},
                 {true, true, "200nm,1,0.3,4", "allowed is THICKNESS,MODULUS or"},
                 {true, true, "200,1", "the thickness is a length above 0 with its unit"},
                 {false, true, "200nm,1", "a number above 0 in the lengths of the map"},
                 {false, true, "0,1", "a number above 0 in the lengths of the map"},
                 {false, true, "1,x", "or a pressure with its unit, such as 4GPa"},
                 {false, true, "1,-2", "over that of the block is 0.001 to 1000"},
                 {false, true, "1,nan", "or a pressure with its unit, such as 4GPa"},
                 {false, true, "1,1MPa", "is 0.001 to 1000 times that of the block"},
                 {false, false, "1,4GPa", "needs that of the block: --modulus"},
                 {false, true, "1,2,0.5", "Poisson's ratio is 0 to 0.4999"},
                 {false, true, "1,2,", "Poisson's ratio is 0 to 0.4999"}};
    for (size_t n = 0; n < sizeof WRONG / sizeof *WRONG; n++) {
        const struct press_words words = {.modulus = WRONG[n].modulus ? "200GPa" : NULL};
        struct height_map map = {.grid = {10, 10, 1e-3, 1e-3}};
        struct coating coating;
        struct error err = {0};
        map.xy_unit[0] = WRONG[n].metres ? 'm' : '\0';
        assert_int_equal(press_coating_parse(&coating, WRONG[n].text, &words, &map, &err),
                         ERROR_INPUT);
        if (strstr(err.text, WRONG[n].reason) == NULL)
            fail_msg("\"%s\" does not contain \"%s\"", err.text, WRONG[n].reason);
        assert_true(coating.thickness == 0);
    }
}

static void paths_are_read(void **state) {
    (void)state;
    struct press_path path = {.at = NULL};
    struct error err = {0};
    assert_int_equal(press_path_parse(&path, "1,-0.5,0", 2, 0.3, &err), 0);
    const double expected[] = {0, 0.5, 1, 0.25, -0.5, -0.25, 0};
    assert_int_equal(path.count, 7);
    for (size_t i = 0; i < 7; i++)
        check_close(path.at[i], expected[i], 1e-15);
    press_path_clear(&path);
    assert_int_equal(press_path_parse(&path, NULL, 0, 0.3, &err), 0);
    assert_int_equal(path.count, 31);
    check_relative(path.at[30], 1.2, 1e-15);
    press_path_clear(&path);
    static const char *const WRONG[] = {"",    "0", "1,1", "1,2",  "1,",
                                        "1;2", "x", "nan", "2000", ",1"};
    for (size_t n = 0; n < sizeof WRONG / sizeof *WRONG; n++) {
        assert_int_equal(press_path_parse(&path, WRONG[n], 2, 0.3, &err), ERROR_INPUT);
        assert_non_null(strstr(err.text, "not up to 100 numbers"));
        assert_null(path.at);
    }
    assert_int_equal(press_path_parse(&path, "1,-2", 500, 0.3, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "--slide-steps 500 to each of 2 turning points"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quantities_are_read),  cmocka_unit_test(values_have_readable_prefixes),
        cmocka_unit_test(units_are_readable),   cmocka_unit_test(loads_are_read),
        cmocka_unit_test(loads_are_refused),    cmocka_unit_test(coatings_are_read),
        cmocka_unit_test(coatings_are_refused), cmocka_unit_test(paths_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
