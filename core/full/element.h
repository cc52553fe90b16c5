/* The element of the full model: a bilinear quadrilateral or trilinear hexahedron with 2 Gauss
 * points along each axis. One part of lambda acts on the element's mean dilatation instead of the
 * local one (F14.3):
 *
 *   energy = sum over Gauss points of weight x energy of the material (material.h) + V (mean/2) e^2
 *
 *   hencky, neo_hooke: e = ln theta, theta = v/V, the element's deformed over undeformed volume
 *   st_venant: e is the mean of tr E;  small: of tr e
 *
 * so that only one pressure an element is constrained when nu tends to 1/2 (Simo, Taylor & Pister
 * 1985), and small strains of a flat block are those of core/contact/layered.c. Where the strain is
 * uniform the energy is the material's with lambda = local + mean.
 *
 * Node a lies at side (a >> k) & 1 of axis k; the vertical axis is the last. */
#ifndef RUGO_CORE_FULL_ELEMENT_H
#define RUGO_CORE_FULL_ELEMENT_H

#include "core/full/material.h"

enum { ELEMENT_NODES = 8, ELEMENT_DEGREES_OF_FREEDOM = 24 };

struct element_shape {        /* undeformed */
    pointwise gradient[8][3]; /* [a][k][q]: dN_a/dX_k at Gauss point q */
    pointwise weight;         /* by Gauss point: its volume */
    double volume;
};
/* Makes the shape of an element with undeformed positions [a][k]. Returns false when the Jacobian
 * at a Gauss point is not positive. */
bool element_shape_make(int dimension, double position[8][3], struct element_shape *out);
/* Returns the smallest value over the corners of the Jacobian over the product of its edges'
 * lengths: 1 for a brick, 0 or less for an element that is folded there. */
double element_quality(int dimension, double position[8][3]);

/* The part of the equations that belongs to an element's pressure p (E*, positive outward) where p
 * is an unknown of its own; in balance p = mean e. */
struct element_volumetric {
    double gradient[ELEMENT_DEGREES_OF_FREEDOM]; /* derivative of V e by the displacements, which is
                                                    the force of p = 1 */
    double stiffness;                            /* mean/V: derivative of the pressure by V e */
    double bound;                                /* mean e, the pressure in balance */
};

/* Computes energy, force and stiffness at displacements u[a][k]; force and stiffness are indexed by
 * a*dimension + k. Results that are not wanted may be NULL. pressure: NULL where p = mean e;
 * otherwise force and stiffness are those at this p, with p eliminated from the stiffness: it
 * contains volumetric->stiffness times the dyad of volumetric->gradient. Returns false when a Gauss
 * point is inverted. */
bool element_evaluate(int dimension, const struct material *material,
                      const struct element_shape *shape, double u[8][3], const double *pressure,
                      double *energy, double *force,
                      double (*stiffness)[ELEMENT_DEGREES_OF_FREEDOM],
                      struct element_volumetric *volumetric);

#endif
