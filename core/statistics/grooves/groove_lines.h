/* Lines of a map at multiples of one wave vector, which need not be on the grid of its waves: their
 * coefficients under the window of windowed_psd.h, and the wave vector that all of them are
 * likeliest of (FORMULAS.md, F18.73). */
#ifndef RUGO_CORE_STATISTICS_GROOVES_GROOVE_LINES_H
#define RUGO_CORE_STATISTICS_GROOVES_GROOVE_LINES_H

#include "core/statistics/grooves/groove_background.h"
#include "core/statistics/grooves/groove_sums.h"

enum { GROOVE_LINES_MOST = 24 };
struct groove_lines {
    double mx, my; /* periods along the sides, of the first harmonic */
    /* Standard errors of the logarithm of the period and of the angle in radians; 0 until
     * groove_family_estimate() fills them. */
    double stretch_error, angle_error;
    size_t count;                                  /* that the grid resolves */
    double complex coefficient[GROOVE_LINES_MOST]; /* of exp(2 pi i h t), t = 0 in the middle
                                                      of the map */
    double variance[GROOVE_LINES_MOST];            /* of them, real and imaginary together */
    double excess[GROOVE_LINES_MOST];              /* power over that of the random part */
};

/* Moves a wave vector to the highest power nearby. */
void groove_refine(const struct groove_map *map, double *mx, double *my);
/* Fits the lines of a wave vector that is nearly right, moving it to where all that stand out are
 * likeliest. */
void groove_lines_fit(struct groove_lines *out, const struct groove_map *map,
                      const struct groove_background *background, double mx, double my);
/* exp(2 pi i m x) at points of a row side by side; 0 behind them. */
enum { GROOVE_TURNS = 64 };
struct groove_turns {
    double re[GROOVE_TURNS], im[GROOVE_TURNS];
};
/* periods: m, along a row of n points; x: from its middle, in sides. */
struct groove_turns groove_turns_of(double periods, size_t first, size_t points, size_t n);
/* Fills the heights of the lines at these points; y: from the middle, in sides. */
void groove_lines_heights(const struct groove_lines *lines, const struct groove_turns *along_x,
                          double y, double out[GROOVE_TURNS]);

#endif
