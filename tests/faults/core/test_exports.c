/* Protects: files of Gwyddion, surface data files and text exports are read, or refused for want of
 * memory, whichever allocation fails; nothing leaks, and the next attempt reads them. */
#include "tests/support/check.h"

#include "tests/support/failing/each_allocation.h"
#include "tests/support/instrument_files.h"
#include <gsl/gsl_errno.h>

struct export {
    const char *name;
    struct bytes file;
};

static int read_export(void *context, struct error *err) {
    const struct export *export = context;
    struct height_map map = {0};
    int status = instrument_read(&map, export->name, export->file.data, export->file.size, 0,
                                 &(struct instrument_request){0}, NULL, err);
    if (status == 0)
        assert_true(map.grid.nx >= 2 && map.z != NULL);
    height_map_clear(&map);
    return status;
}

static void each(const char *name, struct bytes file) {
    struct export export = {name, file};
    each_allocation(&(struct failing_call){.name = name, read_export, &export});
    free(file.data);
}

static void by_gwyddion(void **state) {
    (void)state;
    const char *const names[] = {"gwyddion.gwy", "gwyddion.sdf", "gwyddion-matrix.txt",
                                 "gwyddion-points.xyz", "gwyddion-spip.asc"};
    for (size_t n = 0; n < sizeof names / sizeof names[0]; n++)
        each(names[n], bytes_of_fixture(names[n]));
}

static void others(void **state) {
    (void)state;
    static const char wide[] = "\xff\xfe"
                               "1\0 \0002\0\n\0003\0 \0004\0";
    each("wide.csv", bytes_of(wide, sizeof wide - 1));
    each("points.xyz", bytes_of_text("1 1 1\n0 0 2\n1 0 3\n"));
    each("trace.csv", bytes_of_text("X,Z\n0,1\n1,3\n2.2,2\n3,5\n4.1,4\n"));
    each("plain.csv", bytes_of_text("0 1\n1 3\n2 2\n3 5\n"));
    each("list.csv", bytes_of_text("0 0 1\n1 0 3\n0 1 2\n1 1 5\n"));
    each("old.csv", bytes_of_text("1,2,4\r3,4,5\r"));
    each("commas.csv", bytes_of_text("0,01\n0,02\n0,01\n0,05\n0,03\n0,02\n0,01\n0,04\n"));
    each("surfer.grd", bytes_of_text("DSAA\n2 2\n0 1\n0 1\n0 1\n1 2 3 4\n"));
    each("esri.asc", bytes_of_text("ncols 2\nnrows 1\ncellsize 1\n1 2\n"));
    each("zygo.xyz", bytes_of_text("Zygo XYZ Data File - Format 1\n0\n0\n0 0 2 1\n\n\n\n"
                                   "0 0 0 0 0 0 1e-6 0\n#\n0 0 1\n1 0 2\n#\n"));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(by_gwyddion), cmocka_unit_test(others)};
    gsl_set_error_handler_off(); /* as the program does */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
