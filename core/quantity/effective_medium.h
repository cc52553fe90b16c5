/* The conductivity of a mixture in two dimensions, by the theory of an effective medium (Bruggeman
 * 1935): each part sits, as a disc, in a medium of the conductivity s_eff, which all together do
 * not disturb on average. */
#ifndef RUGO_CORE_QUANTITY_EFFECTIVE_MEDIUM_H
#define RUGO_CORE_QUANTITY_EFFECTIVE_MEDIUM_H

#include <stddef.h>

/* Returns s_eff with the sum over s[n], each >= 0, of (s - s_eff)/(s + s_eff) = 0, to a relative
 * 1e-12, with large contrasts their root times 1e-16; 0 where half of them or more are 0. */
double effective_medium(size_t n, const double *s);

#endif
