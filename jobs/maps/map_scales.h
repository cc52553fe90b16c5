/* How a map changes over each distance: heights, slopes, curvatures, with their errors, and of a
 * surface how alike its directions are there. */
#ifndef RUGO_JOBS_MAPS_MAP_SCALES_H
#define RUGO_JOBS_MAPS_MAP_SCALES_H

#include "core/statistics/heights/scales.h"
#include "core/statistics/uncertainty/isotropy.h"
#include "core/statistics/uncertainty/map_chance.h"

struct map_scales {
    size_t count;
    struct map_scale {
        struct scale found;
        double height_error, slope_error, curvature_error; /* standard; NaN: none is known */
        struct isotropy isotropy;                          /* of surfaces alone */
    } scale[SCALES_MOST];                                  /* the shortest first */
};
/* nearest: differences at a lag of one point. */
void map_scales_measure(struct map_scales *out, const struct measured_map *map,
                        const struct map_chance *chance, const struct cell_differences *nearest);

#endif
