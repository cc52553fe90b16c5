/* What fuzz targets of instruments' files share. */
#ifndef RUGO_TESTS_SUPPORT_FUZZ_INSTRUMENT_H
#define RUGO_TESTS_SUPPORT_FUZZ_INSTRUMENT_H

#include "core/instrument/instrument.h"
#include "tests/support/fuzz/fuzz.h"
#include <math.h>

/* Reads the bytes by this reader, a layer by number and columns as the first byte says: a map with
 * finite heights and holes, of at most `share` points a byte, or a refusal in words. */
static inline int fuzz_instrument(const struct instrument_format *format, const uint8_t *data,
                                  size_t size, size_t share) {
    static const char *const layers[] = {NULL, "1", "2", "Topography"};
    if (size == 0)
        return 0;
    char done[INSTRUMENT_DONE] = "", read[INSTRUMENT_LAYER] = "";
    const struct instrument_request request = {
        layers[*data % 4], (enum instrument_columns)(*data / 20 % (COLUMNS_MAP + 1)), done, read};
    char *text = text_of(data + 1, size - 1);
    struct height_map map = {0};
    struct error err = {0};
    if (format->owns != NULL)
        (void)format->owns(text, size - 1);
    int status = format->read(&map, text, size - 1, &request, &err);
    MUST(status == 0 || (status == ERROR_INPUT && *err.text != 0 && map.z == NULL));
    if (status == 0) {
        MUST(grid_check(&map.grid, &err) == 0);
        MUST(grid_points(&map.grid) <= share * size);
        MUST(memchr(map.xy_unit, 0, sizeof map.xy_unit) != NULL);
        MUST(memchr(map.z_unit, 0, sizeof map.z_unit) != NULL);
        for (size_t point = 0; point < grid_points(&map.grid); point++)
            MUST(!isinf(map.z[point]));
    }
    height_map_clear(&map);
    free(text);
    return 0;
}

#endif
