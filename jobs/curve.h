/* A curve of interface.md as JSON: points, or a matrix over two axes, with errors and theory. */
#ifndef RUGO_JOBS_CURVE_H
#define RUGO_JOBS_CURVE_H

#include "jobs/value.h"

struct curve { /* all borrowed */
    const char *quantity, *x_label, *y_label;
    size_t n; /* points, rows of a matrix */
    const double *x, *y, *standard_error;
    const char *theory_name; /* NULL: none */
    const double *theory;    /* as y */
    size_t columns;          /* 0, or y is n x columns over x and x2 */
    const double *x2;
    const char *x2_label;
    bool counted;               /* from a histogram: with what fell outside of the bins */
    double underflow, overflow; /* counts */
};
/* Appends the curve to the array; false when out of memory. */
bool curve_append(cJSON *curves, const struct curve *curve);

#endif
