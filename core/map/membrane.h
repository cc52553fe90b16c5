/* Holes of a map filled with the smoothest membrane: heights that solve Laplace's equation in the
 * holes, with the heights on their rims as they are (FORMULAS.md, F18.20). */
#ifndef RUGO_CORE_MAP_MEMBRANE_H
#define RUGO_CORE_MAP_MEMBRANE_H

#include "core/statistics/measured_map.h"

/* Puts heights in place of NaN in z, which has at least one height; others stay bit for bit. Of an
 * open map the membrane is free at the sides, of a periodic one it goes on at the other side.
 * Memory: 4 bytes a point and 140 to 240 a hole. Time: proportional to the holes, whose
 * equations are solved in 10 to 40 steps.
 * ERROR_MEMORY, or ERROR_NUMERIC where the steps do not converge; z is as it was then. */
int membrane_fill(const struct grid *grid, double *z, enum boundary boundary, struct error *err);

#endif
