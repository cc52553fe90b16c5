/* Where the panels and the legend of a picture stand. */
#ifndef RUGO_SERVER_SHOW_PLOT_PLOT_LAYOUT_H
#define RUGO_SERVER_SHOW_PLOT_PLOT_LAYOUT_H

#include "server/show/plot/plot_legend.h"

/* Widths of journals' columns, in millimetres. */
#define WIDTH_ONE 85.0
#define WIDTH_TWO 178.0
enum { WIDTH_LEAST = 40, WIDTH_MOST = 1000 };

struct plot_layout {
    struct pen_size size;
    double scale; /* of letters: 1 on screens */
    size_t panels, columns;
    int left, top; /* of the first panel */
    int panel_width, panel_height;
    int legend_left, legend_top, legend_width; /* width 0: a column at the right */
    bool second_x, second_y;                   /* there is room for axes at the top and the right */
};
/* Lays out so many panels, in rows of `columns` (0: as it suits), and a legend. out has second_x
 * and second_y; of several panels they are turned off. millimetres: the width on paper, whose
 * letters are those of print and where a narrow picture has its legend below; 0: for screens. */
void plot_lay_out(struct plot_layout *out, size_t panels, size_t columns,
                  const struct legend *legend, double millimetres);
/* Puts a frame, whose axes are set, in the place of a panel; only those at the left and at the
 * bottom have numbers. */
void plot_place(const struct plot_layout *layout, size_t panel, struct frame *frame);
/* Reads "one", "two", "85" or "85mm"; NULL: 0. ERROR_INPUT with what is allowed. */
int plot_width_read(const char *text, double *millimetres, struct error *err);

#endif
