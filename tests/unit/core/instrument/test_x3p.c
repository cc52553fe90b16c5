/* Protects: X3P files as the standard has them are read as the heights that they hold, in metres,
 * whatever their types, axes, holes and layers; files of other programs too; and what is damaged,
 * wrong or an attack is refused with words that name its position. */
#include "tests/support/check.h"

#include "core/instrument/instrument.h"
#include "tests/support/instrument_files.h"
#include "tests/support/x3p_file.h"
#include "tests/support/zip_file.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double SIX[6] = {1e-6, 2e-6, 3e-6, -1e-6, 0, 5e-7};

static int read_layer(struct height_map *map, const struct x3p_sheet *sheet, const char *layer,
                      struct error *err) {
    size_t size = 0;
    char *file = x3p_file_create(sheet, &size);
    const char *format = NULL;
    int status = instrument_read(map, "patch.x3p", file, size, 0,
                                 &(struct instrument_request){.layer = layer}, &format, err);
    if (status == 0)
        assert_string_equal(format, "x3p");
    free(file);
    return status;
}

static struct height_map map_of(const struct x3p_sheet *sheet) {
    struct height_map map = {0};
    struct error err = {0};
    if (read_layer(&map, sheet, NULL, &err) != 0)
        fail_msg("%s", err.text);
    return map;
}

static bool near(double a, double b, double scale) {
    return fabs(a - b) <= 1e-12 * scale;
}

/* Compares with heights (NAN: a hole) and steps, and clears the map. */
static void expect(struct height_map *map, size_t nx, size_t ny, double dx, double dy,
                   const double *z) {
    assert_int_equal(map->grid.nx, nx);
    assert_int_equal(map->grid.ny, ny);
    assert_true(near(grid_dx(&map->grid), dx, dx));
    assert_true(near(grid_dy(&map->grid), dy, dy));
    assert_string_equal(map->xy_unit, "m");
    assert_string_equal(map->z_unit, "m");
    for (size_t point = 0; point < nx * ny; point++)
        if (isnan(z[point]) ? !isnan(map->z[point]) : !near(map->z[point], z[point], 1e-6))
            fail_msg("point %zu is %g, not %g", point, map->z[point], z[point]);
    height_map_clear(map);
}

static void a_surface(void **state) {
    (void)state;
    struct x3p_sheet sheet = {.points = SIX, .size = sizeof SIX};
    struct height_map map = map_of(&sheet);
    expect(&map, 3, 2, 2e-6, 3e-6, SIX);
    sheet.stored = true;
    map = map_of(&sheet);
    expect(&map, 3, 2, 2e-6, 3e-6, SIX);
    sheet.folder = "scan/";
    map = map_of(&sheet);
    expect(&map, 3, 2, 2e-6, 3e-6, SIX);
    sheet.head = "\xef\xbb\xbf"; /* a mark of byte order */
    sheet.root = "ISO5436";      /* as some programs name it */
    sheet.folder = ".\\";
    map = map_of(&sheet);
    expect(&map, 3, 2, 2e-6, 3e-6, SIX);
}

/* A number of a binary file of this type, lowest byte first. */
static size_t put(char *to, char type, double number) {
    float single = (float)number;
    uint64_t bits = type == 'I' || type == 'L' ? (uint64_t)(int64_t)number : 0;
    uint32_t low;
    size_t bytes = type == 'I' ? 2 : type == 'D' ? 8 : 4;
    memcpy(&low, &single, sizeof low);
    if (type == 'D')
        memcpy(&bits, &number, sizeof bits);
    else if (type == 'F')
        bits = low;
    for (size_t byte = 0; byte < bytes; byte++)
        to[byte] = (char)(bits >> 8 * byte & 0xff);
    return bytes;
}

