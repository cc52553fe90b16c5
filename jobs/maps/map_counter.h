/* A second measured map, as the face that the first is pressed on: the sum of both, and whether
 * they are as independent as two faces are. */
#ifndef RUGO_JOBS_MAPS_MAP_COUNTER_H
#define RUGO_JOBS_MAPS_MAP_COUNTER_H

#include "core/map/height_map.h"
#include <stdbool.h>

/* The correlation of heights of two maps, and the standard deviation that it has between
 * independent faces of their spectra (FORMULAS.md, F25.3 and F25.4). */
struct map_correlation {
    double value, deviation;
};
/* Returns whether a correlation is more than independent faces have: beyond three
 * standard deviations, or of heights that are the same. */
bool map_correlation_stands_out(const struct map_correlation *correlation);

struct map_counter {
    size_t nx, ny;                  /* points of both that were used */
    bool cropped;                   /* one of the maps had more */
    struct map_correlation facing;  /* of the faces as they are pressed */
    struct map_correlation as_held; /* of the maps as the files hold them, point on point */
};

/* Adds the heights of the second map to the first, both in the first of the points that they share.
 * Heights of both are outward, so that the second is turned over: about y, its columns run
 * backwards. periodic: both are pressed as such, and need the same points. counter is changed.
 * ERROR_INPUT where units or spacings differ, with the means to make them equal; ERROR_MEMORY. */
int map_counter_add(struct height_map *map, struct height_map *counter, bool periodic,
                    struct map_counter *out, struct error *err);

#endif
