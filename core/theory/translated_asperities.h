/* Theories of asperities by the summits of translated surfaces, z = f(g) (FORMULAS.md, F13.6).
 *
 * f maps heights and curvatures of the summits of g, whose densities are known (F6.12), and leaves
 * their elongations. Every summit is pressed alone, as in contact.h, to whose theories these reduce
 * where f is the identity. load = p/(E* h') with the RMS slope h' of z. */
#ifndef RUGO_CORE_THEORY_TRANSLATED_ASPERITIES_H
#define RUGO_CORE_THEORY_TRANSLATED_ASPERITIES_H

#include "core/error.h"
#include "core/theory/translated_summits.h"
#include <stddef.h>

/* bgt: elliptic summits with the joint density of height and curvatures. gw: spheres of the mean
 * curvature of all summits of z; their values of g have the mean and the variance of summits of g,
 * and a normal density, as in McCool (1986). */
enum translated_theory { TRANSLATED_GW, TRANSLATED_BGT };

struct translated_asperities;
/* surface: of dimension 2, isotropic, its field in the domain of nayak.h. Its heights are borrowed.
 * ERROR_MEMORY. */
int translated_asperities_create(struct translated_asperities **out,
                                 const struct translated_surface *surface,
                                 enum translated_theory theory, struct error *err);
void translated_asperities_destroy(struct translated_asperities **asperities);

/* Fills load and fraction at n separations, in sqrt(m0) of z from its mean plane. The fraction is
 * NaN where the theory has none: towards a bound of the heights summits flatten, and have an area
 * without limit if heights press against the bound (Weibull maxima of C near 1). */
void translated_asperities_curve(const struct translated_asperities *asperities, size_t n,
                                 const double *separation, double *load, double *area);
/* Returns the fraction at a load, 1e-15 to 1e6; NaN where there is none. */
double translated_asperities_area(const struct translated_asperities *asperities, double load);

#endif
