/* The legend of a picture of lines: what each colour, dash and mark stands for, named once. */
#ifndef RUGO_SERVER_SHOW_PLOT_PLOT_LEGEND_H
#define RUGO_SERVER_SHOW_PLOT_PLOT_LEGEND_H

#include "server/show/plot/plot_lines.h"

enum { LEGEND_ROWS_MOST = 48, LEGEND_STYLE_SIZE = 160, COLOUR_SIZE = 8 };

struct legend_row {
    char label[PLOT_LABEL_SIZE];   /* for svg_label */
    char style[LEGEND_STYLE_SIZE]; /* attributes of the stroke; "": a note */
    char colour[COLOUR_SIZE];      /* of its mark */
    int mark;                      /* drawn upon the stroke; -1: none */
};
struct legend {
    size_t count;
    struct legend_row rows[LEGEND_ROWS_MOST];
};
/* Adds a row; what is more than LEGEND_ROWS_MOST is left out. */
struct legend_row *legend_add(struct legend *legend, const char *label, const char *style);
/* The width of the widest row, and how high the legend is in a width (a column where 0), in SVG
 * user units at a scale of letters. */
int legend_width(const struct legend *legend, double scale);
int legend_height(const struct legend *legend, double scale, int width);
/* Draws it from its upper left corner: a column, or rows filled from the left where width > 0. */
void legend_draw(const struct legend *legend, FILE *file, double scale, int left, int top,
                 int width);

/* Draws a mark: circle, square, triangle, diamond; filled at first, then open. */
void mark_draw(FILE *file, size_t mark, double x, double y, double scale, const char *colour);

#endif
