/* The spectral density of a map with 95 % bands: over rings of wave vectors, and of its lines along
 * x and along y. Densities are those of roughness.h: surfaces C(k) with m00 = integral of C dkx
 * dky, profiles and lines C(k) with m00 = integral of C dk over both signs.
 *
 * A band is that of the density of which the map is one sample, as a sub-map of a Gaussian surface
 * with random amplitudes is. It holds the mean over many such sub-maps (FORMULAS.md, F18.12). */
#ifndef RUGO_CORE_STATISTICS_SPECTRA_MAP_SPECTRUM_H
#define RUGO_CORE_STATISTICS_SPECTRA_MAP_SPECTRUM_H

#include "core/statistics/measured_map.h"
#include "core/statistics/spectra/lay.h"
#include "core/surface/modes.h"
#include <stdbool.h>

/* The rings of a map's spectrum, and what is known of each. */

enum { RING_PARTS = 4, RING_REACH = 16 };

/* Filled by map_spectrum_create; fields are read by all, changed by none. */
struct map_spectrum {
    struct modes modes; /* of an open map under Hann's window */
    bool borrows_modes; /* from the spectrum over circles */
    bool windowed;
    struct lay lay;         /* rings are circles, or along a lay ellipses */
    struct lay_frame frame; /* of the lay */
    double power;           /* mean square of the window, over which densities are; periodic: 1 */
    double side;            /* shorter side of the map: a ring is 2 pi/side wide, across the lay */
    double heights;         /* share of the points that are no holes */
    size_t bins;            /* rings of the density, circles in the corners too */
    double *wave_number, *density;
    size_t rings;    /* 0 .. rings - 1, as far as circles are whole; 0 is the mean, of no use */
    double *freedom; /* degrees of freedom: its mean is distributed as chi squared of so many */
    double (*covariance)[RING_REACH]; /* of the relative density with that of rings r, r+1, ... */
    /* Its modes in quarters by their distance: share of them, mean distance in waves per side. */
    double (*share)[RING_PARTS], (*distance)[RING_PARTS];
};

/* Measures. Holes are filled as by windowed_psd.h. ERROR_MEMORY, or ERROR_INPUT for a map of holes
 * alone, or a periodic one with holes. */
int map_spectrum_create(struct map_spectrum **out, const struct measured_map *map,
                        struct error *err);
/* Measures over ellipses along a lay what another spectrum has over circles: a ring has the waves
 * of one length across it. The other one must outlive it. Surfaces alone. ERROR_MEMORY. */
int map_spectrum_create_along(struct map_spectrum **out, const struct map_spectrum *circles,
                              const struct lay *lay, struct error *err);
void map_spectrum_destroy(struct map_spectrum **spectrum);

enum { PROFILE_PIECE = 8192 }; /* points */
/* Does likewise with the parts of PROFILE_PIECE points of a longer profile, one behind the other
 * and each open. The density is the mean over them, which has no waves longer than a part. What is
 * left at the end, and parts of holes alone, are left out. The modes are those of one part. */
int profile_spectrum_create(struct map_spectrum **out, const struct measured_map *profile,
                            struct error *err);

/* Fills the band of a ring: NaN for ring 0, and for those in the corners, beyond `rings`. */
void map_spectrum_band(const struct map_spectrum *spectrum, size_t ring, double *low, double *high);

/* Returns how many wave numbers lines along an axis (0: x, 1: y) have: 0 along y of profiles. */
size_t line_psd_count(const struct map_spectrum *spectrum, int axis);
/* Fills the mean density of the lines along an axis, and its band, at wave numbers 2 pi m/l, m from
 * 1. Lines of an open map count by Hann's window across. */
void line_psd_measure(const struct map_spectrum *spectrum, int axis, double *wave_number,
                      double *density, double *low, double *high);

#endif
