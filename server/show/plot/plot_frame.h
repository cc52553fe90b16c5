/* The axes of a plot in SVG: their ranges, positions on the picture, ticks and labels. */
#ifndef RUGO_SERVER_SHOW_PLOT_PLOT_FRAME_H
#define RUGO_SERVER_SHOW_PLOT_PLOT_FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Curves are drawn in this area, in SVG user units, unless a picture has frames of its own. */
enum { FRAME_LEFT = 80, FRAME_RIGHT = 700, FRAME_TOP = 40, FRAME_BOTTOM = 500 };

struct plot_axis {
    double low, high;
    bool logarithmic;
    double plus; /* above 0: as log(plus + value), of values above -plus; not with logarithmic */
    size_t tick_count;   /* 0: ticks at round numbers */
    const double *ticks; /* borrowed: the only values with ticks */
    bool single;         /* of one value, which stands in the middle */
};
struct frame {
    struct plot_axis x, y;
    int left, top, right, bottom; /* FRAME_LEFT and so on, or those of a frame of its own */
    double scale;                 /* of letters and their distances; 1 on screens */
    bool without_x, without_y;    /* no numbers and label at this axis */
    bool opposite;                /* ticks and labels at the top and at the right */
    bool powers;                  /* logarithmic axes of many decades have numbers as 10^-5 */
};
/* Positions along a range shorter than this cannot be distinguished as numbers. */
#define RANGE_LEAST 1e-290
/* Returns whether a range has one value, or values that differ by rounding alone. */
bool range_is_single(double low, double high);
/* Makes such a range longer to both sides: by half of its value, by 1 where that is 0. Returns
 * whether it was one. */
bool range_widen(double *low, double *high);
/* Does so for an axis; a logarithmic one reaches to half and twice the value. */
void axis_widen_single(struct plot_axis *axis);
/* Start, include the n points that must be seen, finish: false when there is no point at all. */
void frame_start(struct frame *frame, bool x_logarithmic, bool y_logarithmic);
void frame_include(struct frame *frame, size_t n, const double *x, const double *y);
bool frame_finish(struct frame *frame);
void frame_include_point(struct frame *frame, double x, double y);
/* In place of all of these: linear axes between exactly these ends. same_lengths: the frame is
 * narrower or lower than others, so that a length of y is as long as one of x; up to this ratio of
 * its sides. Returns how many times as long it is: 1 but for sides of a larger ratio. */
#define FRAME_RATIO_MOST 8.0
double frame_set(struct frame *frame, const double x[2], const double y[2], bool same_lengths);
/* Writes what a picture says of a map with lengths of y so many times as long as those of x: "not
 * to scale: y stretched 5 times". Returns false where they are as long, to what is seen. */
bool frame_stretch_text(double stretched, char *text, size_t size);

/* Returns where a value stands on the picture. */
double frame_x(const struct frame *frame, double x);
double frame_y(const struct frame *frame, double y);
/* Returns whether a point can be drawn: two finite numbers, above 0 on logarithmic axes. */
bool frame_has_place(const struct frame *frame, double x, double y);

/* Returns how many digits a number needs to differ from one that is a step away; at least 4. */
int number_digits(double value, double step);
/* Returns the step of 1, 2 or 5 times a power of ten that divides a range into about `parts`. */
double round_step(double range, int parts);
/* Draws the frame with its ticks; labels (plot_words.h) are NULL for none. */
void frame_draw(FILE *file, const struct frame *frame, const char *x_label, const char *y_label);
/* Draws ticks, numbers and labels of second axes at the top and at the right of a frame, whose
 * numbers are those of x and y times these factors; 0: none. */
void frame_draw_second(FILE *file, const struct frame *frame, const double factors[2],
                       const char *x_label, const char *y_label);
/* Draws the label of an axis beside the frame. */
void frame_label(FILE *file, const struct frame *frame, bool horizontal, const char *label);

#endif
