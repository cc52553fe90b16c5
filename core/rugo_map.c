/* Implements the height maps of rugo.h. */
#include "core/file/whole_file.h"
#include "core/map/height_map_file.h"
#include "core/rugo_shared.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static int format_of(const char *path, enum height_map_format *format, struct error *err) {
    *format = height_map_format_of(path);
    return *format != HEIGHT_MAP_FORMATS
               ? 0
               : error_set(err, ERROR_INPUT, "the name does not end in .npy, .csv or .xyz");
}

static int read_map(struct height_map *map, const char *path, double dx, bool holes,
                    struct error *err) {
    enum height_map_format format;
    char *text = NULL;
    size_t size = 0;
    int status = format_of(path, &format, err);
    if (status != 0)
        return error_context(err, "%s", path);
    status = whole_file_read(path, SIZE_MAX / 4, &text, &size, err);
    if (status != 0) /* a file that is not there is one that could not be opened */
        return status == ERROR_MEMORY ? status : ERROR_SYSTEM;
    status = height_map_parse(map, format, text, size, dx, err);
    free(text);
    if (status == 0 && !holes)
        status = height_map_check_whole(map, err);
    if (status == 0)
        return 0;
    height_map_clear(map);
    return error_context(err, "%s", path);
}

static int give_map(struct rugo_map *out, const char *path, double dx, bool holes,
                    struct rugo_error *err) {
    struct error why = {0};
    struct height_map map = {0};
    int status = read_map(&map, path, dx, holes, &why);
    if (status == 0)
        *out = (struct rugo_map){{map.grid.nx, map.grid.ny, map.grid.lx, map.grid.ly}, map.z};
    return error_give(status, &why, err);
}

int rugo_map_read(struct rugo_map *out, const char *path, double dx, struct rugo_error *err) {
    return give_map(out, path, dx, false, err);
}

int rugo_open_map_read(struct rugo_map *out, const char *path, double dx, struct rugo_error *err) {
    return give_map(out, path, dx, true, err);
}

void rugo_map_clear(struct rugo_map *map) {
    if (map == NULL)
        return;
    free(map->z);
    *map = (struct rugo_map){.z = NULL};
}

int rugo_map_write(const char *path, const struct rugo_grid *grid, const double *z,
                   struct rugo_error *err) {
    struct error why = {0};
    enum height_map_format format;
    struct grid cell;
    int status = grid_take(&cell, grid, &why);
    if (status == 0)
        status = format_of(path, &format, &why);
    if (status == 0)
        status = height_map_save(path, format, &cell, z, &why);
    return error_give(status, &why, err);
}