static void types(void **state) {
    (void)state;
    const char *const axes[] = {
        X3P_ABSOLUTE("I", "1e-9", "1e-6"), X3P_ABSOLUTE("L", "1e-9", "1e-6"),
        X3P_ABSOLUTE("F", "1e-9", "1e-6"), X3P_ABSOLUTE("D", "1e-9", "1e-6")};
    const double numbers[] = {-32768, 32767, 0, 1, -1, 256}, other[] = {-2147483648., 2147483647};
    for (size_t type = 0; type < 4; type++) {
        char data[48];
        double z[6];
        size_t size = 0;
        for (size_t point = 0; point < 6; point++) {
            double number = type == 1 && point < 2 ? other[point] : numbers[point];
            size += put(data + size, "ILFD"[type], number);
            z[point] = 1e-6 + 1e-9 * number;
        }
        struct x3p_sheet sheet = {.points = data, .size = size, .z = axes[type]};
        struct height_map map = map_of(&sheet);
        expect(&map, 3, 2, 2e-6, 3e-6, z);
    }
}

/* Holes: NaN, the infinity of some instruments, and bits of valid points, the lowest first. */
static void holes(void **state) {
    (void)state;
    double data[9] = {1e-6, (double)NAN, (double)INFINITY, 2e-6, -(double)INFINITY, 3e-6, 4e-6,
                      5e-6, 6e-6};
    const double z[9] = {1e-6, (double)NAN, (double)NAN, (double)NAN, (double)NAN,
                         3e-6, 4e-6,        5e-6,        (double)NAN};
    const unsigned char valid[2] = {0xf7, 0xfe};
    struct x3p_sheet sheet = {.points = data,
                              .size = sizeof data,
                              .dimension = X3P_MATRIX("3", "3", "1"),
                              .valid = valid,
                              .valid_size = 2};
    struct height_map map = map_of(&sheet);
    expect(&map, 3, 3, 2e-6, 3e-6, z);
}

static void listed(void **state) {
    (void)state;
    const double z[6] = {1e-6, 2e-6, (double)NAN, -1e-6, 0, 5e-7};
    struct x3p_sheet sheet = {.data = "<DataList><Datum>1e-6</Datum><Datum> 2E-006 </Datum><Datum/>"
                                      "<Datum>0;0;-1e-6</Datum><Datum>.0</Datum>"
                                      "<Datum>5e-7</Datum></DataList>"};
    struct height_map map = map_of(&sheet);
    expect(&map, 3, 2, 2e-6, 3e-6, z);
    /* Integers of a list have their increment, too. */
    sheet.z = X3P_ABSOLUTE("I", "1e-9", "0");
    sheet.data = "<DataList><Datum>1000</Datum><Datum>2000</Datum><Datum></Datum>"
                 "<Datum>-1000</Datum><Datum>0</Datum><Datum>500</Datum></DataList>";
    map = map_of(&sheet);
    expect(&map, 3, 2, 2e-6, 3e-6, z);
}

/* N x 1 x M: M profiles of N points; y needs no increment, and x may be given point by point. */
static void profiles(void **state) {
    (void)state;
    struct height_map map = {0};
    struct error err = {0};
    struct x3p_sheet sheet = {.feature = "PRF",
                              .y = "<AxisType>I</AxisType>",
                              .dimension = X3P_MATRIX("3", "1", "2"),
                              .points = SIX,
                              .size = sizeof SIX};
    map = map_of(&sheet);
    expect(&map, 3, 1, 2e-6, 2e-6, SIX);
    assert_int_equal(read_layer(&map, &sheet, "2", &err), 0);
    expect(&map, 3, 1, 2e-6, 2e-6, SIX + 3);
    size_t size = 0;
    char *file = x3p_file_create(&sheet, &size);
    expect_layer(bytes_of(file, size), NULL, "1 of 2");
    expect_layer(bytes_of(file, size), "2", "2 of 2");
    free(file);
    assert_int_equal(read_layer(&map, &sheet, "3", &err), ERROR_INPUT);
    assert_string_equal(err.text,
                        "there is no layer '3'; allowed: 1 to 2, layers of X3P have no names");
    assert_int_equal(read_layer(&map, &sheet, "height", &err), ERROR_INPUT);
    sheet = (struct x3p_sheet){.feature = "PRF",
                               .x = X3P_ABSOLUTE("L", "1e-9", "5e-6"),
                               .y = "<AxisType>I</AxisType>",
                               .dimension = X3P_MATRIX("3", "1", "1"),
                               .data = "<DataList><Datum>0;1e-6</Datum><Datum>2000;2e-6</Datum>"
                                       "<Datum>4000;3e-6</Datum></DataList>"};
    map = map_of(&sheet);
    expect(&map, 3, 1, 2e-6, 2e-6, SIX);
}

