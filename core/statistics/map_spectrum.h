/* The spectral density of a map with 95 % bands: over rings of wave vectors, and of its lines along
 * x and along y. Densities are those of roughness.h: surfaces C(k) with m00 = integral of C dkx
 * dky, profiles and lines C(k) with m00 = integral of C dk over both signs.
 *
 * A band is that of the density of which the map is one sample, as a piece of a Gaussian surface
 * with random amplitudes is: it holds the mean over many such pieces (FORMULAS.md, F18.12). */
#ifndef RUGO_CORE_STATISTICS_MAP_SPECTRUM_H
#define RUGO_CORE_STATISTICS_MAP_SPECTRUM_H

#include "core/statistics/measured_map.h"
#include "core/statistics/spectrum_rings.h"

/* Measures. Holes are filled as by windowed_psd.h. ERROR_MEMORY, or ERROR_INPUT for a map of holes
 * alone, or a periodic one with holes. */
int map_spectrum_create(struct map_spectrum **out, const struct measured_map *map,
                        struct error *err);
void map_spectrum_destroy(struct map_spectrum **spectrum);

enum { PROFILE_PIECE = 8192 }; /* points */
/* Does likewise with the pieces of PROFILE_PIECE points of a longer profile, one behind the other
 * and each open: the mean over them, which tells nothing of waves longer than a piece. What is left
 * at the end, and pieces of holes alone, count for nothing. The modes are those of one piece. */
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
