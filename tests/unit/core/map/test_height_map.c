/* Height maps in files: what is written reads back bit for bit, NumPy's own headers are taken, and
 * everything else is refused with words that name its position. */
#include "core/map/height_map_file.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static struct height_map parse(enum height_map_format format, const char *text, size_t size,
                               double dx) {
    struct height_map map = {0};
    struct error err = {0};
    if (height_map_parse(&map, format, text, size, dx, &err) != 0)
        fail_msg("%s", err.text);
    return map;
}

static void round_trip(void **state) {
    (void)state;
    const struct grid grids[] = {{3, 4, 1.5, 2.0}, {5, 1, 0.5, 0.5}, {2, 2, 1e-9, 1e-9}};
    const double z[12] = {0.1, -1.0 / 3, 1e-300, 5e-324, -0.0, 1e300, 7, 8, 9, 10, 11, M_PI};
    for (size_t g = 0; g < 3; g++) {
        for (int format = 0; format < HEIGHT_MAP_FORMATS; format++) {
            char *text = NULL;
            size_t size = 0, n = grids[g].nx * grids[g].ny;
            struct error err = {0};
            FILE *file = open_memstream(&text, &size);
            assert_non_null(file);
            assert_int_equal(
                height_map_write(file, (enum height_map_format)format, &grids[g], z, &err), 0);
            fclose(file);
            struct height_map map =
                parse((enum height_map_format)format, text, size, grid_dx(&grids[g]));
            assert_int_equal(map.grid.nx, grids[g].nx);
            assert_int_equal(map.grid.ny, grids[g].ny);
            assert_true(fabs(map.grid.lx - grids[g].lx) <= 1e-15 * grids[g].lx * 10);
            assert_memory_equal(map.z, z, n * sizeof *z);
            height_map_clear(&map);
            free(text);
        }
    }
}

/* A write that fails is an error: this device is always full. */
static void failing_write(void **state) {
    (void)state;
    const struct grid grid = {64, 64, 1, 1};
    static const double z[64 * 64];
    FILE *file = fopen("/dev/full", "wb");
    if (file == NULL)
        skip();
    struct error err = {0};
    assert_int_equal(height_map_write(file, HEIGHT_MAP_CSV, &grid, z, &err), ERROR_SYSTEM);
    fclose(file);
}

/* Builds an npy file from its header's dictionary and raw data; static buffer. */
static size_t npy(char *out, int major, const char *header, const void *data, size_t size) {
    size_t length = strlen(header), field = major == 1 ? 2 : 4;
    memcpy(out, "\x93NUMPY", 6);
    out[6] = (char)major;
    out[7] = 0;
    for (size_t a = 0; a < field; a++)
        out[8 + a] = (char)(length >> (8 * a) & 0xff);
    memcpy(out + 8 + field, header, length);
    memcpy(out + 8 + field + length, data, size);
    return 8 + field + length + size;
}

static void numpy_headers(void **state) {
    (void)state;
    char file[1000];
    const float single[] = {1.5f, -2, 3, 4, 5, 6};
    const double z[] = {1.5, -2, 3, 4, 5, 6};
    size_t size = npy(file, 2, "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }   \n",
                      single, sizeof single);
    struct height_map map = parse(HEIGHT_MAP_NPY, file, size, 0);
    assert_int_equal(map.grid.nx, 3);
    assert_int_equal(map.grid.ny, 2);
    assert_true(map.grid.lx == 3 && map.z[1] == -2 && map.z[5] == 6);
    height_map_clear(&map);
    size = npy(file, 1, "{'shape':(6,), 'fortran_order':False, 'descr':'<f8'}\n", z, sizeof z);
    map = parse(HEIGHT_MAP_NPY, file, size, 0.5);
    assert_int_equal(map.grid.nx, 6);
    assert_int_equal(map.grid.ny, 1);
    assert_true(map.grid.lx == 3);
    height_map_clear(&map);
}

