#include "jobs/maps/map_planes.h"
#include "core/statistics/spectra/correlation.h"
#include "core/statistics/spectra/map_spectrum.h"
#include <math.h>
#include <stdlib.h>

void map_plane_clear(struct map_plane *plane) {
    free(plane->values);
    *plane = (struct map_plane){0};
}

/* Makes a plane of so many points on either side of the middle. */
static int plane_create(struct map_plane *out, size_t half_x, size_t half_y, double step_x,
                        double step_y, struct error *err) {
    size_t nx = 2 * half_x + 1, ny = 2 * half_y + 1;
    double *values = array_create(nx * ny, sizeof *values);
    if (values == NULL)
        return error_memory(err, nx * ny * sizeof *values, "a plane");
    *out = (struct map_plane){{nx, ny, (double)nx * step_x, half_y > 0 ? (double)ny * step_y : 1},
                              values};
    return 0;
}

/* Returns the mean square height about the mean. */
static double variance_of(const struct measured_map *map) {
    struct average mean = {0}, square = {0};
    size_t n = grid_points(map->grid);
    for (size_t a = 0; a < n; a++)
        average_add(&mean, map->z[a]);
    double middle = average_value(&mean);
    for (size_t a = 0; a < n; a++)
        average_add(&square, (map->z[a] - middle) * (map->z[a] - middle));
    return average_value(&square);
}

int map_acf_plane(struct map_plane *out, const struct measured_map *map, struct error *err) {
    const struct grid *grid = map->grid;
    struct correlation *correlation = NULL;
    size_t half_x = grid->nx / 2, half_y = grid_is_profile(grid) ? 0 : grid->ny / 2;
    double variance = variance_of(map);
    *out = (struct map_plane){0};
    int status = correlation_create(&correlation, map, err);
    if (status == 0)
        status =
            plane_create(out, half_x, half_y, grid_dx(grid), half_y > 0 ? grid_dy(grid) : 1, err);
    for (size_t j = 0; j < out->grid.ny && status == 0; j++)
        for (size_t i = 0; i < out->grid.nx; i++)
            out->values[j * out->grid.nx + i] =
                variance *
                correlation_at(correlation, (double)i - (double)half_x, (double)j - (double)half_y);
    correlation_destroy(&correlation);
    return status;
}

/* Returns the power of a wave of the full plane, of which modes have a half. */
static double power_at(const struct modes *modes, long mx, long my) {
    const struct grid *grid = &modes->grid;
    if (mx < 0) {
        mx = -mx;
        my = -my;
    }
    bool once = 2 * mx == (long)grid->nx; /* the two signs are one wave, whose power they share */
    long row = 2 * my == -(long)grid->ny ? -my : my;
    double power = modes_power(modes, (size_t)mx, row) / (once ? 2 : 1);
    return 2 * labs(my) == (long)grid->ny && !grid_is_profile(grid) ? power / 2 : power;
}

int map_psd_plane(struct map_plane *out, const struct measured_map *map, struct error *err) {
    struct map_spectrum *spectrum = NULL;
    *out = (struct map_plane){0};
    int status = map_spectrum_create(&spectrum, map, err);
    if (status != 0)
        return status;
    const struct modes *modes = &spectrum->modes;
    const struct grid *grid = &modes->grid;
    bool profile = grid_is_profile(grid);
    double step_x = 2 * M_PI / grid->lx, step_y = profile ? 1 : 2 * M_PI / grid->ly;
    long half_x = (long)modes->mode_x, half_y = (long)modes->mode_y;
    status = plane_create(out, (size_t)half_x, (size_t)half_y, step_x, step_y, err);
    for (long my = -half_y; my <= half_y && status == 0; my++)
        for (long mx = -half_x; mx <= half_x; mx++)
            out->values[(size_t)(my + half_y) * out->grid.nx + (size_t)(mx + half_x)] =
                power_at(modes, mx, my) / (step_x * step_y * spectrum->power);
    map_spectrum_destroy(&spectrum);
    return status;
}
