/* The scalars of the quantities that a case asks for, over the realisations. */
#ifndef RUGO_JOBS_CONTACT_QUANTITY_QUANTITY_SCALARS_H
#define RUGO_JOBS_CONTACT_QUANTITY_QUANTITY_SCALARS_H

#include "jobs/contact/tally/contact_tally.h"
#include "schema/result/result.h"

/* Appends them, of the first model on its finest level, with their standard errors; those that no
 * realisation has are NaN. Errors by source are not known of them. */
int quantity_scalars(const struct contact_tally *tally, struct case_result *out, struct error *err);

#endif