/* The numbers 1 to 6, with -1 in place of 5 where the type has a sign. */
static double number_of(const char *type, size_t number) {
    return number == 5 && *type != 'u' ? -1 : (double)number;
}

/* The bits of a number in a type such as "i2". */
static uint64_t bits_of(const char *type, size_t number) {
    static const uint64_t HALVES[] = {0, 0x3c00, 0x4000, 0x4200, 0x4400, 0xbc00, 0x4600};
    double value = number_of(type, number);
    float single = (float)value;
    uint32_t low;
    uint64_t bits;
    memcpy(&low, &single, sizeof low);
    memcpy(&bits, &value, sizeof bits);
    if (*type != 'f')
        return value < 0 ? UINT64_MAX : number;
    return type[1] == '2' ? HALVES[number] : type[1] == '4' ? low : bits;
}

static void check_type_and_order(const char *type, bool big, bool fortran, int version) {
    char file[1000], header[120], data[48];
    size_t bytes = (size_t)(type[1] - '0');
    for (size_t place = 0; place < 6; place++) {
        size_t number = fortran ? place % 2 * 3 + place / 2 + 1 : place + 1;
        uint64_t bits = bits_of(type, number);
        for (size_t b = 0; b < bytes; b++)
            data[place * bytes + (big ? bytes - 1 - b : b)] = (char)(bits >> (8 * b) & 0xff);
    }
    snprintf(header, sizeof header, "{'descr': '%c%s', 'fortran_order': %s, 'shape': (2, 3), }",
             big ? '>' : '<', type, fortran ? "True" : "False");
    struct height_map map =
        parse(HEIGHT_MAP_NPY, file, npy(file, version, header, data, 6 * bytes), 1);
    assert_true(map.grid.nx == 3 && map.grid.ny == 2);
    for (size_t number = 1; number <= 6; number++)
        if (!(map.z[number - 1] == number_of(type, number)))
            fail_msg("%s: number %zu is %g", header, number, map.z[number - 1]);
    height_map_clear(&map);
}

/* In every type that NumPy has for numbers, either order of bytes and of indices. */
static void every_type_and_order(void **state) {
    (void)state;
    static const char *const TYPES[] = {"f2", "f4", "f8", "i1", "i2", "i4",
                                        "i8", "u1", "u2", "u4", "u8"};
    for (size_t t = 0; t < 4 * sizeof TYPES / sizeof *TYPES; t++)
        check_type_and_order(TYPES[t / 4], t % 2 != 0, t / 2 % 2 != 0, 1 + (int)(t % 3));
}

/* What half precision has beside normal numbers. */
static void half_precision(void **state) {
    (void)state;
    char file[200];
    static const unsigned char DATA[] = {0x01, 0x00, 0xff, 0x83, 0x00, 0x7e, 0x00, 0x80};
    size_t size = npy(file, 1, "{\"descr\": \"<f2\", \"fortran_order\": False, \"shape\": (4,)}",
                      DATA, sizeof DATA);
    struct height_map map = parse(HEIGHT_MAP_NPY, file, size, 1);
    assert_true(map.z[0] == ldexp(1, -24) && map.z[1] == -1023 * ldexp(1, -24));
    assert_true(isnan(map.z[2]) && map.z[3] == 0 && signbit(map.z[3]) != 0);
    height_map_clear(&map);
}

static void refused(enum height_map_format format, const char *text, size_t size,
                    const char *words) {
    struct height_map map = {0};
    struct error err = {0};
    int status = height_map_parse(&map, format, text, size, 1, &err);
    if (status != ERROR_INPUT || strstr(err.text, words) == NULL)
        fail_msg("'%s' expected, but status %d, '%s'", words, status, err.text);
    assert_null(map.z);
}

