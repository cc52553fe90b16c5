/* Several measured maps of one surface: their spectral densities beside each other, and the one law
 * that fits them together (FORMULAS.md, F18.48). */
#ifndef RUGO_JOBS_MAPS_MAP_TOGETHER_H
#define RUGO_JOBS_MAPS_MAP_TOGETHER_H

#include "core/map/height_map.h"
#include "core/statistics/grooves/map_grooves.h"
#include "core/statistics/spectra/joint_fit.h"

struct together_map {
    const char *file; /* borrowed */
    struct grid grid;
    struct map_grooves grooves;    /* taken out before the spectra */
    struct map_spectrum *spectrum; /* owned: over circles */
    struct map_spectrum *ellipses; /* owned: along the lay of all; NULL: there is none */
    struct lay lay;                /* of this map alone */
    struct spectrum_fit fit;       /* of this map alone */
};
/* Initialise with {0}. */
struct map_together {
    size_t count;
    struct together_map maps[JOINT_PATCHES_MOST];
    struct joint_patch patches[JOINT_PATCHES_MOST]; /* borrow from the maps */
    struct joint_fit fit;                           /* with a lay that of waves across it */
    struct lay lay; /* of all; LAY_NONE: directions of none differ */
    bool profile, in_metres;
};
/* Measures the spectrum of one more map, in the same unit and of the same dimension, without its
 * grooves, whose waves are in no law. ERROR_INPUT; ERROR_MEMORY. */
int map_together_add(struct map_together *together, const char *file, const struct height_map *map,
                     enum boundary boundary, struct error *err);
/* Fits all of them. Errors as of joint_fit_measure. */
int map_together_fit(struct map_together *together, struct error *err);
/* Returns the spectrum that is fitted. */
static inline const struct map_spectrum *together_map_rings(const struct together_map *map) {
    return map->ellipses != NULL ? map->ellipses : map->spectrum;
}
void map_together_clear(struct map_together *together);

#endif
