/* Fills the holes of a map with the smoothest membrane: heights that solve Laplace's equation in
 * the holes and equal the measured heights on their rims (FORMULAS.md, F18.20). */
#ifndef RUGO_CORE_MAP_MEMBRANE_H
#define RUGO_CORE_MAP_MEMBRANE_H

#include "core/statistics/measured_map.h"

/* Replaces NaN in z, which has at least one height; other heights stay bit for bit. The membrane of
 * an open map is free at the sides; that of a periodic one continues at the other side. Memory: 4
 * bytes a point and 140 to 240 a hole. Time: proportional to the holes, whose equations are solved
 * in 10 to 40 steps. ERROR_MEMORY, or ERROR_NUMERIC where the steps do not converge; z is unchanged
 * then. */
int membrane_fill(const struct grid *grid, double *z, enum boundary boundary, struct error *err);

#endif
