/* Protects: heights that stand for points which were not measured are refused with their value,
 * their count and the option, and no others are; those that are named become holes, and with none
 * all stay. */
#include "core/map/preparation/missing.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <stdlib.h>
#include <string.h>

enum { NX = 20, NY = 10, POINTS = NX * NY };

static double z[POINTS];

/* Heights of RMS `height`, of which three have `mark` and one has `other`. */
static struct height_map make(double height, double mark, double other) {
    uint64_t seed = seed_or(5);
    noise_fill(&seed, POINTS, z);
    for (size_t point = 0; point < POINTS; point++)
        z[point] *= height;
    z[3] = z[50] = z[POINTS - 1] = mark;
    z[70] = other;
    return (struct height_map){.grid = {NX, NY, NX, NY}, .z = z};
}

static void marks_are_found(void **state) {
    (void)state;
    const double none = (double)NAN;
    const struct {
        double height, mark, other;
        const char *says; /* NULL: they are heights */
    } CASES[] = {
        {1, -9999, none, "3 of 200 heights are -9999, far from all others, "},
        {1, -9999, none, ": --missing -9999 makes holes of them, --missing none keeps them"},
        {1, -9999, 32767, "4 of 200 heights are -9999,32767, far"},
        {1, -9999, -32768, "4 of 200 heights are -32768,-9999, far"},
        {1, (double)1e38F, none, "3 of 200 heights are 9.99999968e+37, far"},
        {1, -3.4028234663852886e38, none, "--missing -3.40282347e+38 makes"},
        {1, -999, none, "3 of 200 heights are -999, far"},
        {1, -998, none, NULL},    /* a spike */
        {1000, -999, none, NULL}, /* among others */
        {3000, -9999, none, NULL},
        {0, -9999, 0, NULL}, /* a mask */
        {1, none, none, NULL},
        {1, -9999, 1000, "3 of 200 heights are -9999, far"}, /* with a spike */
    };
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        char text[MISSING_TEXT];
        struct error err = {0};
        struct height_map map = make(CASES[c].height, CASES[c].mark, CASES[c].other);
        int status = missing_take_out(&map, &(struct missing_marks){0}, text, &err);
        if (status != (CASES[c].says != NULL ? ERROR_INPUT : 0) ||
            (CASES[c].says != NULL && strstr(err.text, CASES[c].says) == NULL))
            fail_msg("case %zu: %d, %s", c, status, err.text);
        assert_string_equal(text, "");
    }
    struct height_map map = make(1, -9999, 32767);
    map.z_unit[0] = 'm'; /* what has units has marks of its own */
    char text[MISSING_TEXT];
    assert_int_equal(missing_take_out(&map, &(struct missing_marks){0}, text, NULL), 0);
}

/* Of texts the number in the file counts, whatever its unit, and the option is proposed in it. */
static void marks_of_texts_with_units_are_found(void **state) {
    (void)state;
    const struct {
        const char *unit;
        double of_one;
        const char *says; /* NULL: they are heights */
    } CASES[] = {
        {"m", 1e-6, "3 of 200 heights are -9999 in the file, far from all others, "},
        {"m", 1e-6, ": --missing -9999um makes holes of them"},
        {"m", 1e-9, ": --missing -9999nm makes"},
        {"m", 2e-11, "heights are -9999 in the file"},
        {"m", 2e-11, ": --missing -199.98nm makes"},
        {"m", 1, ": --missing -9999m makes"},
        {"V", 1, ": --missing -9999 makes"},
        {"V", -0.5, ": --missing 4999.5 makes"},
        {"m", 0, NULL}, /* a format with marks of its own, or a text that names its mark */
    };
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        char text[MISSING_TEXT];
        struct error err = {0};
        struct height_map map = make(1, -9999, 5);
        for (size_t point = 0; point < POINTS && CASES[c].of_one != 0; point++)
            z[point] *= CASES[c].of_one;
        map.z_of_one = CASES[c].of_one;
        map.z_unit[0] = *CASES[c].unit;
        int status = missing_take_out(&map, &(struct missing_marks){0}, text, &err);
        if (status != (CASES[c].says != NULL ? ERROR_INPUT : 0) ||
            (CASES[c].says != NULL && strstr(err.text, CASES[c].says) == NULL))
            fail_msg("case %zu: %d, %s", c, status, err.text);
        assert_true(map.z_of_one == 0);
    }
}

static void what_is_named_becomes_holes(void **state) {
    (void)state;
    const struct {
        struct missing_marks marks;
        char unit; /* 'm', or none */
        size_t holes;
        const char *says; /* beginning */
    } CASES[] = {
        {{.asked = true}, '\0', 0, ""},
        {{true, 1, {-9999}, false}, '\0', 3, "3 points, 1.5 %, became holes: heights of -9999"},
        {{true, 2, {5, 32767}, false}, '\0', 1, "1 points, 0.5 %, became holes: heights of 5 and"},
        {{true, 1, {-9999}, true}, 'm', 3, "3 points, 1.5 %, became holes: heights of -9999 m"},
        {{true, 1, {-9999}, true}, '\0', 0, "--missing has a unit, -9999 m, and the file's"},
        {{true, 1, {-9999}, false}, 'm', 0, "--missing -9999 needs a unit, such as -9999nm"},
    };
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        char text[MISSING_TEXT];
        struct error err = {0};
        struct height_map map = make(1, -9999, 32767);
        map.z_unit[0] = CASES[c].unit;
        int status = missing_take_out(&map, &CASES[c].marks, text, &err);
        const char *said = status == 0 ? text : err.text;
        if (strncmp(said, CASES[c].says, strlen(CASES[c].says)) != 0)
            fail_msg("case %zu: %s", c, said);
        size_t holes = 0;
        for (size_t point = 0; point < POINTS; point++)
            holes += isnan(z[point]) ? 1 : 0;
        assert_int_equal(holes, CASES[c].holes);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(marks_are_found),
        cmocka_unit_test(marks_of_texts_with_units_are_found),
        cmocka_unit_test(what_is_named_becomes_holes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
