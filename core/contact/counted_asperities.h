/* Theories of asperities by the counted summits of one surface (FORMULAS.md, F13.7). Where bgt and
 * gw_mccool of contact.h have the densities of Gaussian summits, these have the summits
 * themselves, of any surface: their heights and curvatures, each pressed alone. */
#ifndef RUGO_CORE_CONTACT_COUNTED_ASPERITIES_H
#define RUGO_CORE_CONTACT_COUNTED_ASPERITIES_H

#include "core/error.h"
#include "core/surface/grid.h"

/* gw: spheres of the mean curvature of all summits; bgt: elliptic summits, each with both of its
 * curvatures. */
enum counted_theory { COUNTED_GW, COUNTED_BGT, COUNTED_THEORIES };

struct counted_asperities;
/* For surfaces on this grid, which is no profile. open: they do not repeat, and no point of their
 * border is a summit. ERROR_MEMORY. */
int counted_asperities_create(struct counted_asperities **out, const struct grid *grid, bool open,
                              struct error *err);
void counted_asperities_destroy(struct counted_asperities **asperities);
double counted_asperities_bytes(const struct grid *grid);
/* Takes a surface z about its mean plane: counts its nine-point summits, with second differences as
 * curvatures. ERROR_MEMORY. */
int counted_asperities_take(struct counted_asperities *asperities, const double *z,
                            double rms_height, double rms_slope, struct error *err);
/* Returns the contact fraction at a load p/(E* h'), h' the RMS slope above. Asperities have no
 * bound: the fraction may exceed 1. NaN without summits. */
double counted_asperities_area(const struct counted_asperities *asperities,
                               enum counted_theory theory, double load);

#endif
