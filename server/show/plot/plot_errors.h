/* The errors of a line of a picture: bars at its points, or bands around it. */
#ifndef RUGO_SERVER_SHOW_PLOT_PLOT_ERRORS_H
#define RUGO_SERVER_SHOW_PLOT_PLOT_ERRORS_H

#include "server/show/plot/plot_legend.h"

/* What is drawn around a value: one standard error to either side, and further out and thinner the
 * total interval of 95 % (total.h), dashed where it leaves a source out. */
struct errors_drawn {
    bool bands; /* of curves of many points, and of differences; else bars */
    bool total;
    bool crowded; /* total intervals are left out: so many bands in a panel hide each other */
    double scale; /* of letters, with which bars grow on paper */
};
/* Chooses what of them is drawn; total: total intervals are wanted. */
void plot_errors_choose(struct errors_drawn *drawn, const struct plot_lines *lines, size_t panels,
                        bool bands, bool total);
/* Draws them on a frame, that of the pen, in the colour of the line. What reaches beyond the frame
 * ends at it. */
void plot_errors_draw(const struct plot_pen *pen, const struct curve *curve,
                      const struct errors_drawn *drawn, const char *colour);
/* Widens the y axis of a frame, whose points are all included, by what of the errors is drawn. It
 * takes one standard error whole, down to a decade below the points of a logarithmic axis, but
 * bands below zero only where points lie there. Total intervals widen it as far as they reach
 * (whole), or each end at most by half of what it reached before (bars on a linear axis: by all of
 * it), so that the lines stay large, and below zero only where points lie there. */
void plot_errors_include(struct frame *frame, const struct plot_lines *lines, size_t panels,
                         const struct errors_drawn *drawn, bool whole);
/* Adds what bars and bands are, and which sources they leave out. */
void plot_errors_note(struct legend *legend, const struct plot_lines *lines,
                      const struct errors_drawn *drawn);

#endif
