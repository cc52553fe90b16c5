/* The heights of a map counted and summed in the cells of low_modes.h. */
#ifndef RUGO_CORE_STATISTICS_UNCERTAINTY_CELL_HEIGHTS_H
#define RUGO_CORE_STATISTICS_UNCERTAINTY_CELL_HEIGHTS_H

#include "core/statistics/uncertainty/low_modes.h"

/* Slopes and curvatures of a map by differences over a lag, summed in the cells of low_modes.h. */

/* Sums over the points that have all the heights that these need; of profiles along x alone. */
struct cell_differences {
    double count[LOW_CELLS_MOST];
    /* (z[i+l] - z[i])^2 over the lag's square, along x and y together; those of second differences;
     * the square of the mean curvature, of profiles the same. */
    double slope[LOW_CELLS_MOST], bend[LOW_CELLS_MOST], curvature[LOW_CELLS_MOST];
    double area[LOW_CELLS_MOST]; /* sqrt(1 + slope^2) */
    /* Of all squares of four points a lag apart, in the cells of their middles: how many, and
     * g_x^2 + g_y^2, g_x^2 - g_y^2 and 2 g_x g_y of their gradients. All together are the same of
     * the map turned by two right angles. */
    double squares[LOW_CELLS_MOST];
    double gradient[LOW_CELLS_MOST], along[LOW_CELLS_MOST], across[LOW_CELLS_MOST];
};
/* lag in points along x, and as far along y, in whole points. Of long lags every (lag/4)th point is
 * taken along either axis, but for squares. */
void cell_differences_measure(const struct measured_map *map, const struct low_modes *modes,
                              size_t lag, struct cell_differences *out);

enum { HEIGHT_LEVELS = 127 }; /* between bins that hold about as many heights each */

struct cell_heights {
    size_t cells;
    double count;     /* of heights */
    double mean, rms; /* RMS about the mean; 0: a flat map */
    bool untilted;    /* no tilt of least squares is in them, as where it was taken out */
    size_t levels;    /* at most HEIGHT_LEVELS; fewer where heights take few values */
    /* Rising; each lies midway between two heights. */
    double level[HEIGHT_LEVELS];
    double share[HEIGHT_LEVELS]; /* of heights below */
    double *below;               /* owned; [cell*levels + l]: how many heights are below level l */
    double *power[5];            /* owned by power[0]; power[p][cell]: sum of the p-th powers of
                                    heights about the mean */
    double *size;                /* owned by power[0]; sum of their absolute values */
};
/* Fills in for the cells of modes, of which only the lattice is used. ERROR_MEMORY, and ERROR_INPUT
 * for a map of holes alone. */
int cell_heights_create(struct cell_heights **out, const struct measured_map *map,
                        const struct low_modes *modes, struct error *err);
void cell_heights_destroy(struct cell_heights **heights);

#endif
