/* An SVG of one surface or profile, with its summits marked, or of any other map. */
#ifndef RUGO_SERVER_SHOW_PLOT_PLOT_MAP_H
#define RUGO_SERVER_SHOW_PLOT_PLOT_MAP_H

#include "core/statistics/measured_map.h"
#include <stdio.h>

struct map_picture { /* borrows */
    const char *name, *subject;
    const char *x_label, *y_label, *z_label;
    const char *xy_unit, *z_unit; /* "m", "m^2", "rad/m" and "Pa" are drawn with the prefix that is
                                     read best, other units as they are; NULL or "": none */
    const char *note;             /* in the legend; NULL: none */
    const char *classes[2]; /* of a surface of 0 and 1: what these are; NULL: it has numbers */
    const struct grid *grid;
    double x0, y0;          /* of the first point */
    const double *z;        /* grid_points; NaN: a hole, of an open map */
    enum boundary boundary; /* periodic where nothing is said */
    bool unmarked;          /* no summits: the values may be those of anything */
    double trace;           /* of a surface: the row next to this y is drawn below; 0: none */
};
/* Draws a profile as its trace, a surface as colours of its heights, holes of either left blank;
 * both with a mark at each nine-point summit (of profiles: peak), at most 1000, the highest,
 * unless these are not wanted. Points
 * are joined, of traces by their extremes, of surfaces by their means, until the picture can show
 * them; of classes that of most points stands for all. Lengths of a surface are to scale, up to
 * sides of 1 to FRAME_RATIO_MOST. The legend says where means are shown, and where lengths are not
 * to scale. A row that is drawn below is marked by a line across the surface, and is as wide, if
 * that is not too narrow to read; that at y = 0 is asked for by the length along y. Write errors
 * are left to the file's own flag. */
int plot_map(const struct map_picture *picture, FILE *file, struct error *err);

/* Fills x and y, room for 2 groups + 1 each, with the trace of a profile: two points of each group
 * of neighbours, its lowest and highest, in their order, of one that has holes alone a hole; and
 * where the profile begins anew if it is periodic. Returns how many. */
size_t map_trace(const struct measured_map *map, size_t groups, double *x, double *y);
/* Fills out with means of what is there over squares of step by step points, fewer at the far
 * sides: ceil(nx / step) columns, ceil(ny / step) rows. */
void map_join_points(const struct measured_map *map, size_t step, double *out);

#endif
