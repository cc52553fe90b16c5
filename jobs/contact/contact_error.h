/* The error of a value from one source. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_ERROR_H
#define RUGO_JOBS_CONTACT_CONTACT_ERROR_H

#include <math.h>
#include <stddef.h>

struct contact_error {
    double value; /* (reported - true) lies within value +- bound; NaN: not known at this load */
    double bound, standard_error;
    double order;                /* of the mesh, if observed on the levels; else NaN */
    double bound_standard_error; /* of the bound; 0: not known */
};

/* Returns the largest error that is left over the change to a cell `length` times as long, longer
 * or shorter. Doubling the length leaves at most the share `left` of the error (1/2: as 1/L). */
static inline double contact_error_left(double length, double left) {
    return fabs(1 / (1 - pow(left, log2(length))));
}

#endif
