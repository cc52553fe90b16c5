/* Slopes and curvatures of a map by differences over a lag, summed in the cells of low_modes.h. */
#ifndef RUGO_CORE_STATISTICS_CELL_DIFFERENCES_H
#define RUGO_CORE_STATISTICS_CELL_DIFFERENCES_H

#include "core/statistics/low_modes.h"

/* Sums over the points that have all the heights that these need; of profiles along x alone. */
struct cell_differences {
    double count[LOW_CELLS_MOST];
    /* (z[i+l] - z[i])^2 over the lag's square, along x and y together; those of second differences;
     * the square of the mean curvature, of profiles the same. */
    double slope[LOW_CELLS_MOST], bend[LOW_CELLS_MOST], curvature[LOW_CELLS_MOST];
    double area[LOW_CELLS_MOST]; /* sqrt(1 + slope^2) */
    /* g_x^2 + g_y^2, g_x^2 - g_y^2 and 2 g_x g_y of the gradient in a square of four points. */
    double gradient[LOW_CELLS_MOST], along[LOW_CELLS_MOST], across[LOW_CELLS_MOST];
};
/* lag in points along x, and as far along y, in whole points. Of long lags every (lag/4)th point is
 * taken along either axis. */
void cell_differences_measure(const struct measured_map *map, const struct low_modes *modes,
                              size_t lag, struct cell_differences *out);

#endif
