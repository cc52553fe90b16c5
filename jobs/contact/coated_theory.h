/* Persson's theory of contact on a coated block (F22.5). */
#ifndef RUGO_JOBS_CONTACT_COATED_THEORY_H
#define RUGO_JOBS_CONTACT_COATED_THEORY_H

#include "core/surface/modes.h"
#include "jobs/contact/case/contact_case.h"

/* Returns what loads and pressures p/(E* h') are to be multiplied by, before they are those of a
 * block without a coating: the deviation of the pressure of full contact there, over that on the
 * coated block, which is as deep as a half-space. 1 without a coating. */
double coated_theory_factor(const struct contact_case *one_case, const struct modes *modes);

#endif
