/* An SVG of speed against error: what more realisations of each model, mesh and estimator of a
 * study would cost and err. */
#ifndef RUGO_SERVER_SHOW_PLOT_PLOT_COST_H
#define RUGO_SERVER_SHOW_PLOT_PLOT_COST_H

#include "schema/result/report.h"
#include <stdio.h>

/* Draws the relative error of the main quantity over processor time, both logarithmic: a line a
 * series, from one realisation on, which falls with the statistical error and ends at the sum of
 * the known errors of mesh, block, model and the like; a circle where the study stands; and, below
 * all lines, the front that no series passes. ERROR_ABSENT where no case has a series that cost
 * and err. Write errors are left to the file's own flag. */
int plot_cost(const struct study_report *report, FILE *file, struct error *err);

#endif
