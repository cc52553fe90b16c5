/* Theories beside the lines of a picture. */
#ifndef RUGO_SERVER_SHOW_PLOT_THEORY_H
#define RUGO_SERVER_SHOW_PLOT_THEORY_H

#include "server/show/plot_style.h"

/* Draws the theories of the lines of one panel, whose frame the pen has: each once where lines
 * share it, black where all of them do, else in the colour of its line, darkened. */
void plot_theories_draw(const struct plot_lines *lines, size_t panel, const struct plot_pen *pen);
/* Adds a row for each theory of any line. */
void plot_theories_name(const struct plot_lines *lines, struct legend *legend);

#endif
