/* Whether a surface is alike in all directions: at two distances, and wave by wave. */
#ifndef RUGO_JOBS_MAPS_MAP_DIRECTIONS_H
#define RUGO_JOBS_MAPS_MAP_DIRECTIONS_H

#include "core/statistics/uncertainty/isotropy.h"
#include "core/statistics/uncertainty/map_chance.h"

struct map_directions {
    struct isotropy fine;   /* of slopes from point to point */
    struct isotropy coarse; /* of those over the roughness that most of the height is of */
    double p_value;         /* of both together */
    double texture;         /* direction of the waves that have most height, radians (Std) */
    struct angular_spectrum angular;
};
/* Surfaces alone. spectrum: of the map; nearest: its differences at a lag of one point. */
void map_directions_measure(struct map_directions *out, const struct measured_map *map,
                            const struct map_chance *chance, const struct map_spectrum *spectrum,
                            const struct cell_differences *nearest);

#endif
