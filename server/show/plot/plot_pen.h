/* What all pictures share: head, title, lines within the frame, and the legend at its right. */
#ifndef RUGO_SERVER_SHOW_PLOT_PLOT_PEN_H
#define RUGO_SERVER_SHOW_PLOT_PLOT_PEN_H

#include "schema/result/result.h"
#include "server/show/plot/plot_frame.h"
#include "server/show/plot/plot_words.h"

/* The picture has this size in SVG user units, unless its legend is wider. LETTER is about a
 * letter's width. */
enum { PLOT_LINES = 12, PLOT_LABEL_SIZE = 200 }; /* colours that can be distinguished */
enum { PEN_WIDTH = 960, PEN_LEGEND = FRAME_RIGHT + 48, PEN_LETTER = 7 };
extern const char *const PEN_COLOURS[PLOT_LINES];

struct plot_pen {
    FILE *file;
    struct frame frame;
    int rows; /* of the legend, so far */
};
/* Begins the SVG; its end, "</svg>", is the caller's. */
void pen_head(const struct plot_pen *pen, int width);
/* The same of any size. millimetres: its width on paper; 0: as on screens. */
struct pen_size {
    int width, height;
    double font, millimetres;
};
void pen_head_sized(const struct plot_pen *pen, const struct pen_size *size);
/* Says in the file which study the picture is of, and how it came about: one line, <metadata>, of
 * the JSON that a document of curves begins with. Nothing where that is not known. */
void pen_study(const struct plot_pen *pen, const struct study_result *study);
/* Draws "name: subject" for readers of the file and for those of the picture. */
void pen_title(const struct plot_pen *pen, const char *name, const char *subject);
/* The same for readers of the file alone. */
void pen_subject(const struct plot_pen *pen, const char *name, const char *subject);
/* Returns whether a point lies within the frame. */
bool pen_reaches(const struct plot_pen *pen, double x, double y);
/* Draws a line through n points, as far as it lies within the frame; style has the attributes of
 * the path. It is broken at points that no axis has. */
void pen_line(const struct plot_pen *pen, size_t n, const double *x, const double *y,
              const char *style);
/* Returns whether something of this line is drawn. */
bool pen_meets(const struct plot_pen *pen, size_t n, const double *x, const double *y);
/* Adds a row to the legend: a stroke of the style and its label; or a note. */
void pen_legend(struct plot_pen *pen, const char *label, const char *style);
/* Returns the height of the stroke of a row. */
int pen_row(int row);
void pen_note(struct plot_pen *pen, const char *text);

#endif