static void refused_npy(void **state) {
    (void)state;
    static const struct {
        const char *header, *words;
    } cases[] = {
        {"{'descr': '<c16', 'fortran_order': False, 'shape': (2, 3), }",
         "the npy type '<c16' is not read"},
        {"{'descr': '<f16', 'fortran_order': False, 'shape': (2, 3), }", "allowed: f2, f4, f8"},
        {"{'descr': '<i3', 'fortran_order': False, 'shape': (2, 3), }", "'<i3'"},
        {"{'descr': 'f8', 'fortran_order': False, 'shape': (2, 3), }", "'f8'"},
        {"{'descr': '<", "'<"},
        {"{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (2, 3), }", "allowed"},
        {"{'fortran_order': False, 'shape': (2, 3), }", "absent"},
        {"{'descr': '<f8', 'fortran_order': 1, 'shape': (2, 3), }", "True or False"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3, 1), }", "shape"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (-2, 3), }", "shape"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (), }", "shape"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (2, 4), }", "64 bytes"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1), }", "at least 2"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999, 9), }", "2^31"},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (4294967296, 4294967296), }", "2^31"},
    };
    char file[1000];
    double z[6] = {0};
    for (size_t a = 0; a < sizeof cases / sizeof *cases; a++)
        refused(HEIGHT_MAP_NPY, file, npy(file, 1, cases[a].header, z, sizeof z), cases[a].words);
    const char *good = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }";
    refused(HEIGHT_MAP_NPY, file, npy(file, 4, good, z, sizeof z), "version 4");
    z[4] = INFINITY;
    size_t size = npy(file, 1, good, z, sizeof z);
    refused(HEIGHT_MAP_NPY, file, size, "row 2, column 2: the height is not finite");
    for (size_t cut = 0; cut < size; cut++)
        refused(HEIGHT_MAP_NPY, file, cut, "");
    refused(HEIGHT_MAP_NPY, "1,2,3", 5, "no npy file");
}

static void csv_separators(void **state) {
    (void)state;
    const char *texts[] = {"1,2,3\n4,5,6\n", "# heights\r\n1;2; 3\r\n\r\n4;5;6",
                           " 1 2\t3\n4 5 6 \n"};
    for (size_t a = 0; a < 3; a++) {
        struct height_map map = parse(HEIGHT_MAP_CSV, texts[a], strlen(texts[a]), 2);
        assert_true(map.grid.nx == 3 && map.grid.ny == 2 && map.grid.lx == 6 && map.grid.ly == 4);
        assert_true(map.z[0] == 1 && map.z[2] == 3 && map.z[5] == 6);
        height_map_clear(&map);
    }
    static const char MARKED[] = "\xef\xbb\xbf" /* as Excel saves it */
                                 "1,2\n3,4\n";
    struct height_map map = parse(HEIGHT_MAP_CSV, MARKED, sizeof MARKED - 1, 1);
    assert_true(map.grid.nx == 2 && map.grid.ny == 2 && map.z[0] == 1 && map.z[3] == 4);
    height_map_clear(&map);
    map = parse(HEIGHT_MAP_CSV, "1\n2\n3\n", 6, 0);
    assert_true(map.grid.nx == 3 && map.grid.ny == 1);
    height_map_clear(&map);
}

/* Spreadsheets write points that are missing as empty cells. */
static void empty_fields_are_holes(void **state) {
    (void)state;
    static const char *const TEXTS[] = {"1,2,3\n,5,\n7,8,9\n", "1;2;3\n; 5 ;\r\n7;8;9",
                                        "1 2 3\nnan 5 nan\n7 8 9\n"};
    for (size_t t = 0; t < sizeof TEXTS / sizeof *TEXTS; t++) {
        struct height_map map = parse(HEIGHT_MAP_CSV, TEXTS[t], strlen(TEXTS[t]), 1);
        assert_true(map.grid.nx == 3 && map.grid.ny == 3);
        for (size_t n = 0; n < 9; n++)
            assert_true(n == 3 || n == 5 ? isnan(map.z[n]) : map.z[n] == (double)n + 1);
        height_map_clear(&map);
    }
    struct height_map first = parse(HEIGHT_MAP_CSV, "1,\n,4\n", 6, 1);
    assert_true(isnan(first.z[1]) && isnan(first.z[2]) && first.z[3] == 4);
    height_map_clear(&first);
}

