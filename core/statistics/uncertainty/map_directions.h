/* Whether a surface is alike in all directions: at two distances, and wave by wave. */
#ifndef RUGO_CORE_STATISTICS_UNCERTAINTY_MAP_DIRECTIONS_H
#define RUGO_CORE_STATISTICS_UNCERTAINTY_MAP_DIRECTIONS_H

#include "core/statistics/spectra/lay_fit.h"
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
/* Does so from the map alone, with what is known of its errors. ERROR_MEMORY, or what a correlation
 * fails with. */
int map_directions_find(struct map_directions *out, const struct measured_map *map,
                        const struct map_spectrum *spectrum, struct error *err);
/* Returns whether they differ, at a level of 0.01; where the map is too small for errors, whether
 * slopes do by a factor of more than 2. */
bool map_directions_differ(const struct map_directions *directions);
/* Finds the lay of a surface whose directions differ (at a level of 0.01; of maps too small for
 * errors by the spectrum alone), by its spectrum over circles; LAY_NONE where they do not, or where
 * it has none (lay_fit.h). *asked: the wavelengths that count. ERROR_INPUT where these leave no
 * wave; ERROR_MEMORY. */
int map_directions_lay(struct lay *out, const struct map_directions *directions,
                       const struct map_spectrum *spectrum,
                       const struct spectrum_fit_request *asked, struct error *err);

#endif
