/* The error of generation, from surfaces found in other ways (contact_generation.h). */
#ifndef RUGO_JOBS_CONTACT_CONTACT_GENERATION_ERRORS_H
#define RUGO_JOBS_CONTACT_CONTACT_GENERATION_ERRORS_H

#include "jobs/contact/contact_error.h"
#include "jobs/contact/contact_tally.h"

/* Of a measure of a model at every load, as contact_errors tells them. */
bool contact_generation_errors(const struct contact_tally *tally, enum contact_measure measure,
                               size_t model, struct contact_error *out);
/* Of the density of pressures at position `at` of pdf_loads, n bins of density y at x: at one load
 * pressures are as much higher in the mean as the area is smaller, so that a change of the area
 * stretches their density. False, and nothing in bound and standard_error (n each), where it is not
 * known; room: of the loads. */
bool contact_generation_pressures(const struct contact_tally *tally, size_t model, size_t at,
                                  const double *x, const double *y, struct contact_error *room,
                                  double *bound, double *standard_error);

#endif
