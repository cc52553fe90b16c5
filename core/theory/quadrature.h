/* Composite Gauss-Legendre quadrature, 16 points a panel: for smooth integrands whose support is
 * known. */
#ifndef RUGO_CORE_THEORY_QUADRATURE_H
#define RUGO_CORE_THEORY_QUADRATURE_H

#include <stddef.h>

typedef double integrand(double s, const void *context);

/* Integral of f from low to high over equal panels; 0 when high <= low. */
double quadrature(integrand *f, const void *context, double low, double high, size_t panels);

/* One panel's rule, for sums that share their nodes: the nodes in rising order, their weights. */
enum { QUADRATURE_NODES = 16 };
void quadrature_panel(double low, double high, double node[QUADRATURE_NODES],
                      double weight[QUADRATURE_NODES]);

#endif
