/* Sums over a map under Hann's window, at wave vectors off the grid of its waves. */
#ifndef RUGO_CORE_STATISTICS_GROOVES_GROOVE_SUMS_H
#define RUGO_CORE_STATISTICS_GROOVES_GROOVE_SUMS_H

#include "core/surface/grid.h"
#include <complex.h>

/* A map under Hann's window, as windowed_heights() fills it. */
struct groove_map {
    const struct grid *grid;
    const double *z; /* borrowed */
};

/* Sums of z exp(-i k r), and of these times x and y from the middle, in sides. */
struct groove_sums {
    double complex plain, x, y;
};
/* mx, my: periods along the sides. */
struct groove_sums groove_sums_at(const struct groove_map *map, double mx, double my);
/* Returns the power |sum z exp(-i k r)|^2/N^2. */
double groove_power(const struct groove_map *map, double mx, double my);

/* Of the window along one axis: its mean, and that of its square; mean squares of the distance from
 * the middle, in sides, weighted by it and by its square. */
struct groove_window {
    double mean, square, moment, square_moment;
};
struct groove_window groove_window_of(size_t n);

static inline double complex_square(double complex value) {
    return creal(value) * creal(value) + cimag(value) * cimag(value);
}

#endif
