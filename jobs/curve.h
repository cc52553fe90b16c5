/* A curve as JSON: points, or a matrix over two axes, with errors and theory. */
#ifndef RUGO_JOBS_CURVE_H
#define RUGO_JOBS_CURVE_H

#include "jobs/value.h"

enum { CURVE_THEORIES_MOST = 6 };
struct curve_theory {
    const char *name; /* NULL: none, and none behind it */
    const double *y;
};
/* Errors beside the statistical one; arrays as y. */
struct curve_errors {
    const double *discretisation; /* this grid minus the limit; NULL: unknown */
    const double *discretisation_standard_error;
    double order;        /* of convergence, behind the above */
    bool order_known;    /* observed on three grids; else assumed */
    const double *model; /* this model minus the most complete one; NULL: unknown */
    const double *model_standard_error;
};
struct curve { /* all borrowed */
    const char *quantity, *x_label, *y_label;
    const char *series;     /* NULL: "" */
    const char *model;      /* NULL: without a model, and without a level */
    const char *kinematics; /* of strain, in a model that has several; NULL: not said */
    double level;           /* points_per_wavelength */
    double points;          /* of the whole grid of the level */
    double pressure;        /* 0: not at a certain pressure */
    size_t n;               /* points, rows of a matrix */
    const double *x, *y, *standard_error;
    struct curve_theory theories[CURVE_THEORIES_MOST];
    struct curve_errors errors;
    const double *valueless; /* realisations that have no value at a point; NULL: not said */
    size_t columns;          /* 0, or y is n x columns over x and x2 */
    const double *x2;
    const char *x2_label;
    bool counted;               /* from a histogram: with what fell outside of the bins */
    double underflow, overflow; /* counts */
};
/* Appends the curve to the array; false when out of memory. */
bool curve_append(cJSON *curves, const struct curve *curve);

#endif
