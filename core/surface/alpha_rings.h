/* The discrete Nayak parameter of a cell as shorter and shorter waves are counted in, ring by ring
 * of the lattice of wave vectors: a ring holds all those of one length. */
#ifndef RUGO_CORE_SURFACE_ALPHA_RINGS_H
#define RUGO_CORE_SURFACE_ALPHA_RINGS_H

#include "core/error.h"
#include <stdbool.h>

/* Sums over the modes with L/lambda_l <= |m| <= R. */
struct ring_sums {
    int dimension;
    double hurst, lowest, rolloff; /* |m| of lambda_l and lambda_r */
    double m0, m2, m4;             /* of the full plane, in units of 2 pi/L */
};

struct ring_search {
    struct ring_sums sums;
    double alpha;   /* wanted */
    double times;   /* waves along y are so many times as far apart as those along x; 1: a square */
    double largest; /* |m| tried */
    double best_square, best_alpha; /* ring whose alpha is nearest so far; NaN before the first */
    double least_alpha, most_alpha; /* of all rings so far; NaN before the first */
    bool left_behind; /* it ended before `largest`: alpha is less than all rings have */
    double passed_by; /* no ring that was not looked at singly is as near as this */
};

/* Largest |m| tried of squares and lines: a grid of 8 points a wave would have 131072 a side; and
 * of rectangles, in waves along the longer side. */
enum { RINGS_MOST = 16384, LATTICE_MOST = 6000 };

/* Finds the ring whose alpha is nearest, up to the first one behind which alpha lies between those
 * so far: fills best_square and best_alpha, and *found, false where no ring comes so far. The
 * largest |m| takes some tenths of a second. ERROR_MEMORY. */
int ring_search_run(struct ring_search *search, bool *found, struct error *err);

#endif
