/* Surface data files (ISO 25178-71): text as Gwyddion writes it and as the standard shows it,
 * binary of each type and version made here to the letter; holes; and damaged ones. */
#include "tests/support/instrument_files.h"

static void by_gwyddion(void **state) {
    (void)state;
    struct height_map map = bytes_map(bytes_of_fixture("gwyddion.sdf"), "gwyddion.sdf", NULL);
    assert_int_equal(check_fixture_map(&map, 1e-20), 0);
    height_map_clear(&map);
}

/* As the standard's own example: heights in lines of any length, BAD for what was not measured, a
 * trailer behind the second star. */
static const char TEXT[] = "aISO-1.0\r\n"
                           "ManufacID = ISOTC213\r\n"
                           "CreateDate = 040120100853\r\n"
                           "ModDate = 050320101353\r\n"
                           "NumPoints = 3\r\n"
                           "NumProfiles = 2\r\n"
                           "Xscale = 1.0E-6\r\n"
                           "Yscale = 2.0E-6\r\n"
                           "Zscale = 1.0E-9\r\n"
                           "Zresolution = -1\r\n"
                           "Compression = 0\r\n"
                           "DataType = 7\r\n"
                           "CheckType = 0\r\n"
                           "*\r\n"
                           "1.5 -2 BAD 4\r\n"
                           "5e0 6.25\r\n"
                           "*\r\n"
                           "<PartName> example </PartName>\r\n"
                           "*\r\n";

static void check_small(const struct height_map *map) {
    const double heights[6] = {1.5e-9, -2e-9, NAN, 4e-9, 5e-9, 6.25e-9};
    assert_int_equal(map->grid.nx, 3);
    assert_int_equal(map->grid.ny, 2);
    assert_true(fabs(map->grid.lx - 3e-6) <= 1e-18 && fabs(map->grid.ly - 4e-6) <= 1e-18);
    assert_string_equal(map->xy_unit, "m");
    assert_string_equal(map->z_unit, "m");
    for (size_t point = 0; point < 6; point++)
        assert_true(point == 2 ? isnan(map->z[point])
                               : fabs(map->z[point] - heights[point]) <= 1e-24);
}

static void by_the_standard(void **state) {
    (void)state;
    struct height_map map = bytes_map(bytes_of_text(TEXT), "a.sdf", NULL);
    check_small(&map);
    height_map_clear(&map);
}

/* The proposal's example: comments, NULL, fields in any order, a maker's own field. */
static void by_the_proposal(void **state) {
    (void)state;
    static const char text[] = "aBCR-1.0        ; This must be first\r\n"
                               "                ; the records may have any order\r\n"
                               "NumProfiles = 2\r\n"
                               "NumPoints   = 3 ; a comment\r\n"
                               "Zscale      = 1.0E-9\r\n"
                               "Xscale      = 1.0E-6\r\n"
                               "Yscale      = 2.0E-6\r\n"
                               "Probe       = T52 = old\r\n"
                               "Compression = NULL ; or 0\r\n"
                               "DataType    = 7\r\n"
                               "CheckType   = NULL\r\n"
                               "*               ; end of the header\r\n"
                               "                ; start of 6 data points\r\n"
                               "1.5\r\n-2\r\nBAD ; spurious\r\n4\r\n5\r\n6.25\r\n*\r\n";
    struct height_map map = bytes_map(bytes_of_text(text), "b.sdf", NULL);
    check_small(&map);
    height_map_clear(&map);
}

static void put(char **at, uint64_t value, size_t bytes) {
    for (size_t byte = 0; byte < bytes; byte++)
        *(*at)++ = (char)(value >> 8 * byte);
}

static void put_double(char **at, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(at, bits, 8);
}

static void put_number(char **at, unsigned type, double value) {
    static const size_t bytes[] = {1, 2, 4, 4, 1, 2, 4, 8};
    if (type == 7) {
        put_double(at, value);
    } else if (type == 3) {
        float number = (float)value;
        uint32_t bits;
        memcpy(&bits, &number, sizeof bits);
        put(at, bits, 4);
    } else {
        put(at, (uint64_t)(int64_t)value, bytes[type]);
    }
}

/* A binary file of the six numbers with this mark and type; more: bytes put in behind the header.
 */
static struct bytes binary_of(const char *mark, unsigned type, const double *numbers,
                              const char *more, size_t more_size) {
    char data[256], *at = data;
    size_t wide = mark[5] == '2' ? 4 : 2;
    memcpy(at, mark, 8);
    memset(at + 8, 0x30, 34); /* the maker and the dates */
    at += 42;
    put(&at, 3, wide);
    put(&at, 2, wide);
    put_double(&at, 1e-6);
    put_double(&at, 2e-6);
    put_double(&at, 1e-9);
    put_double(&at, -1);
    put(&at, 0, 1);
    put(&at, type, 1);
    put(&at, 0, 1);
    assert_int_equal(at - data, wide == 4 ? 85 : 81);
    memcpy(at, more, more_size);
    at += more_size;
    for (size_t point = 0; point < 6; point++)
        put_number(&at, type, numbers[point]);
    return bytes_of(data, (size_t)(at - data));
}

