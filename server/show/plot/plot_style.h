/* Colours, dashes and marks of the lines of a picture, and the legend that names them. */
#ifndef RUGO_SERVER_SHOW_PLOT_PLOT_STYLE_H
#define RUGO_SERVER_SHOW_PLOT_PLOT_STYLE_H

#include "server/show/plot/plot_legend.h"
#include "server/show/plot/plot_lines.h"

enum plot_marks { MARKS_NONE, MARKS_DOTS, MARKS_SHAPES };

/* Writes "#0072b2": of values in an order a sequence from dark to light (viridis without its palest
 * end), of up to PLOT_LINES others a colour that all readers can distinguish from the rest. */
void plot_colour(const struct plot_channel *channel, size_t v, char colour[COLOUR_SIZE]);
void plot_curve_style(const struct plot_lines *lines, const struct plot_line *line,
                      char style[LEGEND_STYLE_SIZE]);
/* Darkens it by half, for a theory that lies upon its curve. */
void plot_darken(char colour[COLOUR_SIZE]);
/* number: of the theory among those of the picture. */
void plot_theory_style(size_t number, const char *colour, char style[LEGEND_STYLE_SIZE]);
/* Few points are seen as shapes or dots, many as a line alone. */
enum plot_marks plot_marks_of(const struct plot_lines *lines, const struct plot_words *words);

/* Fills the legend with what differs between the lines: colours, dashes, levels; or with the one
 * line that there is. */
void plot_legend_lines(struct legend *legend, const struct plot_lines *lines, enum plot_marks marks,
                       const struct plot_words *words);
/* Adds what distinguishes a case from the others of its study, a row each: "H = 0.8"; of a
 * difference of cases "shape: 2 less 3". */
void plot_legend_case(struct legend *legend, const struct study_result *study,
                      const struct case_result *one);
/* Adds what open circles are, and what is left out. */
void plot_legend_notes(struct legend *legend, const struct plot_lines *lines, const char *note);

#endif
