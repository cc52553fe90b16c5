/* The compliance of a mesh of linear finite elements whose columns are equal, wave by wave. */
#ifndef RUGO_CORE_CONTACT_LAYERED_H
#define RUGO_CORE_CONTACT_LAYERED_H

#include "core/contact/compliance.h"

/* Elasticity with E* = E/(1 - nu^2) = 1: shear modulus, and the parts of lambda that see the local
 * and the element's mean dilatation (layered.c says why). */
struct layered_material {
    double mu, local, mean;
};
struct layered_material layered_material(double poisson);

/* Fills length and layers of a compliance whose block was checked. ERROR_INPUT when the block needs
 * more than LAYERS_MOST layers; ERROR_MEMORY. */
int layered_lengths(struct compliance *compliance, struct error *err);

#endif
