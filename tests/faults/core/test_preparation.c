/* Protects: a map with a hole is prepared by all steps (a crop without giving memory back), or
 * refused for want of memory, whichever allocation fails; nothing leaks, and the next attempt gives
 * the same. */
#include "core/map/preparation/preparation_words.h"
#include "tests/support/check.h"
#include "tests/support/failing/each_allocation.h"
#include <stdlib.h>

enum { NX = 40, NY = 36 };

static int prepare(void *context, struct error *err) {
    struct height_map map = {.grid = {NX, NY, NX, NY}};
    struct preparation_record record = {0};
    struct preparation asked;
    assert_int_equal(preparation_parse(&asked, context, NULL), 0);
    asked.artefacts = asked.stride_x > 0;
    map.z = array_create((size_t)NX * NY, sizeof *map.z);
    if (map.z == NULL)
        return error_memory(err, (size_t)NX * NY * sizeof *map.z, "a map");
    for (size_t point = 0; point < (size_t)NX * NY; point++)
        map.z[point] = point % 97 == 5 ? (double)NAN : sin(0.3 * (double)point);
    int status = preparation_run(&record, &map, &asked, err);
    if (status == 0)
        assert_int_equal(height_map_holes(&map), 0);
    height_map_clear(&map);
    return status;
}

static void all_steps(void **state) {
    (void)state;
    struct preparation_words open = {.dx = "0.5um",
                                     .z_unit = "nm",
                                     .crop = "0,0,38,34",
                                     .fill = true,
                                     .filter = "S=3um,L=15um,robust",
                                     .resample = "60",
                                     .window = MAP_WINDOW_TUKEY};
    struct preparation_words coarser = {.fill = true, .denoise = true, .resample = "36,32"};
    struct preparation_words periodic = {
        .fill = true, .filter = "S=6", .resample = "60", .boundary = ASK_BOUNDARY_PERIODIC};
    each_allocation(&(struct failing_call){.name = "open", prepare, &open, .may_succeed = 1});
    struct preparation_words turned = {.lines = SCAN_LINES_MEDIAN,
                                       .stride = "1",
                                       .despike = MAP_DESPIKE,
                                       .tip = "tip=3,holes",
                                       .transpose = true,
                                       .rotate = "25",
                                       .fill = true};
    each_allocation(&(struct failing_call){.name = "turned", prepare, &turned});
    struct preparation_words extended = {.boundary = ASK_BOUNDARY_OPEN, .extend = MAP_EXTEND};
    /* qsort() does without its own. */
    each_allocation(
        &(struct failing_call){.name = "extended", prepare, &extended, .may_succeed = 1});
    each_allocation(&(struct failing_call){.name = "coarser", prepare, &coarser});
    each_allocation(&(struct failing_call){.name = "periodic", prepare, &periodic});
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_steps)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
