/* What the values on the finest level owe to each source of error but the statistical one, point by
 * point, from differences of pairs: what is told less what is true lies within value +- bound. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_ERRORS_H
#define RUGO_JOBS_CONTACT_CONTACT_ERRORS_H

#include "jobs/contact/contact_error.h"
#include "jobs/contact/contact_tally.h"
#include "schema/result/result.h"

/* Of a measure below MEASURE_PAIRED, at every load, into out[load_count]; false, and nothing in
 * out, where the source is not known at all. */
bool contact_errors(const struct contact_tally *tally, enum contact_measure measure, size_t model,
                    enum error_source source, struct contact_error *out);
/* Whether the source bears on what is measured of contact with a model. */
bool contact_error_applies(const struct contact_tally *tally, enum contact_measure measure,
                           size_t model, size_t level, enum error_source source);

/* What the difference of a model from the most complete one changes from the coarsest level to the
 * limit of the levels, within value +- bound, at every load; false where there is no difference, or
 * one level. */
bool contact_errors_model_change(const struct contact_tally *tally, enum contact_measure measure,
                                 size_t model, struct contact_error *out);

/* The error of the mesh of the density of pressures at position `at` of pdf_loads, by bin: bounds
 * on both sides from the two finest levels, at least those of the two bins on either side, and
 * standard errors, as nodes fall into bins by chance. shares: of the finest level, by
 * contact_tally_pressure_shares; coarse: scratch. All have room for all bins; false where there is
 * one level. */
bool contact_errors_pressures(const struct contact_tally *tally, size_t model, size_t at,
                              const struct estimate *shares, struct estimate *coarse, double *bound,
                              double *standard_error);

#endif
