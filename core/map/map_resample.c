#include "core/map/map_resample.h"
#include "core/map/line_resampler.h"
#include "core/surface/surface.h"
#include <stdlib.h>

enum { LINES = 8 }; /* columns gathered together, of a cache line each */

/* Waves that both grids can show: of the coarser one without those of two points. */
static size_t common_waves(size_t from, size_t to) {
    return to >= from ? from / 2 : (to - 1) / 2;
}

static int resample_rows(const struct grid *from, const double *z, size_t nx, double step,
                         double *out, struct error *err) {
    struct line_resampler *resampler = NULL;
    int status = line_resampler_create(&resampler, from->nx, nx, step, err);
    for (size_t j = 0; j < from->ny && status == 0; j++)
        line_resampler_run(resampler, z + j * from->nx, out + j * nx);
    line_resampler_destroy(&resampler);
    return status == 0 ? 0 : error_context(err, "along x");
}

static int resample_columns(const double *z, size_t nx, size_t from, size_t to, double step,
                            double *out, struct error *err) {
    struct line_resampler *resampler = NULL;
    double *old = array_create(LINES * from, sizeof *old);
    double *new = array_create(LINES * to, sizeof *new);
    int status = old != NULL && new != NULL
                     ? line_resampler_create(&resampler, from, to, step, err)
                     : error_memory(err, LINES * (from + to) * sizeof *old, "new points");
    for (size_t i = 0; i < nx && status == 0; i += LINES) {
        const size_t lines = nx - i < LINES ? nx - i : LINES;
        for (size_t j = 0; j < from; j++)
            for (size_t l = 0; l < lines; l++)
                old[l * from + j] = z[j * nx + i + l];
        for (size_t l = 0; l < lines; l++)
            line_resampler_run(resampler, old + l * from, new + l *to);
        for (size_t j = 0; j < to; j++)
            for (size_t l = 0; l < lines; l++)
                out[j * nx + i + l] = new[l * to + j];
    }
    line_resampler_destroy(&resampler);
    free(old);
    free(new);
    return status == 0 ? 0 : error_context(err, "along y");
}

static int resample_open(const struct height_map *map, const struct grid *to, double *z,
                         struct error *err) {
    const struct grid *from = &map->grid;
    const double step_x = grid_dx(to) / grid_dx(from), step_y = grid_dy(to) / grid_dy(from);
    if (grid_is_profile(from))
        return resample_rows(from, map->z, to->nx, step_x, z, err);
    double *rows = array_create(to->nx * from->ny, sizeof *rows);
    if (rows == NULL)
        return error_memory(err, to->nx * from->ny * sizeof *rows, "new points");
    int status = resample_rows(from, map->z, to->nx, step_x, rows, err);
    if (status == 0)
        status = resample_columns(rows, to->nx, from->ny, to->ny, step_y, z, err);
    free(rows);
    return status;
}

int map_resample(struct height_map *map, enum boundary boundary, size_t nx, size_t ny, double dx,
                 double dy, struct error *err) {
    struct height_map new = {0};
    int status = height_map_shape(&new, ny, nx, 1, err);
    if (status != 0)
        return status;
    new.grid.lx = boundary == BOUNDARY_OPEN ? dx *(double)nx : map->grid.lx;
    new.grid.ly = boundary == BOUNDARY_OPEN ? dy *(double)ny : map->grid.ly;
    status = grid_check(&new.grid, err);
    if (status != 0)
        return status;
    new.z = array_create(grid_points(&new.grid), sizeof *new.z);
    if (new.z == NULL)
        return error_memory(err, grid_points(&new.grid) * sizeof *new.z, "new points");
    if (boundary == BOUNDARY_OPEN)
        status = resample_open(map, &new.grid, new.z, err);
    else
        status =
            surface_resample(&map->grid, map->z, &new.grid, new.z, common_waves(map->grid.nx, nx),
                             common_waves(map->grid.ny, ny), err);
    if (status == 0) {
        free(map->z);
        map->z = new.z;
        map->grid = new.grid;
    } else
        free(new.z);
    return status;
}