/* Points of a cloud stand in any order; a node without one is a hole. */
static void clouds(void **state) {
    (void)state;
    const double z[6] = {1e-6, 2e-6, 3e-6, (double)NAN, 4e-6, 5e-6};
    struct x3p_sheet sheet = {.feature = "PCL",
                              .x = X3P_ABSOLUTE("D", "1", "0"),
                              .y = X3P_ABSOLUTE("D", "1", "0"),
                              .dimension = "<ListDimension>5</ListDimension>",
                              .data = "<DataList><Datum>5e-6;3e-6;5e-6</Datum>"
                                      "<Datum>3e-6;0;2e-6</Datum><Datum>1e-6;0;1e-6</Datum>"
                                      "<Datum>5e-6;0;3e-6</Datum><Datum>3e-6;3e-6;4e-6</Datum>"
                                      "</DataList>"};
    struct height_map map = map_of(&sheet);
    expect(&map, 3, 2, 2e-6, 3e-6, z);
    struct error err = {0};
    sheet.data = "<DataList><Datum>5e-6;3e-6;5e-6</Datum><Datum>3e-6;0;2e-6</Datum>"
                 "<Datum>1.5e-6;0;1e-6</Datum><Datum>5e-6;0;3e-6</Datum>"
                 "<Datum>3e-6;3e-6;4e-6</Datum></DataList>";
    assert_int_equal(read_layer(&map, &sheet, NULL, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "lies on no regular grid"));
}

/* Positions that a matrix gives must be regular; those of holes do not count. */
static void told_positions(void **state) {
    (void)state;
    double data[18];
    const double z[6] = {1e-6, (double)NAN, 3e-6, -1e-6, 0, 5e-7};
    struct x3p_sheet sheet = {.points = data,
                              .size = sizeof data,
                              .x = X3P_ABSOLUTE("D", "1", "0"),
                              .y = X3P_ABSOLUTE("D", "1", "0")};
    for (size_t point = 0; point < 6; point++) {
        data[3 * point] = 1 + 2e-6 * (double)(point % 3);
        data[3 * point + 1] = point < 3 ? 0 : 3e-6;
        data[3 * point + 2] = z[point];
    }
    data[3] = 77;
    struct height_map map = {0};
    struct error err = {0};
    assert_int_equal(read_layer(&map, &sheet, NULL, &err), 0);
    assert_true(fabs(grid_dx(&map.grid) - 2e-6) <= 1e-15);
    assert_true(map.z[5] == z[5] && isnan(map.z[1]));
    height_map_clear(&map);
    data[3 * 4] += 0.5e-6;
    assert_int_equal(read_layer(&map, &sheet, NULL, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "row 2, column 2: the point lies at x"));
}

/* --- damage --- */

struct damaged {
    struct x3p_sheet sheet;
    const char *told; /* part of the error */
};
#define WHOLE .points = SIX, .size = sizeof SIX
#define CLOUD                                                                                      \
    .feature = "PCL", .x = X3P_ABSOLUTE("D", "1", "0"), .y = X3P_ABSOLUTE("D", "1", "0"),          \
    .dimension = "<ListDimension>2</ListDimension>"

