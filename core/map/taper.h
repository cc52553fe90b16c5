/* A map whose heights fall to one height towards its sides, so that it repeats (FORMULAS.md,
 * F18.23). */
#ifndef RUGO_CORE_MAP_TAPER_H
#define RUGO_CORE_MAP_TAPER_H

#include "core/surface/grid.h"

enum map_window { MAP_WINDOW_NONE, MAP_WINDOW_HANN, MAP_WINDOW_TUKEY };

/* Puts w (z - <w z>/<w>) in place of z, which has no holes; w is 1 in the middle. Returns the mean
 * square of w over the points. */
double map_taper(const struct grid *grid, double *z, enum map_window window);

#endif
