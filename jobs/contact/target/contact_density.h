/* The density of pressures of an answer: the sum over its components, bin by bin.
 *
 * Every bin is a telescoping sum as a measure is (contact_target.h), on the finest level in place
 * of the limit of the levels, which bins do not show; the error of that is a bound. All bins of a
 * change are scaled alike, as the area by edges is. So the integral is the area by edges on the
 * finest level, and as changes between densities of one load have no first moment, that of the sum
 * is the load. Bins of few realisations may come out below zero: such a value has no bias, and is
 * kept with its error. */
#ifndef RUGO_JOBS_CONTACT_TARGET_CONTACT_DENSITY_H
#define RUGO_JOBS_CONTACT_TARGET_CONTACT_DENSITY_H

#include "jobs/contact/target/contact_sum.h"

struct contact_density {
    struct contact_sum sum; /* points are bins */
    const double *x;        /* their centres; the result owns them */
    double below, above;    /* shares of the nominal area outside the bins */
};
/* Sums the density at position `at` of pdf_loads over the components, all of which have
 * realisations and but for the lengths count pairs. area: the sum of the area by edges, by load. */
int contact_density_create(const struct contact_answer *answer, const struct contact_sum *area,
                           size_t at, struct contact_density *out, struct error *err);

#endif