static const struct damaged DAMAGED[] = {
    {{WHOLE, .feature = "VOL"}, "Record1/FeatureType is 'VOL'"},
    {{WHOLE, .feature = "PRF"}, "a profile (PRF) has SizeY 2"},
    {{WHOLE, .feature = "PCL"}, "a cloud of points (PCL) is a matrix"},
    {{WHOLE, .feature = "SUR</FeatureType><FeatureType>SUR"}, "stands there twice"},
    {{WHOLE, .root = "svg"}, "the root is svg"},
    {{WHOLE, .x = ""}, "Record1/Axes/CX/AxisType is ''"},
    {{WHOLE, .x = X3P_INCREMENTAL("0")}, "Record1/Axes/CX/Increment is '0'"},
    {{WHOLE, .x = X3P_INCREMENTAL("-1e-6")}, "Record1/Axes/CX/Increment is '-1e-6'"},
    {{WHOLE, .y = X3P_INCREMENTAL("1e999")}, "Record1/Axes/CY/Increment is 1e999"},
    {{WHOLE, .y = X3P_INCREMENTAL("two")}, "Record1/Axes/CY/Increment is two"},
    {{WHOLE, .x = X3P_INCREMENTAL("1e308")}, "finite"},
    {{WHOLE, .z = X3P_INCREMENTAL("1e-6")}, "Record1/Axes/CZ/AxisType is I"},
    {{WHOLE, .z = X3P_ABSOLUTE("Q", "1", "0")}, "Record1/Axes/CZ/DataType is 'Q'"},
    {{WHOLE, .z = "<AxisType>A</AxisType><DataType>I</DataType>"}, "CZ/Increment is ''"},
    {{.dimension = X3P_MATRIX("2", "1", "1"),
      .z = X3P_ABSOLUTE("D", "1e10", "0"),
      .data = "<DataList><Datum>1e308</Datum><Datum>1</Datum></DataList>"},
     "point 1: the height is not finite"},
    {{WHOLE, .rotation = "<Rotation><r33>-1</r33></Rotation>"}, "upside down"},
    {{WHOLE, .dimension = ""}, "SizeX is ''"},
    {{WHOLE, .dimension = X3P_MATRIX("0", "2", "1")}, "SizeX is '0'"},
    {{WHOLE, .dimension = X3P_MATRIX("-3", "2", "1")}, "SizeX is '-3'"},
    {{WHOLE, .dimension = X3P_MATRIX("3", "3", "1")}, "has 48 bytes; allowed: 72"},
    {{WHOLE, .dimension = X3P_MATRIX("2", "2", "1")}, "has 48 bytes; allowed: 32"},
    {{WHOLE, .dimension = X3P_MATRIX("99999", "99999", "1")}, "room for at most 24"},
    {{WHOLE, .dimension = X3P_MATRIX("2147483648", "2147483648", "2147483648")}, "room"},
    {{WHOLE, .dimension = X3P_MATRIX("99999999999999999999999", "1", "1")}, "SizeX"},
    {{WHOLE, .dimension = X3P_MATRIX("1", "6", "1")}, "at least 2 points"},
    {{WHOLE, .dimension = X3P_MATRIX("3", "2", "1") "<ListDimension>6</ListDimension>"}, "both"},
    {{WHOLE, .data = ""}, "neither a DataList and a DataLink"},
    {{WHOLE, .data = "<DataLink><PointDataLink>../data.bin</PointDataLink></DataLink>"},
     "no file ../data.bin"},
    {{WHOLE, .data =
                 "<DataLink><PointDataLink>bindata/data.bin</PointDataLink><MD5ChecksumPointData>"
                 "00112233445566778899AABBCCDDEEFF</MD5ChecksumPointData></DataLink>"},
     "bindata/data.bin is damaged: its MD5"},
    {{WHOLE, .sum = "00112233445566778899aabbccddeeff *main.xml\n"},
     "main.xml is damaged: its MD5"},
    {{WHOLE, .sum = "0011"}, "main.xml is damaged: its MD5"},
    {{WHOLE, .valid = (const unsigned char *)"\xff\xff", .valid_size = 2},
     "has 2 bytes; allowed: 1"},
    {{.data = "<DataList><Datum>1</Datum></DataList>"}, "there are 1 points where Record3 says 6"},
    {{.data = "<DataList><Datum>1;2</Datum></DataList>"}, "point 1 is '1;2'"},
    {{.data = "<DataList><Datum>1;</Datum></DataList>"}, "point 1 is '1;'"},
    {{.data = "<DataList><Datum>0x10</Datum></DataList>"}, "point 1 is '0x10'"},
    {{.data = "<DataList><Datum>1 2</Datum></DataList>"}, "point 1 is '1 2'"},
    {{.data = "<DataList><Datum/><Datum/><Datum/><Datum/><Datum/><Datum/><Datum/></DataList>"},
     "more points than the 6"},
    {{.dimension = X3P_MATRIX("9999", "9999", "1"),
      .data = "<DataList><Datum>1</Datum></DataList>"},
     "the file has room for at most"},
    {{.dimension = X3P_MATRIX("2", "1", "1"),
      .data = "<DataList><Datum>1e999</Datum><Datum>1</Datum></DataList>"},
     "point 1: the height is not finite"},
    {{.feature = "PCL",
      .dimension = "<ListDimension>2</ListDimension>",
      .data = "<DataList><Datum>1</Datum></DataList>"},
     "a list of points has an incremental axis"},
    {{CLOUD, .data = "<DataList><Datum>0;0;1</Datum><Datum>0;0;1</Datum></DataList>"},
     "at least 2 points"},
    {{CLOUD, .data = "<DataList><Datum>0;0;1</Datum><Datum>1e999;0;1</Datum></DataList>"},
     "point 2 has no finite x"},
    {{CLOUD, .data = "<DataList><Datum>0;0;1</Datum><Datum/></DataList>"}, "1 points make no map"},
    {{WHOLE, .tail = "<VendorSpecificID>"}, "mismatched tag"},
    {{WHOLE, .head = "<?xml version=\"1.0\" encoding=\"EBCDIC\"?>"}, "unknown encoding"},
    {{WHOLE, .head = "<!DOCTYPE x [<!ENTITY a \"b\">]>"}, "line 1: a document type (DOCTYPE)"},
    {{WHOLE, .head = "<!DOCTYPE x SYSTEM \"file:///etc/passwd\">"}, "a document type (DOCTYPE)"},
    {{WHOLE, .feature = "&a;"}, "undefined entity"},
    {{WHOLE, .tail = "\xff"}, "not well-formed"},
};

