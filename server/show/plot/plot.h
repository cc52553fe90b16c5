/* An SVG of lines over one x: curves of cases with their errors and theories, or a scalar over a
 * parameter (sweep.h). */
#ifndef RUGO_SERVER_SHOW_PLOT_PLOT_H
#define RUGO_SERVER_SHOW_PLOT_PLOT_H

#include "server/show/plot/plot_lines.h"
#include <stdio.h>

/* Which axes are logarithmic; automatic: as the kind's view, or the steps of x, suggest; one-plus:
 * y as log10(1 + y), which shows high peaks beside low parts and zero. */
enum plot_axes { AXES_AUTOMATIC, AXES_LINEAR, AXES_X, AXES_Y, AXES_XY, AXES_ONE_PLUS, AXES_COUNT };
#define AXES_WORDS "auto|none|x|y|xy|one-plus"
extern const char *const AXES_NAMES[AXES_COUNT]; /* the same words */

struct plot_request {
    struct lines_request lines;
    enum plot_axes axes;
    bool without_total;  /* standard errors alone (plot_errors.h) */
    bool theories_whole; /* axes reach as far as theories do, not as curves alone */
    double millimetres;  /* the width on paper; 0: for screens */
};
/* Draws curves of a study. What is drawn of many is said in the legend (plot_lines.h). Write errors
 * are left to the file's own flag. Fails as plot_lines_choose does; ERROR_ABSENT, and nothing is
 * written, where no point can be drawn. */
int plot_quantity(const struct study_result *study, const struct plot_request *request, FILE *file,
                  struct error *err);
/* Draws lines as they are, likewise. study: whose picture it is. */
int plot_lines_draw(const struct plot_lines *lines, const struct study_result *study,
                    const struct plot_request *request, const struct plot_words *words, FILE *file,
                    struct error *err);

#endif
