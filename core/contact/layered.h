/* The compliance of a mesh of linear finite elements whose columns are equal, wave by wave. */
#ifndef RUGO_CORE_CONTACT_LAYERED_H
#define RUGO_CORE_CONTACT_LAYERED_H

#include "core/contact/block.h"

/* Elasticity with E* = E/(1 - nu^2) = 1: shear modulus, and the parts of lambda that see the local
 * and the element's mean dilatation (layered.c says why). */
struct layered_material {
    double mu, local, mean;
};
struct layered_material layered_material(double poisson);

/* Fills length (S E*, laid out as in struct compliance) and the number of layers of a block that
 * was checked. ERROR_INPUT when it needs more than LAYERS_MOST layers; ERROR_MEMORY. */
int layered_lengths(const struct grid *grid, const struct block *block, double *length,
                    size_t *layers, struct error *err);

#endif