static void damaged_files(void **state) {
    (void)state;
    const size_t count = sizeof DAMAGED / sizeof *DAMAGED;
    for (size_t file = 0; file < count; file++) {
        struct height_map map = {0};
        struct error err = {0};
        int status = read_layer(&map, &DAMAGED[file].sheet, NULL, &err);
        if (status != ERROR_INPUT || strstr(err.text, DAMAGED[file].told) == NULL)
            fail_msg("file %zu: %d, \"%s\" in place of \"%s\"", file, status, err.text,
                     DAMAGED[file].told);
        assert_null(map.z);
    }
    assert_true(count >= 20);
}

/* Long and deep things of main.xml, which would fill memory or time. */
static void swollen_xml(void **state) {
    (void)state;
    static char text[X3P_SHEET_MOST / 2];
    struct height_map map = {0};
    struct error err = {0};
    struct x3p_sheet sheet = {WHOLE, .tail = text};
    for (size_t depth = 0; depth < 40; depth++)
        memcpy(text + 3 * depth, "<a>", sizeof "<a>");
    assert_int_equal(read_layer(&map, &sheet, NULL, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "nested deeper than 32"));
    memset(text, 'a', sizeof text - 1);
    *text = '<';
    assert_int_equal(read_layer(&map, &sheet, NULL, &err), ERROR_INPUT);
    sheet.tail = NULL;
    sheet.feature = text;
    *text = 'a';
    assert_int_equal(read_layer(&map, &sheet, NULL, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "the text of Record1/FeatureType is longer than 255 bytes"));
    size_t length = 3 << 20, size = 0; /* a comment that does not end */
    char *comment = calloc(1, length);
    assert_non_null(comment);
    memset(comment, ' ', length);
    memcpy(comment, "<!--", sizeof "<!--");
    comment[4] = ' ';
    char *file = zip_file_create(&(struct zip_part){"main.xml", comment, length, false}, 1, &size);
    assert_int_equal(
        instrument_read(&map, "a", file, size, 0, &(struct instrument_request){0}, NULL, &err),
        ERROR_INPUT);
    assert_non_null(strstr(err.text, "a tag or comment of more than"));
    free(file);
    /* The parser keeps all names: many different ones, in little room. */
    memcpy(comment, "<ISO5436>", sizeof "<ISO5436>");
    for (size_t at = strlen(comment), name = 0; at + 20 < length; name++)
        at += (size_t)snprintf(comment + at, 20, "<a%zx/>", name);
    file =
        zip_file_create(&(struct zip_part){"main.xml", comment, strlen(comment), false}, 1, &size);
    assert_int_equal(
        instrument_read(&map, "a", file, size, 0, &(struct instrument_request){0}, NULL, &err),
        ERROR_INPUT);
    assert_non_null(strstr(err.text, "names of elements and attributes take more than"));
    free(file);
    free(comment);
}

