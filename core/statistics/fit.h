/* Fits of the contact fraction against the load, by GSL: least squares over n points (load > 0,
 * fraction), points whose fraction is out of the stated range left out. Each value has a standard
 * error from the scatter of the residuals; NaN for all where too few points are in range. */
#ifndef RUGO_CORE_STATISTICS_FIT_H
#define RUGO_CORE_STATISTICS_FIT_H

#include "core/error.h"

struct fit {
    double a, b;             /* parameters; b: power law alone */
    double error_a, error_b; /* standard errors */
    size_t points;           /* used */
};
/* fraction = a load over fractions in (0, 0.1]: a line through the origin, a is kappa. At least one
 * point; its error needs two. */
void fit_light_load(size_t n, const double *load, const double *fraction, struct fit *out);
/* fraction = a load^b over fractions in (0, 0.5], straight in logarithms. At least two points;
 * their errors need three. */
void fit_power_law(size_t n, const double *load, const double *fraction, struct fit *out);
/* fraction = erf(sqrt(pi)/2 a load) over fractions in (0, 1): a is its slope at the origin
 * (Persson: sqrt(8/pi)). Fails with ERROR_NUMERIC when it does not converge, ERROR_MEMORY. */
int fit_erf(size_t n, const double *load, const double *fraction, struct fit *out,
            struct error *err);

#endif
