/* An SVG of one surface or profile, with its summits marked. */
#ifndef RUGO_SERVER_SHOW_PLOT_MAP_H
#define RUGO_SERVER_SHOW_PLOT_MAP_H

#include "core/surface/grid.h"
#include <stdio.h>

struct map_picture { /* borrows */
    const char *name, *subject;
    const char *x_label, *y_label, *z_label;
    const struct grid *grid; /* of a periodic cell */
    const double *z;         /* grid_points, without holes */
};
/* Draws a profile as its trace, a surface as colours of its heights; both with a mark at each
 * nine-point summit (of profiles: peak), at most 1000, the highest. Points are joined, of traces by
 * their extremes, of surfaces by their means, until the picture can show them. Write errors are
 * left to the file's own flag. */
int plot_map(const struct map_picture *picture, FILE *file, struct error *err);

#endif