static void check_damaged(struct height_map *map) {
    expect(map, 3, 2, 2e-6, 3e-6, SIX);
}

static void cut_and_changed(void **state) {
    (void)state;
    const struct x3p_sheet sheet = {WHOLE};
    size_t size = 0;
    char *file = x3p_file_create(&sheet, &size);
    expect_damage_told("a.x3p", file, size, check_damaged);
    free(file);
}

/* Wrong sizes in an archive are found while it is unpacked, and bombs before. */
static void lying_sizes(void **state) {
    (void)state;
    const struct {
        enum zip_number which;
        uint32_t value;
        const char *told;
    } lies[] = {{ZIP_UNPACKED, 0x7fffffff, "unpacks to 2147483647 bytes"},
                {ZIP_UNPACKED, 47, ""},
                {ZIP_UNPACKED, 49, ""},
                {ZIP_UNPACKED, 0, ""},
                {ZIP_PACKED, 3, ""},
                {ZIP_CRC, 5, ""}};
    for (size_t lie = 0; lie < sizeof lies / sizeof *lies; lie++) {
        const struct x3p_sheet sheet = {WHOLE};
        struct height_map map = {0};
        struct error err = {0};
        size_t size = 0;
        char *file = x3p_file_create(&sheet, &size);
        char *number = zip_file_number(file, size, "bindata/data.bin", lies[lie].which);
        for (size_t byte = 0; byte < 4; byte++)
            number[byte] = (char)(lies[lie].value >> 8 * byte & 0xff);
        int status = instrument_read(&map, "a.x3p", file, size, 0, &(struct instrument_request){0},
                                     NULL, &err);
        if (status != ERROR_INPUT || strstr(err.text, lies[lie].told) == NULL)
            fail_msg("lie %zu: %d, %s", lie, status, err.text);
        free(file);
    }
}

/* tests/fixtures/instrument: z = 1e-6 (i - 2 j) + 1e-8 i j, a hole at i 2, j 3 of floating types.
 */
static void files_of_x3p_js(void **state) {
    (void)state;
    const char *source = getenv("RUGO_SOURCE");
    for (size_t type = 0; type < 4; type++) {
        char path[1000], file[4000];
        snprintf(path, sizeof path, "%s/tests/fixtures/instrument/x3p_js_%c.x3p",
                 source != NULL ? source : ".", "ILFD"[type]);
        FILE *stream = fopen(path, "rb");
        assert_non_null(stream);
        size_t size = fread(file, 1, sizeof file - 1, stream);
        fclose(stream);
        file[size] = 0;
        struct height_map map = {0};
        struct error err = {0};
        if (instrument_read(&map, path, file, size, 0, &(struct instrument_request){0}, NULL,
                            &err) != 0)
            fail_msg("%s: %s", path, err.text);
        assert_true(map.grid.nx == 7 && map.grid.ny == 5);
        assert_true(near(grid_dx(&map.grid), 2e-6, 1e-6) && near(grid_dy(&map.grid), 3e-6, 1e-6));
        assert_int_equal(height_map_holes(&map), type < 2 ? 0 : 1);
        for (size_t point = 0; point < 35; point++) {
            const size_t column = point % 7, row = point / 7;
            double i = (double)column, j = (double)row;
            double z = 1e-6 * (i - 2 * j) + 1e-8 * i * j;
            if (type >= 2 && point == 3 * 7 + 2)
                assert_true(isnan(map.z[point]));
            else
                assert_true(fabs(map.z[point] - z) <= (type == 2 ? 1e-12 : 1e-17));
        }
        height_map_clear(&map);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_surface),      cmocka_unit_test(types),
        cmocka_unit_test(holes),          cmocka_unit_test(listed),
        cmocka_unit_test(profiles),       cmocka_unit_test(clouds),
        cmocka_unit_test(told_positions), cmocka_unit_test(damaged_files),
        cmocka_unit_test(swollen_xml),    cmocka_unit_test(cut_and_changed),
        cmocka_unit_test(lying_sizes),    cmocka_unit_test(files_of_x3p_js),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
