/* Turns a map, and exchanges its axes (FORMULAS.md, F18.33). */
#ifndef RUGO_CORE_MAP_MAP_TURN_H
#define RUGO_CORE_MAP_MAP_TURN_H

#include "core/map/height_map.h"

/* Exchanges x and y: the height at (x, y) goes to (y, x). ERROR_INPUT for profiles, ERROR_MEMORY;
 * the map is untouched then. */
int map_transpose(struct height_map *map, struct error *err);

/* Turns the map by so many right angles, counter-clockwise from x to y; heights stay bit for bit.
 * Errors as above; a profile can be turned by two. */
int map_turn_right(struct height_map *map, unsigned right_angles, struct error *err);

struct map_turn_result {
    double slope_change; /* RMS slope of what the last degree of the spline changes, over that of
                            the turned map; 0 of a level one */
};

/* Turns an open map by an angle (radians), counter-clockwise, about its middle. The new points lie
 * in the largest rectangle along the axes that the turned map holds, as far apart as the old ones
 * along the axis with the lesser spacing; heights are those of a spline of degree 7 through all of
 * the old ones (Unser, Aldroubi & Eden 1993). Points in a cell with a hole become holes. Memory:
 * three to four maps beside it, and what holes take to be filled (membrane.h). ERROR_INPUT for
 * profiles and for rectangles of fewer than 2 by 2 points, ERROR_MEMORY; the map is untouched
 * then. */
int map_turn(struct height_map *map, double angle, struct map_turn_result *out, struct error *err);

#endif
