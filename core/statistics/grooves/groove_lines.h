/* Lines of a map at multiples of one wave vector, which need not be on the grid of its waves: their
 * coefficients under the window of windowed_psd.h, the wave vector that all of them are likeliest
 * of, and the shape that they make (FORMULAS.md, F18.73 and F18.74). */
#ifndef RUGO_CORE_STATISTICS_GROOVES_GROOVE_LINES_H
#define RUGO_CORE_STATISTICS_GROOVES_GROOVE_LINES_H

#include "core/statistics/grooves/groove_background.h"
#include "core/surface/grooves/groove_profile.h"

/* A map under Hann's window, as windowed_heights() fills it. */
struct groove_map {
    const struct grid *grid;
    const double *z; /* borrowed */
};

enum { GROOVE_LINES_MOST = 24 };
struct groove_lines {
    /* Periods along the sides, with their standard errors, of the first harmonic. */
    double mx, my, mx_error, my_error;
    size_t count;                                  /* that the grid resolves */
    double complex coefficient[GROOVE_LINES_MOST]; /* of exp(2 pi i h t), t = 0 in the middle
                                                      of the map */
    double variance[GROOVE_LINES_MOST];            /* of them, real and imaginary together */
    double excess[GROOVE_LINES_MOST];              /* power over that of the random part */
};

/* Returns the power |sum z exp(-i k r)|^2/N^2 at mx, my periods along the sides. */
double groove_power(const struct groove_map *map, double mx, double my);
/* Moves a wave vector to the highest power nearby. */
void groove_refine(const struct groove_map *map, double *mx, double *my);
/* Fits the lines of a wave vector that is nearly right, moving it to where all that stand out are
 * likeliest. */
void groove_lines_fit(struct groove_lines *out, const struct groove_map *map,
                      const struct groove_background *background, double mx, double my);
/* Returns the height of all lines at a point, x and y from the middle in sides. */
double groove_lines_height(const struct groove_lines *lines, double x, double y);

/* The shape that lines make. */
struct groove_shape_fit {
    enum groove_shape shape; /* GROOVE_HARMONICS: none of the named ones */
    bool reversed;           /* a saw that falls along the wave vector */
    double p_value;          /* of that shape, by the lines of all harmonics; NaN: harmonics */
    double depth, depth_error;
    double at;       /* where that shape begins, in periods before the middle */
    size_t standing; /* harmonics up to the last that stands out of the random part */
};
void groove_shape_find(struct groove_shape_fit *out, const struct groove_lines *lines);

#endif
