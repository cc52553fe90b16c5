/* Fits the parameters of random surfaces to a measured surface (FORMULAS.md, F18.27). */
#ifndef RUGO_JOBS_LIKE_LIKE_FIT_H
#define RUGO_JOBS_LIKE_LIKE_FIT_H

#include "core/map/height_map.h"
#include "core/map/preparation/detrend.h"
#include "jobs/like/like_parameters.h"
#include <cjson/cJSON.h>

/* The source of a map, which is reported beside the fit, and what of it is fitted. Borrowed. */
struct like_source {
    const char *file, *format, *prepared;
    const char *sha256; /* of the file, 64 digits */
    size_t bytes;
    enum detrend detrend; /* of the trend that was removed */
    enum like_spectrum spectrum;
    enum like_heights heights;
    enum like_uncertainty uncertainty;
    bool off_stated; /* surfaces whose RMS values are off by more than 5 % are made all the same */
    bool hold;       /* surfaces hold the map itself (like_hold.h) */
};

/* Writes the parameters of surfaces like the map into the object "surface" of a study, but for
 * those that it has. Replaces its "like" by the marks of the file and the measured values.
 * ERROR_INPUT: points with another spacing along x than along y, lengths along z in another unit,
 * too few heights, an unknown name. */
int like_fit(cJSON *surface, const struct height_map *map, const struct like_source *source,
             struct error *err);
/* Does so with several maps of one surface, 1 to JOINT_PATCHES_MOST, each with its source: one law
 * fits them together, and the heights are those of all (like_joint.h). What is fitted is said by
 * the first source; its map is the one that sub-maps of the surfaces are compared with. */
int like_fit_together(cJSON *surface, size_t count, const struct height_map *maps,
                      const struct like_source *sources, struct error *err);

#endif
