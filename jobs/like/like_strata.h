/* Studies of stratified faces like a measured one: /surface has the law of its valleys, and
 * /surface/plateau that of its plateau (FORMULAS.md, F18.65). */
#ifndef RUGO_JOBS_LIKE_LIKE_STRATA_H
#define RUGO_JOBS_LIKE_LIKE_STRATA_H

#include "core/map/height_map.h"
#include "core/statistics/heights/plateau.h"
#include <cjson/cJSON.h>

enum { LIKE_STRATA_TEXT = 300 };
/* Writes both laws into the empty object "surface" of a study, on a cell of twice the sides of the
 * map, so that like_fit() finds spectrum and heights there, and what was fitted as words. heights:
 * the law of the map's heights. ERROR_INPUT as of strata_fit(); ERROR_MEMORY. */
int like_strata_put(cJSON *surface, const struct height_map *map, const struct plateau_law *heights,
                    char words[LIKE_STRATA_TEXT], struct error *err);

#endif
