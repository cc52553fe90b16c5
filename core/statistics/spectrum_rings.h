/* The rings of a map's spectrum, and what is known of each: filled by map_spectrum.c, and of what
 * is independent in them by ring_modes.c. */
#ifndef RUGO_CORE_STATISTICS_SPECTRUM_RINGS_H
#define RUGO_CORE_STATISTICS_SPECTRUM_RINGS_H

#include "core/surface/modes.h"
#include <stdbool.h>

enum { RING_PARTS = 4, RING_REACH = 4 };

/* Filled by map_spectrum_create; fields are read by all, changed by none. */
struct map_spectrum {
    struct modes modes; /* of an open map under Hann's window */
    bool windowed;
    double power; /* mean square of the window, over which densities are; periodic: 1 */
    double side;  /* shorter side of the map: a ring is 2 pi/side wide */
    size_t bins;  /* rings of the density, those in the corners too */
    double *wave_number, *density;
    size_t rings;    /* 0 .. rings - 1, as far as circles are whole; 0 is the mean, of no use */
    double *freedom; /* degrees of freedom: its mean is distributed as chi squared of so many */
    double (*covariance)[RING_REACH]; /* of the relative density with that of rings r, r+1, ... */
    /* Its modes in quarters by their distance: share of them, mean distance in waves per side. */
    double (*share)[RING_PARTS], (*distance)[RING_PARTS];
};

#endif