/* Each type with the number that stands for a hole in it. */
static void each_type(void **state) {
    (void)state;
    const double holes[8] = {255,  65535,  4294967295.0,  (double)-3.4028234663852886e38f,
                             -128, -32768, -2147483648.0, -1.7976931348623157e308};
    const char *const marks[] = {"bISO-1.0", "bISO-2.0", "bBCR-1.0"};
    for (size_t m = 0; m < 3; m++)
        for (unsigned type = 0; type < 8; type++) {
            const double sign = type < 3 ? 1 : -1;
            const double numbers[6] = {1, 100 * sign, holes[type], 3, 4, 5};
            struct height_map map =
                bytes_map(binary_of(marks[m], type, numbers, "", 0), "c.sdf", NULL);
            assert_int_equal(map.grid.nx, 3);
            assert_true(fabs(map.grid.lx - 3e-6) <= 1e-18 && fabs(map.grid.ly - 4e-6) <= 1e-18);
            for (size_t point = 0; point < 6; point++)
                if (point == 2 ? !isnan(map.z[point])
                               : !(fabs(map.z[point] - numbers[point] * 1e-9) <= 1e-22))
                    fail_msg("%s, type %u, point %zu: %g", marks[m], type, point, map.z[point]);
            height_map_clear(&map);
        }
}

/* NaN is a hole too; the highest signed number is one in the proposal alone; Olympus's two words
 * behind the header are passed over, and a trailer of as many bytes is not taken for them. */
static void oddities(void **state) {
    (void)state;
    const double with_nan[6] = {1, 2, NAN, 3, 4, 5}, highest[6] = {1, 2, 32767, 3, 4, 5};
    struct height_map map = bytes_map(binary_of("bISO-1.0", 7, with_nan, "", 0), "d.sdf", NULL);
    assert_true(isnan(map.z[2]) && height_map_holes(&map) == 1);
    height_map_clear(&map);
    map = bytes_map(binary_of("bBCR-1.0", 5, highest, "", 0), "d.sdf", NULL);
    assert_true(isnan(map.z[2]) && height_map_holes(&map) == 1);
    height_map_clear(&map);
    map = bytes_map(binary_of("bISO-1.0", 5, highest, "", 0), "d.sdf", "1");
    assert_true(fabs(map.z[2] - 32767e-9) <= 1e-18);
    height_map_clear(&map);
    map = bytes_map(binary_of("bISO-1.0", 5, highest, "\5\0\0\0\1\0\0\0", 8), "d.sdf", NULL);
    assert_true(fabs(map.z[0] - 1e-9) <= 1e-22 && fabs(map.z[5] - 5e-9) <= 1e-22);
    height_map_clear(&map);
    struct bytes whole = binary_of("bISO-1.0", 5, highest, "", 0);
    struct bytes trailed = bytes_of(whole.data, whole.size + 1);
    trailed.data = realloc(trailed.data, whole.size + 9);
    assert_non_null(trailed.data);
    memcpy(trailed.data + whole.size, "trailer\n", 9);
    trailed.size = whole.size + 8;
    map = bytes_map(trailed, "d.sdf", NULL);
    assert_true(fabs(map.z[0] - 1e-9) <= 1e-22 && fabs(map.z[5] - 5e-9) <= 1e-22);
    height_map_clear(&map);
    free(whole.data);
}

static void profile(void **state) {
    (void)state;
    static const char text[] = "aISO-1.0\nNumPoints = 4\nNumProfiles = 1\nXscale = 1e-6\n"
                               "Zscale = 1e-6\nDataType = 5\n*\n1 -32768 3 4\n*\n";
    struct height_map map = bytes_map(bytes_of_text(text), "e.sdf", NULL);
    assert_int_equal(map.grid.ny, 1);
    assert_true(isnan(map.z[1]) && fabs(map.z[3] - 4e-6) <= 1e-20);
    height_map_clear(&map);
}

/* Up to the last height, a cut is noticed; behind it the file is whole but for what is not read. */
static void cut_off(void **state) {
    (void)state;
    const double numbers[6] = {1, 2, 3, 4, 5, 6};
    const size_t last = (size_t)(strstr(TEXT, "6.25") - TEXT) + 4;
    for (size_t size = 8; size <= last; size++)
        bytes_refused(bytes_of(TEXT, size), "f.sdf", NULL, "");
    struct bytes whole = binary_of("bISO-1.0", 7, numbers, "", 0);
    for (size_t size = 8; size < whole.size; size++)
        bytes_refused(bytes_of(whole.data, size), "f.sdf", NULL, "");
    free(whole.data);
}

