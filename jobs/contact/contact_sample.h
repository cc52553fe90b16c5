/* Surfaces of a case on the grid of one of its meshes. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_SAMPLE_H
#define RUGO_JOBS_CONTACT_CONTACT_SAMPLE_H

#include "jobs/contact/contact_case.h"

/* Heights on the grid `own`, of waves up to `band`, sampled on that of a level. */
int contact_sample(const struct grid *own, struct surface_band band,
                   const struct contact_level *level, const double *z, double *out,
                   struct error *err);
/* Heights on the own grid of the case, sampled on that of a level. */
int contact_level_sample(const struct contact_case *one_case, const struct contact_level *level,
                         const double *z, double *out, struct error *err);

#endif
