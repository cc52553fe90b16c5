/* What differences of contact cases by pairs of realisations are made of: the rows of the tally. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_PAIRS_H
#define RUGO_JOBS_CONTACT_CONTACT_PAIRS_H

#include "jobs/contact/contact_scalars.h"

/* As job_kind asks for them. */
bool contact_point_values(const struct contact_tally *tally, const struct curve *curve, size_t at,
                          struct point_values *out);
int contact_scalar_values(const struct contact_tally *tally,
                          const struct realisations *realisations, size_t scalar, double *values,
                          struct error *err);

#endif
