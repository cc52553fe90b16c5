/* Whether a surface is alike in all directions: by the mean products of its slopes at a scale. */
#ifndef RUGO_CORE_STATISTICS_ISOTROPY_H
#define RUGO_CORE_STATISTICS_ISOTROPY_H

#include "core/statistics/cell_differences.h"

/* FORMULAS.md, F18.18; errors and p_value NaN where the map is too small to tell them, all NaN
 * for a flat one. */
struct isotropy {
    double length;     /* of the differences */
    double anisotropy; /* (a - b)/(a + b) of the mean square slopes across and along, a >= b; 0 of
                          isotropic surfaces, 1 of grooves */
    double ratio;      /* sqrt(a/b) */
    double direction;  /* of the steepest slopes, from x to y, radians in (-pi/2, pi/2]; grooves
                          run at right angles to it */
    double anisotropy_error, ratio_error, direction_error; /* standard errors */
    double p_value; /* of an isotropic surface to have as much anisotropy */
};
/* excess: by low_modes_excess_slopes; NaN where errors cannot be told. Surfaces alone. */
void isotropy_measure(const struct cell_differences *differences, double length,
                      const struct low_modes *modes, double excess, struct isotropy *out);
/* Returns the p-value of the least of n independent ones. */
double least_p_value(const double *p_values, size_t n);

#endif
