/* Heights in steps: all of them are multiples of one, but for what is the same in neighbours, such
 * as a plane (FORMULAS.md, F18.39). */
#ifndef RUGO_CORE_MAP_ARTEFACTS_HEIGHT_STEPS_H
#define RUGO_CORE_MAP_ARTEFACTS_HEIGHT_STEPS_H

#include "core/error.h"
#include "core/map/artefacts/differences.h"

struct height_steps {
    double step;      /* 0: none was found */
    double slope;     /* RMS slope without steps over that with them; NaN: not known */
    double curvature; /* share of the steps in the mean square of second differences */
};
/* Finds the step alone. One of less than a thousandth of the RMS second difference along x is not
 * looked for. ERROR_MEMORY. */
int height_steps_find(const struct grid *grid, const double *z,
                      const struct map_differences *differences, struct height_steps *out,
                      struct error *err);
/* Fills what a step, which may be 0, does to a map of these differences. */
void height_steps_weigh(const struct grid *grid, const struct map_differences *differences,
                        struct height_steps *steps);
/* Returns the variance of Gaussian differences that steps make one of `first`, where their mean is
 * `mean`. */
double height_steps_variance(double first, double mean, double step);

#endif
