/* What theories of asperities share, Gaussian (contact.h) or translated (translated_asperities.h):
 * elliptic summits, curves over the separation, and their inversion (FORMULAS.md, F13.3). */
#ifndef RUGO_CORE_THEORY_ASPERITIES_H
#define RUGO_CORE_THEORY_ASPERITIES_H

#include "core/theory/quadrature.h"
#include <stddef.h>

struct asperity_contact {
    double load, area; /* p/(E* h'), fraction */
};
/* separation: from the mean plane, in sqrt(m0); load and area fall as it grows. */
typedef struct asperity_contact asperity_contact_at(const void *theory, double separation);

/* Hertz's ellipse with the ratio exp(-theta) of its axes, theta >= 0: the elongation rho of the
 * summit, 1 - rho, drho/dtheta, and what the shape does to the area pi w/kappa_m and the load
 * (4/3) E* w^(3/2)/sqrt(kappa_m) of a sphere of its mean curvature. */
struct asperity_ellipse {
    double elongation, roundness, rate, area, load;
};
struct asperity_ellipse asperity_ellipse_at(double theta);

/* A rule over the elongation rho of summits, rising in rho^2; weights with (1 - rho^2) rho and with
 * what the shape does to the area and the load of Hertz's sphere. */
enum { ASPERITY_PANELS = 5, ASPERITY_SHAPES = ASPERITY_PANELS * QUADRATURE_NODES };
struct asperity_shapes {
    double square[ASPERITY_SHAPES], area[ASPERITY_SHAPES], load[ASPERITY_SHAPES];
};
void asperity_shapes_fill(struct asperity_shapes *shapes);
/* Returns the integrals over rho at the curvature s, each with exp(-s^2 rho^2/2). */
struct asperity_contact asperity_shapes_at(const struct asperity_shapes *shapes, double s);

/* Fills load and area at n separations; NaN where theory is NULL or a separation not finite. */
void asperity_curve(asperity_contact_at *at, const void *theory, size_t n, const double *separation,
                    double *load, double *area);
/* Returns the fraction at a load from 1e-250 to 1e6, whose logarithm is met but for `close`; NaN
 * where there is none, and when a few hundred bytes cannot be allocated. */
double asperity_area_at_load(asperity_contact_at *at, const void *theory, double load,
                             double close);

#endif
