/* An SVG of a matrix: a density over two quantities, such as that of summits over height and
 * curvature. */
#ifndef RUGO_SERVER_SHOW_PLOT_PLOT_DENSITY_H
#define RUGO_SERVER_SHOW_PLOT_PLOT_DENSITY_H

#include "schema/result/result.h"
#include <stdio.h>

/* Draws the curve of a case, which is a matrix (columns > 0), as colours, and as contours its
 * theories, both at the same levels: where they agree, lines lie between colours. Bins are joined
 * until they are about 45 a side. study: has the name, and what was swept; its cases need have no
 * curves. millimetres: the width on paper; 0: for screens. ERROR_ABSENT where the matrix has no
 * values yet. Write errors are left to the file's own flag. */
int plot_density(const struct study_result *study, const struct case_result *one,
                 const struct curve *curve, double millimetres, FILE *file, struct error *err);

/* Finds the matrix of a quantity that a case has, of this series, or the first of any where series
 * is NULL. *out: borrowed; NULL where the quantity is no matrix. ERROR_INPUT for another series. */
int density_curve(const struct case_result *one, const char *quantity, const char *series,
                  const struct curve **out, struct error *err);

#endif
