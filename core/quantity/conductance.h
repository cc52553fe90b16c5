/* The conductance of a contact for current or heat, between two half-spaces that touch in a given
 * set of nodes and nowhere else.
 *
 * Barber (2003, Proc. R. Soc. A 459, 53): an area of nominal contact conducts
 * G = 2 S/(E* (rho1 + rho2)), where S = d pressure/d approach is the elastic stiffness by area of
 * the same contact set, held, and rho the resistivities of both bodies. A single circle of radius a
 * has S = 2 E* a by force, and Holm's conductance 4 a/(rho1 + rho2). The set may be of any model of
 * contact; what conducts are half-spaces. A set of nodes is that of the bodies to first order in
 * the spacing. */
#ifndef RUGO_CORE_QUANTITY_CONDUCTANCE_H
#define RUGO_CORE_QUANTITY_CONDUCTANCE_H

#include "core/surface/grid.h"

struct conductance;

/* Of a periodic cell, or where open of a rectangle in free space. Residuals of a solution are a
 * thousandth of its potential, and the value is an energy, so that its error is below 1e-5. One
 * thread at a time. ERROR_MEMORY; ERROR_INPUT as compliance_create. */
int conductance_create(struct conductance **out, const struct grid *grid, bool open,
                       struct error *err);
void conductance_destroy(struct conductance **conductance);
double conductance_bytes(const struct grid *grid, bool open);

/* Returns G (rho1 + rho2)/2 by nominal area, which is S/E*, over the grid's length. p[grid_points]:
 * above 0 in contact; values near the pressures of a solution save iterations. 0 without contact,
 * INFINITY where all nodes of a periodic cell touch. */
double conductance_measure(struct conductance *conductance, const double *p);

#endif
