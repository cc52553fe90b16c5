/* Files of Gwyddion as its own library writes them: channels by title and number, masks as holes,
 * units; and damaged ones, each refused with words that name the fault. */
#include "tests/support/instrument_files.h"

static const char NAME[] = "gwyddion.gwy";

/* The map as it stands in the file, from the top down, within so much. */
static size_t check_downwards(struct height_map *map, double tolerance) {
    height_map_reverse_rows(map);
    return check_fixture_map(map, tolerance);
}

static void heights(void **state) {
    (void)state;
    const char *const layers[] = {NULL, "Topography", "2"};
    for (size_t l = 0; l < 3; l++) {
        struct height_map map = bytes_map(bytes_of_fixture(NAME), NAME, layers[l]);
        /* y rises: the first row of the map is the last of the file's five. */
        assert_true(map.z[0] == fixture_height(0, 4) && map.z[4 * 7 + 1] == fixture_height(1, 0));
        assert_true(isnan(map.z[3 * 7 + 2]) && isnan(map.z[0 * 7 + 6])); /* masked */
        assert_int_equal(check_downwards(&map, 0), 2);
        height_map_clear(&map);
    }
}

/* Of several channels the one that was read is named; one alone is not. */
static void the_channel_is_named(void **state) {
    (void)state;
    expect_layer(bytes_of_fixture(NAME), NULL, "2 'Topography' of 2");
    expect_layer(bytes_of_fixture(NAME), "1", "1 'Phase' of 2");
    expect_layer(bytes_of_fixture("gwyddion.sdf"), NULL, "");
}

/* By its first bytes, whatever its name. */
static void other_name(void **state) {
    (void)state;
    struct height_map map = bytes_map(bytes_of_fixture(NAME), "surface.csv", NULL);
    assert_int_equal(check_downwards(&map, 0), 2);
    height_map_clear(&map);
}

static void other_channel(void **state) {
    (void)state;
    struct height_map map = bytes_map(bytes_of_fixture(NAME), NAME, "Phase");
    assert_string_equal(map.xy_unit, "m");
    assert_string_equal(map.z_unit, "V");
    assert_true(fabs(map.z[4 * 7 + 6] - 36) <= 1e-12); /* the first row of the file */
    height_map_clear(&map);
}

static void absent_channel(void **state) {
    (void)state;
    bytes_refused(bytes_of_fixture(NAME), NAME, "Error",
                  "no layer 'Error'; allowed: a title or number of 1 'Phase' [V], 2 'Topography' "
                  "[m]; not read: 1 graphs, 0 spectra, 1 volumes");
    bytes_refused(bytes_of_fixture(NAME), NAME, "3", "no layer '3'");
    bytes_refused(bytes_of_fixture(NAME), NAME, "0", "no layer '0'");
}

static void cut_off(void **state) {
    (void)state;
    struct bytes whole = bytes_of_fixture(NAME);
    for (size_t size = 4; size < whole.size; size++)
        bytes_refused(bytes_of(whole.data, size), NAME, "2", "");
    free(whole.data);
}

static void damaged(void **state) {
    (void)state;
    const double nan = NAN, infinite = INFINITY, negative = -1, zero = 0;
    const struct damage damages[] = {
        {"xres", 5, 6, "\x08\0\0\0", 4, "xres 8 and yres 5 do not make the 35 numbers"},
        {"xres", 5, 6, "\0\0\0\0", 4, "xres is 0; allowed: 1 and above"},
        {"xres", 5, 6, "\xff\xff\xff\xff", 4, "xres is -1"},
        {"xres", 5, 6, "\xff\xff\xff\x7f", 4, "xres 2147483647 and yres 5"},
        {"yres", 5, 6, "\x01\0\0\x40", 4, "xres 7 and yres 1073741825"},
        {"yres", 5, 6, "\0\0\0\x80", 4, "yres is -2147483648"},
        {"xres", 5, 0, "xrus", 4, "has no 'xres'"},
        {"yres", 5, 5, "d", 1, ""},
        {"xreal", 6, 7, &nan, 8, "nan"},
        {"xreal", 6, 7, &negative, 8, "-1"},
        {"yreal", 6, 7, &zero, 8, "0"},
        {"yreal", 6, 7, &infinite, 8, "inf"},
        {"data\0D", 6, 6, "\xff\xff\xff\xff", 4, "4294967295 values of 8 bytes"},
        {"data\0D", 6, 6, "\x22\0\0\0", 4, ""},
        {"data\0D", 6, 5, "Z", 1, "there is no type 'Z'"},
        {"data\0D", 6, 5, "\0", 1, "there is no type"},
        {"data\0D", 6, 10, &infinite, 8, "is infinite"},
        {"GwyDataField", 13, 13, "\xff\xff\xff\x7f", 4, "the object says 2147483647 bytes"},
        {"GwyDataField", 13, 13, "\x10\0\0\0", 4, ""},
        {"GwyDataField", 13, 3, "Lost", 4, "holds no layer of heights"},
        {"GwyContainer", 13, 3, "Lost", 4, "holds a 'GwyLostainer'"},
        {"GwyContainer", 13, 13, "\x7f\0\0\0", 4, ""},
        {"unitstr\0sm", 10, 8, "I", 1, ""},
        {"/0/data\0o", 9, 1, "1", 1, "channel /1 is there twice"},
        {"GWYP", 4, 3, "O", 1, "of Gwyddion 1"},
    };
    for (size_t d = 0; d < sizeof damages / sizeof damages[0]; d++) {
        struct bytes bytes = bytes_of_fixture(NAME);
        bytes_damage(&bytes, &damages[d]);
        bytes_refused(bytes, NAME, "2", damages[d].words);
    }
}

