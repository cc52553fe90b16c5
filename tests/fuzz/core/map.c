/* Height maps out of files, the format by the first byte: what is read is written and read again as
 * the same heights. */
#include "core/file/memory_file.h"
#include "core/map/height_map_file.h"
#include "tests/support/fuzz/fuzz.h"

static void cross(const struct height_map *map, enum height_map_format format) {
    struct height_map again = {0};
    struct memory_file memory;
    struct error err = {0};
    size_t size = 0;
    MUST(memory_file_open(&memory));
    MUST(height_map_write(memory.file, format, &map->grid, map->z, &err) == 0);
    char *text = memory_file_close(&memory, &size);
    MUST(text != NULL);
    MUST(height_map_parse(&again, format, text, size, 1, &err) == 0);
    MUST(again.grid.nx == map->grid.nx && again.grid.ny == map->grid.ny);
    MUST(memcmp(map->z, again.z, grid_points(&map->grid) * sizeof *map->z) == 0);
    height_map_clear(&again);
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size == 0)
        return 0;
    enum height_map_format format = *data % HEIGHT_MAP_FORMATS;
    char *text = text_of(data + 1, size - 1);
    struct height_map map = {0};
    struct error err = {0};
    int status = height_map_parse(&map, format, text, size - 1, 1, &err);
    MUST(status == 0 || (status == ERROR_INPUT && *err.text != 0 && map.z == NULL));
    if (status == 0) {
        MUST(grid_check(&map.grid, &err) == 0);
        cross(&map, HEIGHT_MAP_NPY);
        cross(&map, HEIGHT_MAP_CSV);
    }
    height_map_clear(&map);
    free(text);
    return 0;
}
