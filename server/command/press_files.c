#include "server/command/press_files.h"
#include "core/map/height_map_file.h"
#include "server/command/output_file.h"
#include "server/show/map_vtu.h"
#include <stdlib.h>
#include <string.h>

/* The fields over the map as it was measured, the first of its mirror images. */
enum field { FIELD_HEIGHT, FIELD_PRESSURE, FIELD_GAP, FIELD_CONTACT, FIELDS };
struct fields {
    const struct press *press;
    const double *z;
    double unit;    /* of pressures, over E* */
    double *values; /* scratch: FIELDS maps, one after the other */
};

static void fill(struct fields *fields) {
    const struct press *press = fields->press;
    const struct contact_state *state = &press->state;
    size_t n = grid_points(&press->map), nx = press->map.nx;
    for (size_t j = 0; j < press->map.ny; j++)
        for (size_t i = 0; i < nx; i++) {
            size_t from = j * press->grid.nx + i, to = j * nx + i;
            fields->values[FIELD_HEIGHT * n + to] = fields->z[from];
            fields->values[FIELD_PRESSURE * n + to] = state->p[from] * fields->unit;
            fields->values[FIELD_GAP * n + to] = state->gap[from];
            fields->values[FIELD_CONTACT * n + to] = state->p[from] > 0 ? 1 : 0;
        }
}

static bool ends_with(const char *path, const char *ending) {
    size_t length = strlen(path), tail = strlen(ending);
    return length > tail && strcmp(path + length - tail, ending) == 0;
}

static bool is_picture(const char *path) {
    return ends_with(path, ".png") || ends_with(path, ".svg");
}

static int check_map(const char *path, struct error *err) {
    const char *slash = strrchr(path, '/'), *name = slash != NULL ? slash + 1 : path;
    if (strchr(name, '.') != NULL && !is_picture(path) &&
        height_map_format_of(path) == HEIGHT_MAP_FORMATS)
        return error_set(err, ERROR_INPUT,
                         "file %.200s: its name ends in none of .npy, .csv, .xyz, .png, .svg",
                         path);
    return output_file_check(path, err);
}

int press_files_check(const struct press_paths *paths, struct error *err) {
    const char *const maps[] = {paths->pressures, paths->gap, paths->contact};
    int status = paths->mesh != NULL ? output_file_check(paths->mesh, err) : 0;
    for (size_t f = 0; f < sizeof maps / sizeof *maps && status == 0; f++)
        if (maps[f] != NULL)
            status = check_map(maps[f], err);
    return status;
}

static int write_map(const char *path, const char *name, const struct grid *grid,
                     const double *values, struct error *err) {
    enum height_map_format format = height_map_format_of(path);
    FILE *file;
    if (is_picture(path)) {
        const struct map_picture picture = {.name = name,
                                            .subject = "",
                                            .x_label = "x",
                                            .y_label = "y",
                                            .z_label = name,
                                            .grid = grid,
                                            .z = values,
                                            .boundary = BOUNDARY_OPEN,
                                            .unmarked = true};
        return output_file_picture(path, &picture, err);
    }
    int status = output_file_open(&file, path, err);
    if (status != 0)
        return status;
    status = height_map_write(file, format == HEIGHT_MAP_FORMATS ? HEIGHT_MAP_NPY : format, grid,
                              values, err);
    return output_file_close(file, path, status, err);
}

static int write_mesh(const char *path, const struct fields *fields, const char *unit_name,
                      struct error *err) {
    const struct grid *grid = &fields->press->map;
    size_t n = grid_points(grid);
    char title[120];
    FILE *file;
    const struct map_field list[] = {{"pressure", fields->values + FIELD_PRESSURE * n},
                                     {"gap", fields->values + FIELD_GAP * n},
                                     {"contact", fields->values + FIELD_CONTACT * n}};
    int status = output_file_open(&file, path, err);
    if (status != 0)
        return status;
    snprintf(title, sizeof title, "A pressed map: pressure in %s, lengths as in the map",
             unit_name);
    status = map_vtu(file, title, grid, fields->values, sizeof list / sizeof *list, list, err);
    return output_file_close(file, path, status, err);
}

int press_files_write(const struct press_paths *paths, const struct press *press, const double *z,
                      double unit, const char *unit_name, struct error *err) {
    const struct grid *grid = &press->map;
    size_t n = grid_points(grid);
    const char *const list[FIELDS] = {NULL, paths->pressures, paths->gap, paths->contact};
    char pressure[40];
    const char *const names[FIELDS] = {"z", pressure, "gap", "contact"};
    if (paths->pressures == NULL && paths->gap == NULL && paths->contact == NULL &&
        paths->mesh == NULL)
        return 0;
    struct fields fields = {press, z, unit / press->slope,
                            array_create(FIELDS * n, sizeof(double))};
    if (fields.values == NULL)
        return error_memory(err, FIELDS * n * sizeof(double), "fields of contact");
    fill(&fields);
    snprintf(pressure, sizeof pressure, "pressure, %s", unit_name);
    int status = 0;
    for (size_t f = FIELD_PRESSURE; f < FIELDS && status == 0; f++)
        if (list[f] != NULL)
            status = write_map(list[f], names[f], grid, fields.values + f * n, err);
    if (status == 0 && paths->mesh != NULL)
        status = write_mesh(paths->mesh, &fields, unit_name, err);
    free(fields.values);
    return status;
}