/* A file made to the letter of the format: what Gwyddion's library does not write. */
static void put_bytes(struct bytes *file, const void *data, size_t size) {
    file->data = realloc(file->data, file->size + size + 1);
    assert_non_null(file->data);
    memcpy(file->data + file->size, data, size);
    file->size += size;
    file->data[file->size] = '\0';
}

static void put_integer(struct bytes *file, uint32_t value) {
    const unsigned char bytes[4] = {(unsigned char)value, (unsigned char)(value >> 8),
                                    (unsigned char)(value >> 16), (unsigned char)(value >> 24)};
    put_bytes(file, bytes, 4);
}

static void put_double(struct bytes *file, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_integer(file, (uint32_t)bits);
    put_integer(file, (uint32_t)(bits >> 32));
}

static void put_name(struct bytes *file, const char *name, char type) {
    put_bytes(file, name, strlen(name) + 1);
    put_bytes(file, &type, 1);
}

/* An object of this type around what was put; takes it. */
static void put_object(struct bytes *file, const char *kind, struct bytes content) {
    put_bytes(file, kind, strlen(kind) + 1);
    put_integer(file, (uint32_t)content.size);
    put_bytes(file, content.data, content.size);
    free(content.data);
}

static void put_unit(struct bytes *field, const char *name, const char *text) {
    struct bytes unit = {0};
    put_name(&unit, "unitstr", 's');
    put_bytes(&unit, text, strlen(text) + 1);
    put_name(field, name, 'o');
    put_object(field, "GwySIUnit", unit);
}

/* Two points a row; units NULL: none given. */
static struct bytes field_of(uint32_t rows, const char *xy_unit, const char *z_unit) {
    struct bytes field = {0};
    put_name(&field, "data", 'D');
    put_integer(&field, 2 * rows);
    for (uint32_t point = 0; point < 2 * rows; point++)
        put_double(&field, point);
    put_name(&field, "xres", 'i');
    put_integer(&field, 2);
    put_name(&field, "yres", 'i');
    put_integer(&field, rows);
    put_name(&field, "xreal", 'd');
    put_double(&field, 2);
    put_name(&field, "yreal", 'd');
    put_double(&field, rows);
    if (xy_unit != NULL)
        put_unit(&field, "si_unit_xy", xy_unit);
    if (z_unit != NULL)
        put_unit(&field, "si_unit_z", z_unit);
    return field;
}

/* Channel 7, and then a mask of so many rows. */
static struct bytes file_of(const char *xy_unit, const char *z_unit, uint32_t mask_rows) {
    struct bytes file = {0}, container = {0};
    put_name(&container, "/7/data", 'o');
    put_object(&container, "GwyDataField", field_of(2, xy_unit, z_unit));
    put_name(&container, "/7/mask", 'o');
    put_object(&container, "GwyDataField", field_of(mask_rows, NULL, NULL));
    put_bytes(&file, "GWYP", 4);
    put_object(&file, "GwyContainer", container);
    return file;
}

static void by_hand(void **state) {
    (void)state;
    struct height_map map = bytes_map(file_of(NULL, "A", 2), NAME, "1");
    assert_string_equal(map.xy_unit, "");
    assert_string_equal(map.z_unit, "A"); /* the ampere of a current's channel */
    assert_true(map.z[2] == 0 && height_map_holes(&map) == 3);
    height_map_clear(&map);
    bytes_refused(file_of("m", "m", 3), NAME, NULL,
                  "channel 1 of 1 (/7): its mask: 2 x 3 points; allowed: as the channel, 2 x 2");
    bytes_refused(file_of("um", "m", 2), NAME, NULL, "the unit 'um' has a prefix");
    bytes_refused(file_of("m", "nm", 2), NAME, NULL, "the unit 'nm' has a prefix; allowed: units");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heights),       cmocka_unit_test(other_name),
        cmocka_unit_test(other_channel), cmocka_unit_test(absent_channel),
        cmocka_unit_test(cut_off),       cmocka_unit_test(damaged),
        cmocka_unit_test(by_hand),       cmocka_unit_test(the_channel_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
