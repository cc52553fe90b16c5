/* Gaussian means of a map's heights along rows and columns. Private to gaussian_filter.c. */
#ifndef RUGO_CORE_MAP_SMOOTHER_H
#define RUGO_CORE_MAP_SMOOTHER_H

#include "core/statistics/measured_map.h"

struct smoother;

/* A Gaussian that takes half of the amplitude of waves as long as the cut-off. Of an open map it is
 * a kernel of weights, with sum 1 and cut off where they are below 1e-14 of the largest; of a
 * periodic one the product of its waves. ERROR_INPUT where points are too far apart for that. */
int smoother_create(struct smoother **out, const struct grid *grid, double cut_off,
                    enum boundary boundary, struct error *err);
void smoother_destroy(struct smoother **smoother);

/* Replaces a field on the grid by its Gaussian sums; beyond the sides of an open map it is 0. */
void smoother_run(struct smoother *smoother, double *field);
/* Fills x[nx] and y[ny] with the sums of a field that is 1 on the map, of which each point has the
 * product. */
void smoother_reach(struct smoother *smoother, double *x, double *y);
/* Returns what is left of waves as long as the cut-off along the axis with fewer points a wave. */
double smoother_transmission(const struct smoother *smoother);

#endif