static void refused_text(void **state) {
    (void)state;
    static const struct {
        enum height_map_format format;
        const char *text, *words;
    } cases[] = {
        {HEIGHT_MAP_CSV, "", "no number"},
        {HEIGHT_MAP_CSV, "# only a comment\n", "no number"},
        {HEIGHT_MAP_CSV, "1,2\n3\n", "row 2 (line 2) has 1 numbers, the first row 2"},
        {HEIGHT_MAP_CSV, "1,2\n3,x\n", "row 2, column 2 (line 2): 'x' is not a number; allowed"},
        {HEIGHT_MAP_CSV, "1,nana\n", "'nana' is not a number"},
        {HEIGHT_MAP_XYZ, "0 0 1\nnan 0 1\n2 0 1\n", "point 2"},
        {HEIGHT_MAP_CSV, "1,inf\n", "'inf' is not a number"},
        {HEIGHT_MAP_CSV, "1,0x10\n", "is not a number"},
        {HEIGHT_MAP_CSV, "# x\n1,1e999\n", "row 1, column 2 (line 2): '1e999' is too large"},
        {HEIGHT_MAP_CSV, "1,2,\n", "every row ends with a separator"},
        {HEIGHT_MAP_CSV, "1,2,\n3,4,\n", "every row ends with a separator"},
        {HEIGHT_MAP_CSV, "1,2\n3,4,\n", "row 2 (line 2) has 3 numbers, the first row 2"},
        {HEIGHT_MAP_CSV, "1\n", "at least 2"},
        {HEIGHT_MAP_XYZ, "0 0\n1 0\n", "3 numbers"},
        {HEIGHT_MAP_XYZ, "0 0 1\n1 0 1\n0 1 1\n", "regular grid"},
        {HEIGHT_MAP_XYZ, "0 0 1\n1 0 1\n0 1 1\n2 1 1\n", "point 4"},
        {HEIGHT_MAP_XYZ, "1 0 1\n0 0 1\n", "x must rise"},
        {HEIGHT_MAP_CSV, "\xef\xbb\xbfx,2\n", "row 1, column 1 (line 1): 'x' is not a number"},
        {HEIGHT_MAP_CSV,
         "\xff\xfe"
         "1",
         "the text is in UTF-16; allowed: UTF-8"},
        {HEIGHT_MAP_XYZ, "\xfe\xff", "the text is in UTF-16"},
    };
    for (size_t a = 0; a < sizeof cases / sizeof *cases; a++)
        refused(cases[a].format, cases[a].text, strlen(cases[a].text), cases[a].words);
    refused(HEIGHT_MAP_CSV, "1,2\0003,4", 7, "zero byte");
    struct height_map map;
    struct error err = {0};
    assert_int_equal(height_map_parse(&map, HEIGHT_MAP_CSV, "1,2", 3, -1, &err), ERROR_INPUT);
    assert_int_equal(height_map_parse(&map, HEIGHT_MAP_CSV, "1,2", 3, NAN, &err), ERROR_INPUT);
}

/* Spacing and shape come from the coordinates, whatever their origin and scale. */
static void xyz_coordinates(void **state) {
    (void)state;
    char text[4000], *at = text;
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < 4; i++)
            at += snprintf(at, 100, "%.9g %.9g %d\n", -7e-6 + i * 1e-7, 3e-6 + j * 2e-7, 4 * j + i);
    struct height_map map = parse(HEIGHT_MAP_XYZ, text, strlen(text), 0);
    assert_true(map.grid.nx == 4 && map.grid.ny == 3 && map.z[11] == 11);
    assert_true(fabs(map.grid.lx - 4e-7) <= 1e-12 && fabs(map.grid.ly - 6e-7) <= 1e-12);
    height_map_clear(&map);
}

