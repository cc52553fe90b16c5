/* What the other law of heights that are not Gaussian would give (other_law.h): no error, since the
 * law is part of the question. */
#ifndef RUGO_JOBS_CONTACT_COMPANION_COMPANION_LAW_H
#define RUGO_JOBS_CONTACT_COMPANION_COMPANION_LAW_H

#include "jobs/contact/tally/contact_tally.h"

/* Estimates a measure of a model on the finest level under the other law less the measure, at every
 * load, into out[load_count]; NaN where it is not known. False, and nothing in out, for a measure
 * from MEASURE_PAIRED on and where it is not known at any load. */
bool companion_law_difference(const struct contact_tally *tally, enum contact_measure measure,
                              size_t model, struct estimate *out);

#endif
