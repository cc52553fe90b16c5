/* Richardson's extrapolation of a curve over mesh levels (FORMULAS.md, F15.3): with
 * f(h) = f_limit + c h^q, f on the finest level less the limit is factor * (f_next - f_finest),
 * factor = 1/(r^q - 1) and r = h_next/h_finest > 1.
 *
 * The order q is fitted to the three finest levels: the changes between the two coarser ones are a
 * multiple of those between the two finer ones at all points of the curve, and that multiple
 * depends on q alone. */
#ifndef RUGO_CORE_STATISTICS_RICHARDSON_H
#define RUGO_CORE_STATISTICS_RICHARDSON_H

/* Sums the least squares over the points of a curve; initialise with {0}. */
struct richardson_fit {
    double product, square;
};
/* Adds a point: fine is f_next - f_finest, coarse is f_third - f_next. Leaves it out where one of
 * them is not finite. */
void richardson_fit_add(struct richardson_fit *fit, double fine, double coarse);
/* Returns the multiple s that brings s * fine nearest to coarse; NaN where nothing changes. */
double richardson_fit_ratio(const struct richardson_fit *fit);

/* The order q whose changes have this ratio, held within 1 and 3: orders outside of these say that
 * the levels are too coarse to show one. fine is h_next/h_finest, coarse is h_third/h_next. */
double richardson_order(double ratio, double fine, double coarse);
/* Returns the factor above at an order; fine is h_next/h_finest. */
double richardson_factor(double order, double fine);

#endif
