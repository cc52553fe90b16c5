/* What tells the two cases of a difference apart, in words. */
#ifndef RUGO_SCHEMA_RESULT_DIFFERENCE_PARAMETERS_H
#define RUGO_SCHEMA_RESULT_DIFFERENCE_PARAMETERS_H

#include "schema/result/result.h"

/* Returns "A less B", or what both are, in the result's arena; NULL without memory, or where both
 * are NULL. */
const char *difference_text(struct case_result *out, const char *a, const char *b);
/* Fills the parameters of the result: those of the first case, as "0.8 less 0.2" where the second
 * one has another value, and "0.8 less -" where it has none. */
int difference_parameters(const struct case_result *a, const struct case_result *b,
                          struct case_result *out, struct error *err);

#endif
