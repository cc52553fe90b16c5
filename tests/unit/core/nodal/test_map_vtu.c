/* Protects: a map as a VTU file has all its points, cells and fields, to the last bit. */
#include "core/file/memory_file.h"
#include "core/nodal/map_vtu.h"
#include "tests/support/check.h"
#include <nettle/base64.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* The bytes of an array, behind its header, which must have their number. The caller frees what
 * *data begins with. */
static unsigned char *array_of(const char *text, const char *name, size_t *size) {
    char pattern[60];
    unsigned char *data;
    uint64_t told;
    snprintf(pattern, sizeof pattern, "Name=\"%s\"", name);
    const char *at = strstr(text, pattern);
    assert_non_null(at);
    at = strstr(at, ">\n");
    assert_non_null(at);
    size_t length = strcspn(at + 2, "\n");
    struct base64_decode_ctx context;
    *size = BASE64_DECODE_LENGTH(length);
    data = calloc(*size + 1, 1);
    assert_non_null(data);
    base64_decode_init(&context);
    assert_true(base64_decode_update(&context, size, data, length, at + 2));
    assert_true(base64_decode_final(&context));
    assert_true(*size >= sizeof told);
    memcpy(&told, data, sizeof told);
    *size -= sizeof told;
    assert_int_equal(told, *size);
    return data;
}

static char *written(const struct grid *grid, const double *z, const struct map_field *field) {
    struct memory_file memory;
    assert_true(memory_file_open(&memory));
    assert_int_equal(map_vtu(memory.file, "a--map at 1e-05 --", grid, z, 1, field, NULL), 0);
    char *text = memory_file_close(&memory, NULL);
    assert_non_null(text);
    assert_non_null(strstr(text, "<!-- a-map at 1e-05 - -->"));
    return text;
}

static void check_array(const char *text, const char *name, size_t bytes, const void *expected) {
    size_t size;
    unsigned char *data = array_of(text, name, &size);
    assert_int_equal(size, bytes);
    assert_memory_equal(data + sizeof(uint64_t), expected, bytes);
    free(data);
}

static void surface_is_written(void **state) {
    (void)state;
    const struct grid grid = {3, 2, 1.5, 2};
    const double z[] = {0.1, 0.2, 1.0 / 3, 4, 5, -6}, p[] = {1, 0, 1e-300, 2, 3, 7};
    const double points[] = {0, 0, 0.1, 0.5, 0, 0.2, 1, 0, 1.0 / 3, 0, 1, 4, 0.5, 1, 5, 1, 1, -6};
    const int64_t corners[] = {0, 1, 4, 3, 1, 2, 5, 4}, offsets[] = {4, 8};
    const unsigned char types[] = {9, 9};
    char *text = written(&grid, z, &(struct map_field){"pressure", p});
    assert_non_null(strstr(text, "NumberOfPoints=\"6\" NumberOfCells=\"2\""));
    check_array(text, "Points", sizeof points, points);
    check_array(text, "connectivity", sizeof corners, corners);
    check_array(text, "offsets", sizeof offsets, offsets);
    check_array(text, "types", sizeof types, types);
    check_array(text, "pressure", sizeof p, p);
    free(text);
}

static void profile_is_written(void **state) {
    (void)state;
    const struct grid grid = {3, 1, 3, 1};
    const double z[] = {1, 2, 3}, points[] = {0, 1, 0, 1, 2, 0, 2, 3, 0};
    const int64_t corners[] = {0, 1, 1, 2};
    const unsigned char types[] = {3, 3};
    char *text = written(&grid, z, &(struct map_field){"gap", z});
    check_array(text, "Points", sizeof points, points);
    check_array(text, "connectivity", sizeof corners, corners);
    check_array(text, "types", sizeof types, types);
    check_array(text, "gap", sizeof z, z);
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surface_is_written),
        cmocka_unit_test(profile_is_written),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
