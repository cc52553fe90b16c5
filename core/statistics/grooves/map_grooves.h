/* Periodic grooves in a map, as machining leaves them: FORMULAS.md, F18.72 to F18.75 and
 * F18.79. */
#ifndef RUGO_CORE_STATISTICS_GROOVES_MAP_GROOVES_H
#define RUGO_CORE_STATISTICS_GROOVES_MAP_GROOVES_H

#include "core/statistics/grooves/groove_family.h"
#include "core/statistics/measured_map.h"

#define MAP_GROOVES_LEVEL 1e-3 /* of the test, of all waves of a map together */
enum { MAP_GROOVES_MOST = 2, MAP_GROOVES_PERIODS = 4 };

/* One family. Lengths are in the map's unit; errors are standard errors. */
struct map_groove {
    double period, period_error;
    double angle,
        angle_error;    /* from x to the grooves, radians in (-pi/2, pi/2]; of profiles NaN */
    double periods;     /* across the map */
    double p_value;     /* of such a line in a face without grooves */
    double mean_square; /* of its heights */
    struct groove_shape_fit fit;
    struct groove_lines lines;
};
struct map_grooves {
    size_t families; /* 0: none was found */
    struct map_groove family[MAP_GROOVES_MOST];
};

/* Seeks lines that a random face, with or without a lay, would not have. Grooves of less than
 * MAP_GROOVES_PERIODS periods across the map (profiles: twice as many) are not seen, nor any in a
 * map of fewer than 16 points along a side. Memory: eight maps. ERROR_MEMORY; ERROR_INPUT for a map
 * of holes alone, and for a periodic surface with holes where lines were found. */
int map_grooves_find(struct map_grooves *out, const struct measured_map *map, struct error *err);
/* Takes the mean profiles of all families out of heights on the grid of the map. */
void map_grooves_take(const struct map_grooves *grooves, const struct grid *grid, double *z);
/* Makes a copy of the heights without them, which the caller frees. ERROR_MEMORY. */
int map_grooves_rest(double **rest, const struct map_grooves *grooves, const struct grid *grid,
                     const double *z, struct error *err);

#endif
