/* Grooves of a map in a study of surfaces like it (FORMULAS.md, F18.80): the law is that of the map
 * without them, and /surface/grooves makes them. */
#ifndef RUGO_JOBS_LIKE_LIKE_GROOVES_H
#define RUGO_JOBS_LIKE_LIKE_GROOVES_H

#include "core/statistics/grooves/map_grooves.h"
#include <cjson/cJSON.h>

enum { LIKE_GROOVES_TEXT = 600 };
struct like_grooves {
    struct map_grooves found;      /* no families: there are none */
    double depth_error;            /* standard error of the depth, over it; of two the larger */
    char words[LIKE_GROOVES_TEXT]; /* what was found, and what is made */
};

struct like_grooves_of {
    const struct grid *map; /* of the heights */
    double wavelength;      /* lambda_s, in its unit */
    const char *unit;
    bool hold; /* surfaces hold the map, whose grooves go on */
};

/* Writes the found grooves into the object "surface" of a study whose spectrum, scale and cell are
 * there, with whole numbers of periods along its sides, and fills the rest of `grooves`.
 * ERROR_INPUT: two families that are one on the cell, or what surface_case_read() refuses;
 * ERROR_MEMORY. */
int like_grooves_put(cJSON *surface, struct like_grooves *grooves, const struct like_grooves_of *of,
                     struct error *err);

#endif
