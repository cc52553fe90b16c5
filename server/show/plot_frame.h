/* The axes of a plot in SVG: their ranges, places on the picture, ticks and labels. */
#ifndef RUGO_SERVER_SHOW_PLOT_FRAME_H
#define RUGO_SERVER_SHOW_PLOT_FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Curves are drawn in this area, in SVG user units. */
enum { FRAME_LEFT = 80, FRAME_RIGHT = 700, FRAME_TOP = 40, FRAME_BOTTOM = 500 };

struct plot_axis {
    double low, high;
    bool logarithmic;
};
struct frame {
    struct plot_axis x, y;
};
/* Start, include the n points that must be seen, finish: false when there is no point at all. */
void frame_start(struct frame *frame, bool x_logarithmic, bool y_logarithmic);
void frame_include(struct frame *frame, size_t n, const double *x, const double *y);
bool frame_finish(struct frame *frame);

/* Returns where a value stands on the picture. */
double frame_x(const struct frame *frame, double x);
double frame_y(const struct frame *frame, double y);
/* Returns whether a point has a place: two finite numbers, above 0 on logarithmic axes. */
bool frame_has_place(const struct frame *frame, double x, double y);

void frame_draw(FILE *file, const struct frame *frame, const char *x_label, const char *y_label);
/* Prints a text, in which what XML reserves is escaped. */
void svg_text(FILE *file, const char *text);

#endif
