#include "jobs/contact/contact_level.h"
#include "core/statistics/grooves/groove_extension.h"
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

/* Adds the grooves of a realisation, or those of a held patch, `times` their heights. */
static int add_grooves(const struct surface_case *surface, const struct grid *grid,
                       const struct level_source *source, double times, double *z,
                       struct error *err) {
    const struct held_patch *held = surface->held;
    if (held != NULL && held->grooves != NULL)
        return groove_extension_add(held->grooves, &held->map.grid, grid, times, z, err);
    grooves_add(surface->grooves, grid, source->key, times * source->rms_height, z);
    return 0;
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
    int status = add_grooves(surface, &surface->grid, source, -1, rest, err);
    if (status == 0)
        status = resample(level, surface, rest, out, err);
    if (status == 0)
        status = add_grooves(surface, &level->grid, source, 1, out, err);
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
