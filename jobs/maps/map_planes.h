/* The autocorrelation and the spectral density of a map over the plane, as maps themselves. */
#ifndef RUGO_JOBS_MAPS_MAP_PLANES_H
#define RUGO_JOBS_MAPS_MAP_PLANES_H

#include "core/statistics/measured_map.h"

/* Values over a grid of odd sides whose middle point is the lag 0 or the wave vector 0. */
struct map_plane {
    struct grid grid; /* lx, ly: of the points' spacing, in lengths or radians per length */
    double *values;   /* owned */
};

/* Makes R(tx, ty), the mean product of heights about their mean, at lags up to half of the sides
 * (FORMULAS.md, F18.8), NaN where no pair is there; ERROR_MEMORY. */
int map_acf_plane(struct map_plane *out, const struct measured_map *map, struct error *err);
/* Makes the density C(kx, ky), of which the integral over the plane is the mean square height; of
 * open maps under Hann's window (F18.12). ERROR_MEMORY, ERROR_INPUT for a map of holes alone, or a
 * periodic one with holes. */
int map_psd_plane(struct map_plane *out, const struct measured_map *map, struct error *err);
void map_plane_clear(struct map_plane *plane);

#endif
