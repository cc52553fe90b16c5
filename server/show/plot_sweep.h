/* An SVG of a scalar over a parameter of the study's sweep. */
#ifndef RUGO_SERVER_SHOW_PLOT_SWEEP_H
#define RUGO_SERVER_SHOW_PLOT_SWEEP_H

#include "server/show/sweep.h"
#include <stdio.h>

/* Draws a line for each setting of the other parameters, at most PLOT_LINES of them, whose marks
 * have bars of one standard error; dashed beside it its theory, and that of the grid. Lines that
 * share their value of request->colour share a colour and differ by their marks. Fails as
 * sweep_make does. Write errors are left to the file's own flag. */
int plot_sweep(const struct study_result *study, const struct sweep_request *request, FILE *file,
               struct error *err);

#endif
