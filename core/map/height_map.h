/* A height map: heights on a grid. */
#ifndef RUGO_CORE_MAP_HEIGHT_MAP_H
#define RUGO_CORE_MAP_HEIGHT_MAP_H

#include "core/surface/grid.h"

/* At most 2^31 points; at least 2 along x. */
struct height_map {
    struct grid grid; /* spacing from the file (xyz) or from dx */
    double *z;        /* owned, grid_points, in rows of rising y; NaN: a hole, not measured */
    /* Units of x and y, and of z: "m" where the file has a unit of length, and values are in metres
     * then; "" where it has none; otherwise the file's unit, for layers that hold no heights
     * ("V"). */
    char xy_unit[16], z_unit[16];
    /* z of a number of 1 in a text whose header has a unit or a scale of heights and no mark of
     * missing points; 0 elsewhere. */
    double z_of_one;
};
void height_map_clear(struct height_map *map);

/* Returns a sentence for people on units that are not known of x and y, of heights, or of both, and
 * on the options that say them; NULL where there is none. Static. */
const char *height_map_unit_note(const struct height_map *map);

/* Returns the number of holes. */
size_t height_map_holes(const struct height_map *map);
/* ERROR_INPUT, with the number of holes and the first of them, where there are any: for callers
 * that need all heights. */
int height_map_check_whole(const struct height_map *map, struct error *err);

/* The same of heights z[grid_points(grid)]. */
int heights_check_whole(const struct grid *grid, const double *z, struct error *err);

/* Checks the counts and sets the grid of a map with spacing dx. */
int height_map_shape(struct height_map *map, size_t ny, size_t nx, double dx, struct error *err);

/* Reverses the order of rows, of a file that has them from the top down. */
void height_map_reverse_rows(struct height_map *map);

/* Makes the map one of 2nx by 2ny points (a profile: 2nx). The mirrors are half a spacing beyond
 * the outermost points, so that the map is periodic without steps; the old map is in its first rows
 * and columns. ERROR_INPUT where that is more than a map may have, ERROR_MEMORY; the map is
 * untouched then. */
int height_map_mirror(struct height_map *map, struct error *err);

#endif
