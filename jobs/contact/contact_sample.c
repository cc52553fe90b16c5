#include "jobs/contact/contact_sample.h"

int contact_sample(const struct grid *own, struct surface_band band,
                   const struct contact_level *level, const double *z, double *out,
                   struct error *err) {
    const struct grid *grid = &level->grid;
    if (level->stride == 0)
        return surface_resample(own, z, grid, out, band.x, band.y, err);
    for (size_t j = 0; j < grid->ny; j++) {
        const double *row = z + j * level->stride * own->nx;
        for (size_t i = 0; i < grid->nx; i++)
            out[j * grid->nx + i] = row[i * level->stride];
    }
    return 0;
}

int contact_level_sample(const struct contact_case *one_case, const struct contact_level *level,
                         const double *z, double *out, struct error *err) {
    return contact_sample(&one_case->surface.grid, one_case->band, level, z, out, err);
}
