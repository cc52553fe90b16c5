#include "server/command/map/map_output.h"
#include "core/file/file.h"
#include "core/map/height_map_file.h"
#include <string.h>

bool map_output_is_picture(const char *path) {
    return file_ends_in(path, ".png") || file_ends_in(path, ".svg");
}

int map_output_check(const char *path, struct error *err) {
    const char *slash = strrchr(path, '/'), *name = slash != NULL ? slash + 1 : path;
    if (strchr(name, '.') != NULL && !map_output_is_picture(path) &&
        height_map_format_of(path) == HEIGHT_MAP_FORMATS)
        return error_set(err, ERROR_INPUT,
                         "file %.200s: its name ends in none of .npy, .csv, .xyz, .png, .svg",
                         path);
    return output_file_check(path, err);
}

int map_output_write(const char *path, const struct map_picture *labels, const struct grid *grid,
                     const double *values, struct error *err) {
    enum height_map_format format = height_map_format_of(path);
    if (map_output_is_picture(path)) {
        struct map_picture picture = *labels;
        picture.grid = grid;
        picture.z = values;
        picture.boundary = BOUNDARY_OPEN;
        picture.unmarked = true;
        return output_file_picture(path, &picture, err);
    }
    return height_map_save_from(path, format == HEIGHT_MAP_FORMATS ? HEIGHT_MAP_NPY : format, grid,
                                (const double[]){labels->x0, labels->y0}, values, err);
}