/* What was not measured is NaN in every format, is written and read as such, and is reported to
 * those who need all heights. */
static void holes(void **state) {
    (void)state;
    static const struct {
        enum height_map_format format;
        const char *text;
    } texts[] = {{HEIGHT_MAP_CSV, "1,nan,3\n4,NaN, 6\n"},
                 {HEIGHT_MAP_XYZ, "0 0 1\n1 0 nan\n2 0 3\n0 1 4\n1 1 nan\n2 1 6\n"}};
    for (size_t t = 0; t < 2; t++) {
        struct height_map map = parse(texts[t].format, texts[t].text, strlen(texts[t].text), 1);
        assert_int_equal(height_map_holes(&map), 2);
        assert_true(isnan(map.z[1]) && isnan(map.z[4]) && map.z[5] == 6);
        struct error err = {0};
        assert_int_equal(height_map_check_whole(&map, &err), ERROR_INPUT);
        assert_non_null(strstr(err.text, "2 of 6 heights are holes (NaN), the first in row 1, "
                                         "column 2"));
        for (int format = 0; format < HEIGHT_MAP_FORMATS; format++) {
            char *text = NULL;
            size_t size = 0;
            FILE *file = open_memstream(&text, &size);
            assert_non_null(file);
            assert_int_equal(
                height_map_write(file, (enum height_map_format)format, &map.grid, map.z, &err), 0);
            fclose(file);
            struct height_map again = parse((enum height_map_format)format, text, size, 1);
            assert_memory_equal(again.z, map.z, 6 * sizeof *map.z);
            height_map_clear(&again);
            free(text);
        }
        height_map_clear(&map);
    }
    const double whole[] = {1, 2};
    char file[300];
    size_t size = npy(file, 1, "{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }", whole,
                      sizeof whole);
    struct height_map map = parse(HEIGHT_MAP_NPY, file, size, 1);
    assert_int_equal(height_map_holes(&map), 0);
    assert_int_equal(height_map_check_whole(&map, NULL), 0);
    height_map_clear(&map);
}

/* Random bytes behind a good start: an answer or a refusal, never a crash (run under sanitizers).
 */
static void random_bytes(void **state) {
    (void)state;
    char good[500], file[501];
    const double z[6] = {0};
    size_t size =
        npy(good, 1, "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }", z, sizeof z);
    uint32_t word = 12345;
    for (int trial = 0; trial < 20000; trial++) {
        memcpy(file, good, size);
        for (int change = 0; change < 3; change++) {
            word = word * 1664525 + 1013904223;
            file[(word >> 8) % size] = (char)(word >> 24);
        }
        file[size] = '\0';
        struct height_map map = {0};
        struct error err = {0};
        for (int format = 0; format < HEIGHT_MAP_FORMATS; format++)
            if (height_map_parse(&map, (enum height_map_format)format, file, size, 1, &err) == 0)
                height_map_clear(&map);
    }
}

static void formats_by_name(void **state) {
    (void)state;
    assert_int_equal(height_map_format_of("a/b.c.NPY"), HEIGHT_MAP_NPY);
    assert_int_equal(height_map_format_of("x.csv"), HEIGHT_MAP_CSV);
    assert_int_equal(height_map_format_of("x.xyz"), HEIGHT_MAP_XYZ);
    assert_int_equal(height_map_format_of("xyz"), HEIGHT_MAP_FORMATS);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trip),      cmocka_unit_test(failing_write),
        cmocka_unit_test(numpy_headers),   cmocka_unit_test(every_type_and_order),
        cmocka_unit_test(half_precision),  cmocka_unit_test(refused_npy),
        cmocka_unit_test(csv_separators),  cmocka_unit_test(empty_fields_are_holes),
        cmocka_unit_test(refused_text),    cmocka_unit_test(holes),
        cmocka_unit_test(xyz_coordinates), cmocka_unit_test(random_bytes),
        cmocka_unit_test(formats_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
