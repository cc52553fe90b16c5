#include "jobs/contact/contact_level.h"

int contact_level_sample(const struct contact_level *level, const struct grid *own,
                         struct surface_band band, const double *z, double *out,
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