static void damaged_text(void **state) {
    (void)state;
    const struct damage damages[] = {
        {"NumPoints = 3", 13, 12, "4", 1, "6 heights are there, NumPoints 4 and NumProfiles 2"},
        {"NumPoints = 3", 13, 12, "2", 1, "line 16: more heights than the 4"},
        {"NumPoints = 3", 13, 12, "0", 1, "NumPoints is 0; allowed: 1 to"},
        {"NumPoints = 3", 13, 11, "-3", 2, "NumPoints is -3"},
        {"NumPoints = 3", 13, 11, ".3", 2, "NumPoints is 0.3"},
        {"NumPoints = 3", 13, 12, "x", 1, "line 5: NumPoints is 'x'; allowed: a number"},
        {"NumPoints = 3", 13, 11, "9e9", 3, "NumPoints is 9e+09"},
        {"NumPoints = 3", 13, 11, "1e8", 3, "do not fit into"},
        {"NumPoints = 3", 13, 0, "NumPaints", 9, "the header has no NumPoints"},
        {"NumPoints = 3", 13, 3, "Profiles=3", 10, "line 6: NumProfiles is there twice"},
        {"Xscale = 1.0E-6", 15, 9, "-1.0e0", 6, "Xscale is -1"},
        {"Xscale = 1.0E-6", 15, 9, "nan   ", 6, "Xscale is 'nan'"},
        {"Yscale = 2.0E-6", 15, 9, "0.0E-6", 6, "Yscale is 0; allowed: metres above 0"},
        {"Zscale = 1.0E-9", 15, 9, "1e9999", 6, "Zscale is '1e9999'"},
        {"Zscale = 1.0E-9", 15, 9, "1e308 ", 6, "is too large"},
        {"Compression = 0", 15, 14, "1", 1, "Compression is 1; allowed: 0"},
        {"CheckType = 0", 13, 12, "1", 1, "CheckType is 1; allowed: 0"},
        {"DataType = 7", 12, 11, "8", 1, "DataType is 8; allowed: 0 to 7"},
        {"-2 BAD", 6, 0, "x2", 2, "line 15: the height 'x2' is no number"},
        {"-2 BAD", 6, 0, "--", 2, "the height '--' is no number"},
        {"-2 BAD", 6, 3, "BED", 3, "the height 'BED' is no number"},
        {"5e0 6.25", 8, 0, "5,0", 3, "the height '5,0' is no number"},
        {"5e0 6.25", 8, 3, "*", 1, "5 heights are there"},
        {"*\r\n1.5", 6, 0, ";", 1, "is no number"},
        {"aISO-1.0", 8, 5, "3", 1, "begins with 'aISO-3.0'; allowed: aISO-1.0"},
        {"4\r\n5e0", 6, 0, "\0", 1, "no zero byte"},
    };
    for (size_t d = 0; d < sizeof damages / sizeof damages[0]; d++) {
        struct bytes bytes = bytes_of_text(TEXT);
        bytes_damage(&bytes, &damages[d]);
        bytes_refused(bytes, "g.sdf", NULL, damages[d].words);
    }
    bytes_refused(bytes_of_text(TEXT), "g.sdf", "2", "no layer '2'; allowed: 1");
}

static void damaged_binary(void **state) {
    (void)state;
    const double numbers[6] = {1, 2, 3, 4, 5, 6}, nan = NAN, negative = -1, infinite = INFINITY;
    const struct damage damages[] = {
        {"bISO", 4, 42, "\4", 1, "4 points in 2 profiles of double need 64 bytes, 48 are there"},
        {"bISO", 4, 42, "\xff\x7f\xff\x7f", 4, "need 8589410312 bytes"},
        {"bISO", 4, 42, "\0", 1, "a map of 2 rows of 0 points"},
        {"bISO", 4, 44, "\0", 1, "a map of 0 rows of 3 points"},
        {"bISO", 4, 46, &nan, 8, "Xscale is nan"},
        {"bISO", 4, 46, &negative, 8, "Xscale is -1"},
        {"bISO", 4, 54, &infinite, 8, "Yscale is inf"},
        {"bISO", 4, 62, "\0\0\0\0\0\0\0\0", 8, "Zscale is 0"},
        {"bISO", 4, 78, "\1", 1, "Compression is 1"},
        {"bISO", 4, 79, "\x08", 1, "DataType is 8"},
        {"bISO", 4, 79, "\xff", 1, "DataType is 255"},
        {"bISO", 4, 80, "\2", 1, "CheckType is 2"},
        {"bISO", 4, 81 + 8, &infinite, 8, "profile 1, point 2 is infinite"},
        {"bISO", 4, 5, "2", 1, ""},
    };
    for (size_t d = 0; d < sizeof damages / sizeof damages[0]; d++) {
        struct bytes bytes = binary_of("bISO-1.0", 7, numbers, "", 0);
        bytes_damage(&bytes, &damages[d]);
        bytes_refused(bytes, "h.sdf", NULL, damages[d].words);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(by_gwyddion),     cmocka_unit_test(by_the_standard),
        cmocka_unit_test(by_the_proposal), cmocka_unit_test(each_type),
        cmocka_unit_test(oddities),        cmocka_unit_test(profile),
        cmocka_unit_test(cut_off),         cmocka_unit_test(damaged_text),
        cmocka_unit_test(damaged_binary),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
