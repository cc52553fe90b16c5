#include "core/map/height_map_file.h"
#include "core/map/height_map_npy.h"
#include "core/map/height_map_text.h"
#include <errno.h>
#include <math.h>
#include <string.h>
#include <strings.h>

const char *const HEIGHT_MAP_NAMES[HEIGHT_MAP_FORMATS] = {"npy", "csv", "xyz"};

enum height_map_format height_map_format_of(const char *name) {
    const char *dot = strrchr(name, '.');
    enum height_map_format format = HEIGHT_MAP_NPY;
    while (format < HEIGHT_MAP_FORMATS &&
           (dot == NULL || strcasecmp(dot + 1, HEIGHT_MAP_NAMES[format]) != 0))
        format++;
    return format;
}

int height_map_parse(struct height_map *out, enum height_map_format format, const char *text,
                     size_t size, double dx, struct error *err) {
    struct height_map map = {0};
    int status = 0;
    dx = dx == 0 ? 1 : dx;
    if (!(dx > 0 && isfinite(dx)))
        return error_set(err, ERROR_INPUT, "the spacing of points must be above 0, not %g", dx);
    if (format == HEIGHT_MAP_NPY)
        status = height_map_npy_parse(&map, text, size, dx, err);
    else if (format == HEIGHT_MAP_CSV)
        status = height_map_csv_parse(&map, text, size, dx, err);
    else
        status = height_map_xyz_parse(&map, text, size, err);
    if (status != 0)
        height_map_clear(&map);
    else
        *out = map;
    return status;
}

int height_map_write(FILE *file, enum height_map_format format, const struct grid *grid,
                     const double *z, struct error *err) {
    errno = 0;
    if (format == HEIGHT_MAP_NPY)
        height_map_npy_write(file, grid, z);
    else if (format == HEIGHT_MAP_CSV)
        height_map_csv_write(file, grid, z);
    else
        height_map_xyz_write(file, grid, z);
    if (fflush(file) != 0 || ferror(file) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot write the surface: %s",
                         errno != 0 ? strerror(errno) : "the write failed");
    return 0;
}
