/* The parameters of a map that need no spectrum: heights, slopes, curvatures, summits. */
#ifndef RUGO_JOBS_MAPS_MAP_PARAMETERS_H
#define RUGO_JOBS_MAPS_MAP_PARAMETERS_H

#include "core/statistics/heights/roughness.h"
#include "core/statistics/summits/summits.h"
#include "core/statistics/uncertainty/map_chance.h"
#include "core/statistics/uncertainty/scalar_errors.h"
#include "jobs/maps/map_extent.h"

enum { MAP_STENCILS = SUMMITS_REFINED + 1 };

/* Summits of a surface, or peaks of a profile; means are NaN without any. */
struct map_summits {
    bool sought;    /* profiles have no five-point peaks; the rest is 0 then */
    double count;   /* a whole number */
    double density; /* per area, of a profile per length; NaN where nothing could be searched */
    double height_mean, height_deviation, curvature_mean;
    bool has_errors;
    struct summit_errors errors;
};
struct map_parameters {
    struct grid grid;
    enum boundary boundary;
    struct roughness roughness; /* by finite differences */
    struct moments moments;     /* periodic: by the transform; open: by polynomials inside */
    double moments_share; /* of the points with both neighbours along each axis, those that an open
                             map's moments are over; 1 of a periodic one */
    struct map_summits summits[MAP_STENCILS];
};
/* Measures a map; one that is open may have holes. mode_x, mode_y bound the band of a periodic one
 * (nx/2, ny/2 where unknown). `map_chance` may be NULL: summits have no errors then. *out is
 * undefined after a failure: ERROR_MEMORY. */
int map_parameters_measure(struct map_parameters *out, const struct measured_map *map,
                           size_t mode_x, size_t mode_y, const struct map_chance *chance,
                           enum map_extent extent, struct error *err);
/* Replaces the contents of list by the summits of a map, and sets *searched to the area, of a
 * profile the length, where they were sought; modes as above. */
int map_summits_find(const struct measured_map *map, enum summit_stencil stencil, size_t mode_x,
                     size_t mode_y, struct summit_list *list, double *searched, struct error *err);

#endif
