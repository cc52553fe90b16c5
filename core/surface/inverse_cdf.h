/* Quantiles of gamma and beta distributions, with all digits in both tails. The inverses of GSL
 * fail there for some shapes. */
#ifndef RUGO_CORE_SURFACE_INVERSE_CDF_H
#define RUGO_CORE_SURFACE_INVERSE_CDF_H

/* Return the value of which the probability `below` lies below and `above` above it; the smaller of
 * the two counts, and is at least 1e-300. */
double gamma_quantile_of(double shape, double below, double above);
double beta_quantile_of(double a, double b, double below, double above);

#endif
