/* Protects: of an NPZ file the array that was asked for is read, or else the only one that can be a
 * map, and several are named; files of NumPy itself are read; and what is damaged or lies is
 * refused with words. */
#include "tests/support/check.h"

#include "core/instrument/instrument.h"
#include "tests/support/instrument_files.h"
#include "tests/support/zip_file.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FILE_MOST = 8000 };

/* An npy file of doubles 1, 2, 3, ... with this shape. */
struct npy {
    char bytes[400];
    size_t size;
};

static struct npy npy_of(const char *type, const char *shape, size_t bytes) {
    struct npy npy = {.bytes = "\x93NUMPY\x01"};
    char *header = npy.bytes + 10;
    int length =
        sprintf(header, "{'descr': '%s', 'fortran_order': False, 'shape': %s, }\n", type, shape);
    npy.bytes[8] = (char)length;
    npy.size = 10 + (size_t)length + bytes;
    for (size_t point = 0; 8 * point < bytes; point++) {
        double number = (double)point + 1;
        memcpy(header + length + 8 * point, &number, sizeof number);
    }
    return npy;
}

static int read_named(struct height_map *map, const char *file, size_t size, const char *layer,
                      struct error *err) {
    const char *format = NULL;
    int status = instrument_read(map, "arrays", file, size, 0,
                                 &(struct instrument_request){.layer = layer}, &format, err);
    if (status == 0) {
        assert_string_equal(format, "npz");
        assert_string_equal(map->xy_unit, "");
        assert_string_equal(map->z_unit, "");
    }
    return status;
}

/* Shape and last height of an array. */
static void expect(const char *file, size_t size, const char *layer, size_t nx, size_t ny,
                   double last) {
    struct height_map map = {0};
    struct error err = {0};
    if (read_named(&map, file, size, layer, &err) != 0)
        fail_msg("%s", err.text);
    assert_true(map.grid.nx == nx && map.grid.ny == ny);
    assert_true(map.z[nx * ny - 1] == last);
    height_map_clear(&map);
}

static void arrays(void **state) {
    (void)state;
    const struct npy text = npy_of("<U1", "(2, 2)", 16), deep = npy_of("<f8", "(2, 2, 2)", 64),
                     line = npy_of("<f8", "(4,)", 32), map = npy_of("<f8", "(2, 3)", 48),
                     other = npy_of("<f8", "(3, 2)", 48);
    const struct zip_part parts[] = {{"readme", "words", 5, true},
                                     {"text.npy", text.bytes, text.size, false},
                                     {"deep.npy", deep.bytes, deep.size, false},
                                     {"line.npy", line.bytes, line.size, true},
                                     {"z.npy", map.bytes, map.size, false},
                                     {"2.npy", other.bytes, other.size, false}};
    struct height_map none = {0};
    struct error err = {0};
    size_t size = 0;
    char *file = zip_file_create(parts, 6, &size);
    expect(file, size, "line", 4, 1, 4);
    expect(file, size, "z.npy", 3, 2, 6);
    expect(file, size, "2", 2, 3, 6); /* a name goes before a number */
    expect(file, size, "4", 3, 2, 6);
    assert_int_equal(read_named(&none, file, size, "q", &err), ERROR_INPUT);
    assert_string_equal(err.text, "there is no array 'q'; allowed: text, deep, line, z, 2");
    assert_int_equal(read_named(&none, file, size, "7", &err), ERROR_INPUT);
    assert_int_equal(read_named(&none, file, size, "deep", &err), ERROR_INPUT);
    assert_string_equal(err.text, "deep.npy: the npy shape must be (n,) or (ny, nx)");
    assert_int_equal(read_named(&none, file, size, NULL, &err), ERROR_INPUT);
    assert_string_equal(err.text,
                        "2 arrays can be the map: z, 2; --layer NAME (layer in studies and "
                        "requests) says which");
    free(file);
    file = zip_file_create(parts, 5, &size); /* a profile is none beside a map */
    expect(file, size, NULL, 3, 2, 6);
    free(file);
    file = zip_file_create(parts, 4, &size); /* without a map, a profile is one */
    expect(file, size, NULL, 4, 1, 4);
    free(file);
    file = zip_file_create(parts, 3, &size);
    assert_int_equal(read_named(&none, file, size, NULL, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "no array can be a map"));
    free(file);
    file = zip_file_create(parts, 1, &size);
    assert_int_equal(read_named(&none, file, size, NULL, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "no main.xml, as X3P files do, and no .npy"));
    free(file);
}

static void damaged_arrays(void **state) {
    (void)state;
    const struct {
        const char *type, *shape;
        size_t bytes;
        const char *told;
    } damaged[] = {{"<f8", "(2, 3)", 40, "take 48 bytes; the npy file has 40"},
                   {"<f8", "(2, 3)", 56, "the npy file has 56"},
                   {"<f8", "(99999, 3)", 48, "take 2399976 bytes"},
                   {"<f8", "(99999, 99999)", 48, "no array can be a map"},
                   {"<f8", "(99999999999999999999, 2)", 48, "no array can be a map"},
                   {"<f8", "(-2, 3)", 48, "no array can be a map"},
                   {"<f8", "(6)", 48, "no array can be a map"},
                   {"<f8", "()", 48, "no array can be a map"},
                   {"<f8", "(0, 3)", 0, "no array can be a map"},
                   {"<f8", "(2, 3", 48, "no array can be a map"},
                   {"|O", "(2, 3)", 48, "no array can be a map"},
                   {"<c16", "(2, 3)", 96, "no array can be a map"},
                   {"<f3", "(2, 3)", 48, "no array can be a map"},
                   {"<f", "(2, 3)", 48, "no array can be a map"},
                   {"", "(2, 3)", 48, "no array can be a map"}};
    for (size_t a = 0; a < sizeof damaged / sizeof *damaged; a++) {
        const struct npy npy = npy_of(damaged[a].type, damaged[a].shape, damaged[a].bytes);
        struct height_map map = {0};
        struct error err = {0};
        size_t size = 0;
        char *file =
            zip_file_create(&(struct zip_part){"z.npy", npy.bytes, npy.size, false}, 1, &size);
        int status = read_named(&map, file, size, NULL, &err);
        if (status != ERROR_INPUT || strstr(err.text, damaged[a].told) == NULL)
            fail_msg("array %zu: %d, \"%s\" in place of \"%s\"", a, status, err.text,
                     damaged[a].told);
        assert_null(map.z);
        free(file);
    }
}

