/* A measured surface made into the parameters of random surfaces like it (FORMULAS.md, F18.27). */
#ifndef RUGO_JOBS_LIKE_FIT_H
#define RUGO_JOBS_LIKE_FIT_H

#include "core/map/detrend.h"
#include "core/map/height_map.h"
#include "jobs/like_parameters.h"
#include <cjson/cJSON.h>

/* What is known of the map, to be told beside the fit, and what of it is fitted. Borrowed. */
struct like_source {
    const char *file, *format, *prepared;
    const char *sha256; /* of the file, 64 digits */
    size_t bytes;
    enum detrend detrend; /* was taken out */
    enum like_spectrum spectrum;
    enum like_heights heights;
};

/* Writes into the object "surface" of a study the parameters of surfaces like the map, but for
 * those that it has, and in the place of its "like" the file's marks and what was measured of the
 * map. ERROR_INPUT: points that are not as far apart along x as along y, lengths along z in another
 * unit, too few heights, an unknown name. */
int like_fit(cJSON *surface, const struct height_map *map, const struct like_source *source,
             struct error *err);

#endif
