/* A height map with what is known of its surroundings: it repeats, or nothing is known of them. It
 * may have holes, where z is NaN. Statistics of such maps take what is there: a difference counts
 * where all its points have heights, a summit where all its neighbours do. */
#ifndef RUGO_CORE_STATISTICS_MEASURED_MAP_H
#define RUGO_CORE_STATISTICS_MEASURED_MAP_H

#include "core/sum.h"
#include "core/surface/grid.h"

enum boundary { BOUNDARY_PERIODIC, BOUNDARY_OPEN };

struct measured_map {
    const struct grid *grid; /* borrowed; of an open map lx is nx times the spacing, too */
    const double *z;         /* borrowed, grid_points */
    enum boundary boundary;
};

/* Returns the height of point i, j, at most one side outside of the map; NaN in holes, and outside
 * of an open map. */
static inline double map_height(const struct measured_map *map, long i, long j) {
    long nx = (long)map->grid->nx, ny = (long)map->grid->ny;
    bool inside = i >= 0 && i < nx && j >= 0 && j < ny;
    if (!inside && map->boundary == BOUNDARY_OPEN)
        return (double)NAN;
    i += i < 0 ? nx : i >= nx ? -nx : 0;
    j += j < 0 ? ny : j >= ny ? -ny : 0;
    return map->z[j * nx + i];
}

/* A mean over the values that are there. Initialise with {0}. */
struct average {
    struct sum total;
    size_t count;
};
static inline void average_add(struct average *average, double value) {
    if (isnan(value))
        return;
    sum_add(&average->total, value);
    average->count++;
}
/* Returns NaN where there was no value. */
static inline double average_value(const struct average *average) {
    return average->count > 0 ? sum_value(&average->total) / (double)average->count : (double)NAN;
}

/* Marks the points (whole[i] = 1, else 0) around which all heights from `before` points before to
 * `after` points behind, in each direction, are there; returns how many. */
size_t map_mark_whole(const struct measured_map *map, size_t before, size_t after,
                      unsigned char *whole);

#endif
