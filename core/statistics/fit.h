/* Fits of the contact fraction against the load: least squares over the points (load > 0, fraction)
 * whose fraction is in the stated range; others, and points that are not finite, are left out. Each
 * value has a standard error from the scatter of the residuals, over the points less the
 * parameters: right for independent points of equal scatter. What too few points cannot give is
 * NaN. The functions fail with ERROR_MEMORY alone, and then leave `out` as it was. */
#ifndef RUGO_CORE_STATISTICS_FIT_H
#define RUGO_CORE_STATISTICS_FIT_H

#include "core/error.h"

struct fit {
    double a, b;             /* parameters; b: power law alone, else NaN */
    double error_a, error_b; /* standard errors */
    size_t points;           /* used */
};
/* fraction = a load over fractions in (0, 0.1]: a line through the origin, a is kappa. At least one
 * point; its error needs two. */
int fit_light_load(size_t n, const double *load, const double *fraction, struct fit *out,
                   struct error *err);
/* fraction = a load^b over fractions in (0, 0.5], straight in logarithms. At least two points;
 * their errors need three. */
int fit_power_law(size_t n, const double *load, const double *fraction, struct fit *out,
                  struct error *err);
/* fraction = erf(sqrt(pi)/2 a load) over fractions in (0, 1): a is its slope at the origin
 * (Persson: sqrt(8/pi)). At least one point; its error needs two. */
int fit_erf(size_t n, const double *load, const double *fraction, struct fit *out,
            struct error *err);
/* Returns the same slope, to rounding, by steps from one near it, such as that of all points but
 * the last; NaN where they do not end. All points are in the range. */
double fit_erf_near(size_t n, const double *load, const double *fraction, double near);

#endif
