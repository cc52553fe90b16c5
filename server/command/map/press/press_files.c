#include "server/command/map/press/press_files.h"
#include "core/file/written_file.h"
#include "server/command/map/map_output.h"
#include "server/command/output_file.h"
#include "server/show/map/map_png.h"
#include <stdlib.h>
#include <string.h>

int press_files_check(const struct press_paths *paths, struct error *err) {
    const char *const maps[] = {paths->pressures, paths->gap, paths->contact};
    const char *const others[] = {paths->face, paths->mesh, paths->nodes};
    static const char *const VTU[] = {".vtu", NULL};
    int status = mesh_file_check(paths->mesh, paths->nodes, err);
    if (status == 0 && paths->face != NULL)
        status = output_file_check_ending(paths->face, "--vtu", VTU, err);
    for (size_t f = 0; f < sizeof others / sizeof *others && status == 0; f++)
        if (others[f] != NULL)
            status = output_file_check(others[f], err);
    for (size_t f = 0; f < sizeof maps / sizeof *maps && status == 0; f++)
        if (maps[f] != NULL)
            status = map_output_check(maps[f], err);
    return status;
}

bool press_paths_ask(const struct press_paths *paths) {
    return paths->pressures != NULL || paths->gap != NULL || paths->contact != NULL ||
           paths->face != NULL || paths->mesh != NULL || paths->steps != NULL ||
           paths->nodes != NULL;
}

enum press_map { MAP_PRESSURE, MAP_GAP, MAP_CONTACT, MAP_COUNT };

/* Draws pressures blank where there is no contact, and gaps without what the solver leaves below
 * zero in contact. */
static int draw_values(const char *path, enum press_map which, const struct map_picture *labels,
                       const struct grid *grid, const double *values, struct error *err) {
    size_t points = grid_points(grid);
    double *drawn = array_create(points, sizeof *drawn);
    if (drawn == NULL)
        return error_memory(err, points * sizeof *drawn, "a picture");
    for (size_t n = 0; n < points; n++)
        drawn[n] = values[n] < 0 ? 0 : values[n];
    if (which == MAP_PRESSURE)
        map_blank_open(grid, drawn);
    int status = map_output_write(path, labels, grid, drawn, err);
    free(drawn);
    return status;
}

static int write_map(const char *path, enum press_map which, const struct press_units *units,
                     const struct grid *grid, const double *values, struct error *err) {
    static const char *const SUBJECTS[MAP_COUNT] = {"pressure", "gap", "contact"};
    const char *const names[MAP_COUNT] = {units->modulus ? "pressure p" : "pressure p/(E* h')",
                                          "gap", "contact (1) or none (0)"};
    const char *const z_units[MAP_COUNT] = {units->modulus ? "Pa" : "", units->height, ""};
    struct map_picture labels = {.name = SUBJECTS[which],
                                 .subject = "last load",
                                 .x_label = "x",
                                 .y_label = "y",
                                 .z_label = names[which],
                                 .xy_unit = units->length,
                                 .z_unit = z_units[which],
                                 .note = which == MAP_PRESSURE ? "blank: no contact" : NULL};
    if (which == MAP_CONTACT) {
        labels.classes[0] = "no contact";
        labels.classes[1] = "in contact";
    }
    return map_output_is_picture(path) ? draw_values(path, which, &labels, grid, values, err)
                                       : map_output_write(path, &labels, grid, values, err);
}

static int write_face(const char *path, const struct nodal_step *step, struct error *err) {
    struct nodal_step face = *step;
    struct written_file file;
    int status = written_file_open(&file, path, err);
    if (status != 0)
        return status;
    face.mesh = NULL; /* the surface, whatever the model */
    status = step_vtu(file.stream, &face, err);
    return written_file_close(&file, status, err);
}

/* Writes the files of the last load. */
static int write_last(const struct press_paths *paths, const struct nodal_step *step,
                      const struct press_units *units, struct error *err) {
    const char *const list[MAP_COUNT] = {paths->pressures, paths->gap, paths->contact};
    const double *const values[MAP_COUNT] = {step->p, step->gap, step->contact};
    int status = 0;
    for (enum press_map f = 0; f < MAP_COUNT && status == 0; f++)
        if (list[f] != NULL)
            status = write_map(list[f], f, units, &step->grid, values[f], err);
    if (status == 0 && paths->face != NULL)
        status = write_face(paths->face, step, err);
    return status;
}

int press_files_open(struct press_files *files, struct error *err) {
    files->mesh.path = files->paths->mesh;
    return step_folder_open(&files->folder, files->paths->steps, files->paths->nodes, err);
}

int press_files_write(struct press_files *files, const struct map_press *press, size_t load,
                      struct error *err) {
    const struct press_loads *loads = files->loads;
    const struct nodal_step *step = &files->step.step;
    if (!press_paths_ask(files->paths))
        return 0;
    int status = map_press_step(press, files->z, loads->value[load], loads->modulus,
                                files->units.length, &files->step, err);
    if (status == 0)
        status = step_folder_put(&files->folder, step, err);
    if (status != 0 || files->mesh.path == NULL)
        return status;
    /* A later load may have no values, and the solver's mesh is then no longer that of this one. */
    status = mesh_file_note(&files->mesh, step, loads->count, err);
    return status == 0 ? mesh_file_write(&files->mesh, step, err) : status;
}

int press_files_close(struct press_files *files, int status, struct error *err) {
    if (status == 0 && files->step.values != NULL)
        status = write_last(files->paths, &files->step.step, &files->units, err);
    status = step_folder_close(&files->folder, status, err);
    contact_step_clear(&files->step);
    mesh_file_clear(&files->mesh);
    return status;
}