/* Wrong entries in the archive's directory. */
static void lying_sizes(void **state) {
    (void)state;
    const struct npy npy = npy_of("<f8", "(2, 3)", 48);
    const struct {
        enum zip_number which;
        uint32_t value;
        const char *told;
    } lies[] = {{ZIP_UNPACKED, 0x7fffffff, "z.npy says that it unpacks to 2147483647 bytes"},
                {ZIP_UNPACKED, 60, ""},
                {ZIP_UNPACKED, 0, ""},
                {ZIP_UNPACKED, 4000, ""},
                {ZIP_PACKED, 3, ""},
                {ZIP_CRC, 5, ""}};
    for (size_t lie = 0; lie < sizeof lies / sizeof *lies; lie++) {
        struct height_map map = {0};
        struct error err = {0};
        size_t size = 0;
        char *file =
            zip_file_create(&(struct zip_part){"z.npy", npy.bytes, npy.size, false}, 1, &size);
        char *number = zip_file_number(file, size, "z.npy", lies[lie].which);
        for (size_t byte = 0; byte < 4; byte++)
            number[byte] = (char)(lies[lie].value >> 8 * byte & 0xff);
        int status = read_named(&map, file, size, NULL, &err);
        if (status != ERROR_INPUT || strstr(err.text, lies[lie].told) == NULL)
            fail_msg("lie %zu: %d, %s", lie, status, err.text);
        free(file);
    }
}

/* An entry that says less than it unpacks to is given up as soon as that is seen: 16 MiB of zeros
 * in 74 kB here. One that says more than a file of its size may is refused above. */
static void bombs(void **state) {
    (void)state;
    const size_t most = (size_t)16 << 20;
    struct height_map map = {0};
    struct error err = {0};
    size_t size = 0;
    const struct npy npy = npy_of("<f8", "(2, 3)", 48);
    char *zeros = calloc(most, 1);
    assert_non_null(zeros);
    memcpy(zeros, npy.bytes, npy.size);
    char *file = zip_file_create(&(struct zip_part){"z.npy", zeros, most, false}, 1, &size);
    assert_true(size < most / 200);
    zip_file_number(file, size, "z.npy", ZIP_UNPACKED)[3] = 0; /* of 16 MiB, 0 is left */
    assert_int_equal(read_named(&map, file, size, NULL, &err), ERROR_INPUT);
    assert_int_equal(read_named(&map, file, size, "z", &err), ERROR_INPUT);
    free(file);
    free(zeros);
}

static void check_damaged(struct height_map *map) {
    assert_true(map->grid.nx == 3 && map->z[5] == 6);
}

static void cut_and_changed(void **state) {
    (void)state;
    const struct npy npy = npy_of("<f8", "(2, 3)", 48);
    size_t size = 0;
    char *file = zip_file_create(&(struct zip_part){"z.npy", npy.bytes, npy.size, true}, 1, &size);
    expect_damage_told("a.npz", file, size, check_damaged);
    free(file);
}

/* tests/fixtures/instrument: z = 1e-6 (i - 2 j) + 1e-8 i j, a hole at i 2, j 3. */
static void check_formula(const char *name, const char *layer, bool holed, double tolerance,
                          double unit) {
    const char *source = getenv("RUGO_SOURCE");
    char path[1000], file[FILE_MOST];
    struct height_map map = {0};
    struct error err = {0};
    snprintf(path, sizeof path, "%s/tests/fixtures/instrument/%s", source != NULL ? source : ".",
             name);
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    size_t size = fread(file, 1, sizeof file - 1, stream);
    fclose(stream);
    file[size] = 0;
    if (read_named(&map, file, size, layer, &err) != 0)
        fail_msg("%s: %s", path, err.text);
    assert_true(map.grid.nx == 7 && map.grid.ny == 5);
    for (size_t point = 0; point < 35; point++) {
        const size_t column = point % 7, row = point / 7;
        double i = (double)column, j = (double)row;
        double z = point == 3 * 7 + 2 ? holed ? (double)NAN : 0 : 1e-6 * (i - 2 * j) + 1e-8 * i * j;
        if (isnan(z))
            assert_true(isnan(map.z[point]));
        else
            check_close(map.z[point] * unit, z, tolerance);
    }
    height_map_clear(&map);
}

static void files_of_numpy(void **state) {
    (void)state;
    check_formula("numpy_stored.npz", "z", true, 0, 1);
    check_formula("numpy_stored.npz", "columns", true, 1e-12, 1);
    check_formula("numpy_stored.npz", "counts", false, 1e-9, 1e-9);
    check_formula("numpy_compressed.npz", "arr_0", true, 0, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays),          cmocka_unit_test(damaged_arrays),
        cmocka_unit_test(lying_sizes),     cmocka_unit_test(bombs),
        cmocka_unit_test(cut_and_changed), cmocka_unit_test(files_of_numpy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
