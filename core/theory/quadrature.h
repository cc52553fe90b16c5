/* Gauss-Legendre quadrature: composite with 16 points a panel, for smooth integrands of known
 * support, and the 4-point rule, for means over the narrow bins of a histogram. */
#ifndef RUGO_CORE_THEORY_QUADRATURE_H
#define RUGO_CORE_THEORY_QUADRATURE_H

#include <stddef.h>

typedef double integrand(double s, const void *context);

/* Integrates f from low to high over equal panels; 0 when high <= low. */
double quadrature(integrand *f, const void *context, double low, double high, size_t panels);

/* Nodes, in rising order, and weights of one panel, for sums that share their nodes. */
enum { QUADRATURE_NODES = 16 };
void quadrature_panel(double low, double high, double node[QUADRATURE_NODES],
                      double weight[QUADRATURE_NODES]);

/* The 4-point rule on [-1, 1]: nodes in rising order, weights of sum 2. */
enum { GAUSS_4 = 4 };
extern const double GAUSS_4_NODES[GAUSS_4], GAUSS_4_WEIGHTS[GAUSS_4];

#endif
