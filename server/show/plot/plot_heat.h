/* Values over an area: cells coloured by level, contours, and the legend of the levels. */
#ifndef RUGO_SERVER_SHOW_PLOT_PLOT_HEAT_H
#define RUGO_SERVER_SHOW_PLOT_PLOT_HEAT_H

#include "server/show/plot/plot_pen.h"

/* Even cells that fill a rectangle of the frame. */
struct heat_cells {
    size_t nx, ny;
    double x[2], y[2];    /* ends of the rectangle */
    const double *values; /* borrowed: nx * ny, x fastest; NaN: none, without a colour */
};
enum { HEAT_LEVELS = 16, HEAT_COLOUR_SIZE = 8 };
enum heat_ramp { HEAT_DENSITY, HEAT_HEIGHT }; /* light to dark, dark to light */
struct heat_scale {
    size_t count;                   /* levels */
    double bounds[HEAT_LEVELS + 1]; /* level n: from bounds[n] on, below bounds[n + 1] */
    enum heat_ramp ramp;
};

/* About so many levels, 10 at most, at round numbers, which hold all values from low to high, low <
 * high. */
struct heat_scale heat_scale_between(double low, double high, int levels, enum heat_ramp ramp);
/* Levels of a density, highest > 0: at 1, 2 and 5 of each decade, from a fiftieth of it on; what is
 * less has no colour. */
struct heat_scale heat_scale_of_density(double highest);

/* Writes the colour at a position of a ramp, from 0 to 1. */
void heat_colour(enum heat_ramp ramp, double place, char out[HEAT_COLOUR_SIZE]);
/* Draws each cell in the colour of its level; the scale holds all values. */
void heat_draw(const struct plot_pen *pen, const struct heat_cells *cells,
               const struct heat_scale *scale);
/* Draws the lines at the bounds of the levels, between the centres of cells, straight in each. */
void heat_contours(const struct plot_pen *pen, const struct heat_cells *cells,
                   const struct heat_scale *scale, const char *style);
/* Writes the attributes of a stroke in the colour of a level, and what the level holds: "0.1 to
 * 0.2". */
enum { HEAT_STYLE_SIZE = 64, HEAT_LABEL_SIZE = 64 };
void heat_level(const struct heat_scale *scale, size_t level, char style[HEAT_STYLE_SIZE],
                char label[HEAT_LABEL_SIZE]);
/* Adds a row a level to the legend, the highest first, below a heading. */
void heat_legend(struct plot_pen *pen, const struct heat_scale *scale, const char *heading);

#endif
