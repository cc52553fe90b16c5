/* What one map tells of the surface that it is a piece of: errors of its parameters, the
 * distribution of its heights, and whether it is alike in all directions and all over. */
#ifndef RUGO_SERVER_SHOW_CHARACTERISE_HEIGHTS_H
#define RUGO_SERVER_SHOW_CHARACTERISE_HEIGHTS_H

#include "core/statistics/summit_list.h"
#include "server/show/characterisation.h"

/* Puts errors behind the density and curvature of hills, which are those in the list. */
int characterise_hills(struct characterisation *out, const struct measured_map *map,
                       const struct map_chance *chance, const struct summit_list *hills,
                       struct error *err);
/* Puts errors behind the values of heights, slopes and curvatures that are there, and adds the
 * groups "uncertainty", "height_fit", "isotropy" and "stationarity". */
int characterise_chance(struct characterisation *out, const struct measured_map *map,
                        const struct map_chance *chance, struct error *err);
/* Adds the columns "scales", "isotropy_by_scale" and "angular_spectrum". */
int characterise_scales(struct characterisation *out, const struct measured_map *map,
                        const struct map_chance *chance, struct error *err);

#endif
