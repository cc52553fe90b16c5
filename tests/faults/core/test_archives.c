/* Protects: an X3P or NPZ file is read, or refused for want of memory, whichever allocation fails,
 * of the libraries below too; nothing leaks, and the next attempt reads it. */
#include "tests/support/check.h"

#include "core/instrument/instrument.h"
#include "tests/support/failing/each_allocation.h"
#include "tests/support/x3p_file.h"
#include "tests/support/zip_file.h"
#include <stdlib.h>

/* libzip 1.7.3 loses the layer that decompresses where it has no memory for the next one. */
__attribute__((visibility("default"))) const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
    return "leak:libzip.so";
}

struct archive {
    const char *name;
    char *file; /* owned */
    size_t size;
};

static int read_archive(void *context, struct error *err) {
    const struct archive *archive = context;
    struct height_map map = {0};
    int status = instrument_read(&map, archive->name, archive->file, archive->size, 0,
                                 &(struct instrument_request){0}, NULL, err);
    if (status == 0)
        assert_true(map.grid.nx == 2 && map.grid.ny == 2 && map.z[0] == 1);
    height_map_clear(&map);
    return status;
}

static void each(struct archive archive) {
    /* libzip calls a file no archive where it has no memory to look for its directory, and does
     * without the zone of the times in it. */
    each_allocation(&(struct failing_call){
        .name = archive.name, read_archive, &archive, .also = ERROR_INPUT, .may_succeed = 1});
    free(archive.file);
}

static void surfaces(void **state) {
    (void)state;
    const double z[] = {1, 2, 3, 4};
    const unsigned char valid[] = {7};
    const struct x3p_sheet binary = {.dimension = X3P_MATRIX("2", "2", "1"),
                                     .points = z,
                                     .size = sizeof z,
                                     .valid = valid,
                                     .valid_size = 1};
    const struct x3p_sheet cloud = {.feature = "PCL",
                                    .x = X3P_ABSOLUTE("D", "1", "0"),
                                    .y = X3P_ABSOLUTE("D", "1", "0"),
                                    .dimension = "<ListDimension>3</ListDimension>",
                                    .data = "<DataList><Datum>0;0;1</Datum><Datum>1;0;2</Datum>"
                                            "<Datum>1;1;3</Datum></DataList>"};
    struct archive archive = {.name = "binary.x3p"};
    archive.file = x3p_file_create(&binary, &archive.size);
    each(archive);
    archive.name = "cloud.x3p";
    archive.file = x3p_file_create(&cloud, &archive.size);
    each(archive);
}

static void arrays(void **state) {
    (void)state;
    static const char array[] = "\x93NUMPY\x01\x00\x3c\x00{'descr': '|u1', 'fortran_order': False, "
                                "'shape': (2, 2), }\n\x01\x02\x03\x04";
    const struct zip_part part = {"z.npy", array, sizeof array - 1, false};
    struct archive archive = {.name = "arrays.npz"};
    archive.file = zip_file_create(&part, 1, &archive.size);
    each(archive);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(surfaces), cmocka_unit_test(arrays)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
