/* The curves of a contact case. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_CURVES_H
#define RUGO_JOBS_CONTACT_CONTACT_CURVES_H

#include "jobs/contact/tally/contact_tally.h"
#include "schema/result/result.h"

/* Appends all curves to the result, whose arena owns them, those of one quantity together: the
 * first is the contact area of the first model on the finest level. modes, moments: of the
 * prescribed spectrum. */
int contact_curves(const struct contact_case *one_case, const struct modes *modes,
                   const struct moments *moments, const struct contact_tally *tally,
                   struct case_result *out, struct error *err);

#endif
