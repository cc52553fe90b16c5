/* Implements the height maps of rugo.h. */
#include "core/map/height_map_file.h"
#include "core/rugo_shared.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* Reads the bytes of a file and puts a NUL behind them; the caller frees them. */
static int read_file(const char *path, char **text, size_t *size, struct error *err) {
    FILE *file = fopen(path, "rb");
    char *bytes = NULL;
    long end = -1;
    if (file == NULL)
        return error_set(err, ERROR_SYSTEM, "%s", strerror(errno));
    int status = 0;
    if (fseek(file, 0, SEEK_END) != 0 || (end = ftell(file)) < 0 || fseek(file, 0, SEEK_SET) != 0)
        status = error_set(err, ERROR_SYSTEM, "%s", strerror(errno));
    else if ((bytes = array_create((size_t)end + 1, 1)) == NULL)
        status = error_memory(err, (size_t)end, "a file");
    else if (fread(bytes, 1, (size_t)end, file) != (size_t)end)
        status = error_set(err, ERROR_SYSTEM, "cannot read all of its %ld bytes", end);
    fclose(file);
    if (status == 0) {
        *text = bytes;
        *size = (size_t)end;
    } else
        free(bytes);
    return status;
}

static int format_of(const char *path, enum height_map_format *format, struct error *err) {
    *format = height_map_format_of(path);
    return *format != HEIGHT_MAP_FORMATS
               ? 0
               : error_set(err, ERROR_INPUT, "the name does not end in .npy, .csv or .xyz");
}

int rugo_map_read(struct rugo_map *out, const char *path, double dx, struct rugo_error *err) {
    struct error why = {0};
    enum height_map_format format;
    struct height_map map = {0};
    char *text = NULL;
    size_t size = 0;
    int status = format_of(path, &format, &why);
    if (status == 0)
        status = read_file(path, &text, &size, &why);
    if (status == 0)
        status = height_map_parse(&map, format, text, size, dx, &why);
    free(text);
    if (status == 0)
        status = height_map_check_whole(&map, &why);
    if (status != 0) {
        height_map_clear(&map);
        error_context(&why, "%s", path);
        return error_give(status, &why, err);
    }
    *out = (struct rugo_map){{map.grid.nx, map.grid.ny, map.grid.lx, map.grid.ly}, map.z};
    return 0;
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
    FILE *file = status == 0 ? fopen(path, "wb") : NULL;
    if (status == 0 && file == NULL)
        status = error_set(&why, ERROR_SYSTEM, "%s", strerror(errno));
    if (status == 0)
        status = height_map_write(file, format, &cell, z, &why);
    if (file != NULL && fclose(file) != 0 && status == 0)
        status = error_set(&why, ERROR_SYSTEM, "%s", strerror(errno));
    if (status != 0)
        error_context(&why, "%s", path);
    return error_give(status, &why, err);
}
