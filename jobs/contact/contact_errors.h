/* What a curve on the finest level owes to its mesh and to its model. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_ERRORS_H
#define RUGO_JOBS_CONTACT_CONTACT_ERRORS_H

#include "jobs/contact/contact_tally.h"

/* Richardson: with f = f_limit + C h^order on the two finest levels, finest minus limit is
 * factor * (next minus finest). */
struct contact_extrapolation {
    double order, factor;
    bool observed; /* order: fitted to the three finest levels; else assumed */
};
/* Extrapolates a paired measure of a model, which needs two levels. */
struct contact_extrapolation contact_extrapolate(const struct contact_tally *tally,
                                                 enum contact_measure measure, size_t model);

#endif
