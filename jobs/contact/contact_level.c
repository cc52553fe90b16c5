#include "jobs/contact/contact_level.h"
#include <stdlib.h>
#include <string.h>

/* Samples z, or the Gaussian field, which replaces z. */
static int resample(const struct contact_level *level, const struct surface_case *surface,
                    const double *z, double *out, struct error *err) {
    const struct surface_band band = surface_case_sampled_band(surface);
    return surface_resample(&surface->grid, z, &level->grid, out, band.x, band.y, err);
}

static int resample_translated(const struct contact_level *level,
                               const struct surface_case *surface, double rms_height,
                               const double *z, double *out, struct error *err) {
    const struct height_function *function = translation_function(surface->translation);
    size_t points = grid_points(&surface->grid);
    double *gaussian = array_create(points, sizeof *gaussian);
    if (gaussian == NULL)
        return error_memory(err, points * sizeof *gaussian, "a Gaussian field");
    memcpy(gaussian, z, points * sizeof *gaussian);
    height_function_undo(function, rms_height, points, gaussian);
    int status = resample(level, surface, gaussian, out, err);
    if (status == 0)
        height_function_apply(function, rms_height, grid_points(&level->grid), out);
    free(gaussian);
    return status;
}

/* Grooves are no waves of the band: the random part alone is sampled. */
static int resample_grooved(const struct contact_level *level, const struct surface_case *surface,
                            const struct level_source *source, const double *z, double *out,
                            struct error *err) {
    const size_t points = grid_points(&surface->grid);
    double *rest = array_create(points, sizeof *rest);
    if (rest == NULL)
        return error_memory(err, points * sizeof *rest, "a surface without its grooves");
    memcpy(rest, z, points * sizeof *rest);
    grooves_add(surface->grooves, &surface->grid, source->key, -source->rms_height, rest);
    int status = resample(level, surface, rest, out, err);
    if (status == 0)
        grooves_add(surface->grooves, &level->grid, source->key, source->rms_height, out);
    free(rest);
    return status;
}

int contact_level_sample(const struct contact_level *level, const struct surface_case *surface,
                         const struct level_source *source, const double *z, double *out,
                         struct error *err) {
    const struct grid *grid = &level->grid;
    if (level->stride == 0 && surface->grooves != NULL)
        return resample_grooved(level, surface, source, z, out, err);
    if (level->stride == 0)
        return surface_case_translated(surface)
                   ? resample_translated(level, surface, source->rms_height, z, out, err)
                   : resample(level, surface, z, out, err);
    for (size_t j = 0; j < grid->ny; j++) {
        const double *row = z + j * level->stride * surface->grid.nx;
        for (size_t i = 0; i < grid->nx; i++)
            out[j * grid->nx + i] = row[i * level->stride];
    }
    return 0;
}
