/* A mesh on which realisations are solved: the grid of their surface, sampled at other points. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_LEVEL_H
#define RUGO_JOBS_CONTACT_CONTACT_LEVEL_H

#include "jobs/surface/surface_case.h"

struct contact_level {
    double points; /* a shortest wave, as given */
    struct grid grid;
    size_t stride; /* every n-th point of the own grid along x and y; 0: resampled from its band */
};

/* Samples heights on the grid `own`, of waves up to `band`, on the grid of a level. */
int contact_level_sample(const struct contact_level *level, const struct grid *own,
                         struct surface_band band, const double *z, double *out, struct error *err);

#endif
