/* One surface of a case pressed once, to be looked at. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_PRESS_H
#define RUGO_JOBS_CONTACT_CONTACT_PRESS_H

#include "jobs/kind.h"

/* As job_kind's press: on the block of the first model without elements, or on a half-space where
 * all models have them. */
int contact_press_once(const struct realisation *realisation, double load, double *gap,
                       double *pressure, struct error *err);

#endif
