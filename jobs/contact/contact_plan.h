/* What the components of a case that asks for an error still lack. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_PLAN_H
#define RUGO_JOBS_CONTACT_CONTACT_PLAN_H

#include "jobs/contact/contact_sum.h"

/* How many realisations each component is to have in all, by part (contact_sum_parts), and behind
 * these the longer cell, if there is one. First bounds are made as sharp as they become, by longer
 * cells and more realisations of what shows the order of levels; then chance is brought to what
 * they leave. sum: of the quantity whose error is asked for. */
int contact_plan(const struct contact_answer *answer, const struct contact_sum *sum,
                 uint64_t wanted[ROLES + 1], struct error *err);

#endif
