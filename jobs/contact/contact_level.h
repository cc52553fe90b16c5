/* A mesh on which realisations are solved: the grid of their surface, sampled at other points. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_LEVEL_H
#define RUGO_JOBS_CONTACT_CONTACT_LEVEL_H

#include "jobs/surface/surface_case.h"

struct contact_level {
    double points; /* a shortest wave, as given */
    struct grid grid;
    size_t stride; /* every n-th point of the own grid along x and y; 0: resampled from its band */
};

/* The surface that is sampled: the RMS height of its random part, and the key of the realisation,
 * by which its grooves lie. */
struct level_source {
    double rms_height;
    struct random_key key;
};
/* Samples heights on the grid of a surface on the grid of a level. A surface that is translated is
 * so by its Gaussian field, of which the heights are a function. Grooves are those at the points of
 * the level. */
int contact_level_sample(const struct contact_level *level, const struct surface_case *surface,
                         const struct level_source *source, const double *z, double *out,
                         struct error *err);

#endif
