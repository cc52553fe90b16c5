/* The element of the full model: bilinear quadrilateral, trilinear hexahedron, 2 Gauss points a
 * direction, with a mean dilatation in place of the local one but for the part that the layered
 * model keeps:
 *
 *   energy = sum over Gauss points of weight x material's energy (material.h) + V (mean/2) e^2
 *
 *   hencky: e = ln theta, theta = v/V, its volume now and before
 *   st_venant: e the mean of tr E;  small: of tr e
 *
 * so that one pressure an element is bound when nu nears 1/2 (Simo, Taylor & Pister 1985), and
 * small strains on a flat block are those of layered.c. Where the strain is uniform the energy is
 * the material's with lambda = local + mean.
 *
 * Node a lies at side (a >> k) & 1 of axis k; the vertical axis is the last. */
#ifndef RUGO_CORE_FULL_ELEMENT_H
#define RUGO_CORE_FULL_ELEMENT_H

#include "core/full/material.h"

enum { ELEMENT_NODES = 8, ELEMENT_DEGREES_OF_FREEDOM = 24 };

struct element_shape {        /* of the reference */
    pointwise gradient[8][3]; /* [a][k][q]: dN_a/dX_k at Gauss point q */
    pointwise weight;         /* of Gauss points: volume */
    double volume;
};
/* Reference positions [a][k]. False when a Jacobian at a Gauss point is not positive. */
bool element_shape_make(int dimension, double position[8][3], struct element_shape *out);
/* Least over the corners of the Jacobian over its edges' lengths: 1 for a brick, 0 or less for an
 * element folded there. */
double element_quality(int dimension, double position[8][3]);

/* An element's pressure as an unknown p (E*, outward) of its own, bound by p = mean e in balance
 * alone. */
struct element_volumetric {
    double gradient[ELEMENT_DEGREES_OF_FREEDOM]; /* of V e by freedom: the forces of p = 1 */
    double stiffness;                            /* mean/V: pressure by V e */
    double bound;                                /* mean e */
};

/* Displacements u[a][k]; force and stiffness by freedom a*dimension + k. energy, force, stiffness,
 * volumetric: NULL where not wanted. pressure: NULL where it is bound; force and stiffness are
 * those of p otherwise, the latter with p eliminated: stiffness of volumetric times the dyad of its
 * gradient included. False when a Gauss point is turned inside out. */
bool element_evaluate(int dimension, const struct material *material,
                      const struct element_shape *shape, double u[8][3], const double *pressure,
                      double *energy, double *force,
                      double (*stiffness)[ELEMENT_DEGREES_OF_FREEDOM],
                      struct element_volumetric *volumetric);

#endif
