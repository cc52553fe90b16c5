/* Functional parameters of one map: the material ratio curve of its heights and what follows from
 * it, ten-point heights of surfaces, widths of the elements of profiles. */
#ifndef RUGO_JOBS_MAPS_MAP_FUNCTIONAL_H
#define RUGO_JOBS_MAPS_MAP_FUNCTIONAL_H

#include "core/statistics/heights/functional.h"
#include "core/statistics/heights/plateau.h"
#include "core/statistics/uncertainty/functional_errors.h"

enum { MAP_RATIOS = 21 };

struct map_functional {
    struct functional found;
    double ratio[MAP_RATIOS], height[MAP_RATIOS]; /* the curve: rising shares, heights about the
                                                     mean that they reach */
    struct plateau_law plateau;                   /* NaN where there is none */
    bool has_errors;                              /* errors are known */
    struct functional_errors errors;
    struct ten_points ten_points;   /* of surfaces alone */
    struct profile_spacing spacing; /* of profiles alone */
};
/* hills: those of areal_measure(), with Sz; NULL for profiles. map_chance: of the map, NULL where
 * no errors are wanted. ERROR_MEMORY. */
int map_functional_measure(struct map_functional *out, const struct measured_map *map,
                           const struct summit_list *hills, double sz,
                           const struct map_chance *chance, struct error *err);
/* Fits the plateau law alone; all else is NaN, and there are no hills or elements. ERROR_MEMORY. */
int map_functional_measure_strata(struct map_functional *out, const struct measured_map *map,
                                  struct error *err);

#endif
